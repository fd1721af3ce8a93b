"""The progress of a run, on a terminal or in a notebook."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

Show = Callable[[float, float], None]


@contextmanager
def bar(progress: bool | Show) -> Iterator[Show | None]:
    """A function of the simulated time and the end (s) that shows both; none where nothing is to be shown.

    With `tqdm` installed it draws its bar, which is a widget in notebooks; otherwise a line of text on standard error.
    """
    if callable(progress) or not progress:
        yield progress if callable(progress) else None
        return
    try:
        from tqdm.auto import tqdm
    except ImportError:
        yield _line
        sys.stderr.write("\n")
        return
    with tqdm(total=100, unit="%", bar_format="{l_bar}{bar}| {postfix}") as drawn:

        def show(time: float, end: float) -> None:
            drawn.n = min(100.0, 100.0 * time / end) if end > 0.0 else 100.0
            drawn.set_postfix_str(f"t = {time:.3e} s")

        yield show


def _line(time: float, end: float) -> None:
    part = min(1.0, time / end) if end > 0.0 else 1.0
    sys.stderr.write(f"\r{100.0 * part:5.1f} %, t = {time:.3e} s")
    sys.stderr.flush()
