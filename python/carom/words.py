"""Values as the command takes them: in one line of TOML."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import Any


def inline(value: Any) -> str:
    """A text, a number, a list or a dict in one line. Numbers and arrays of NumPy are numbers and lists.

    Raises:
        TypeError: a value that a case cannot hold.
    """
    if hasattr(value, "tolist"):
        value = value.tolist()
    if hasattr(value, "table"):
        value = value.table
    if isinstance(value, Mapping):
        inner = ", ".join(f"{json.dumps(key)} = {inline(entry)}" for key, entry in value.items())
        return f"{{ {inner} }}" if inner else "{}"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(inline, value))}]"
    if isinstance(value, float):
        # `inf` and `nan`, where JSON has other words
        return repr(value)
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, (str, bool, int)):
        return json.dumps(value, ensure_ascii=False)
    raise TypeError(f"a value of the type {type(value).__name__}; accepted: texts, numbers, booleans, lists, dicts")
