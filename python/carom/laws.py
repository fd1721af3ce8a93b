"""Contact laws as objects."""

from __future__ import annotations

import json
from typing import Any

from . import _carom


class Law:
    """A contact law with its parameters, as in the case file: `Law("stop", curve=[{"penetration": "1 mm", "force": "504 N"}])`.

    Attributes:
        name: as in the case file.
        table: name and parameters as the case file has them: `case["contact"][...]["law"] = law`.
        level: what it constrains at the end of the step: `gap`, `rate`, or `gap and rate`.
        capture: the instant at which the geometry is taken, as a fraction of the step ahead of the newest known configuration.
        relation: factors of `gap g + rate ġ + compliance P + offset = 0` of a closed point of 1 m².

    Raises:
        ValueError: no such law or parameter.
    """

    def __init__(self, name: str, **parameters: Any) -> None:
        self.table: dict[str, dict[str, Any]] = {name: {key.replace("_", "-"): value for key, value in parameters.items()}}
        self._json = json.dumps(self.table)
        known = _carom.law(self._json)
        self.name: str = known["name"]
        self.level: str = known["level"]
        self.capture: float = known["capture"]
        self.relation = {key: known[key] for key in ("gap", "rate", "compliance", "offset")}

    def __repr__(self) -> str:
        return f"<carom law {self._json}>"


def spring(stiffness: float) -> Law:
    """A stop that is a spring of this stiffness, N/m."""
    return Law("stop", curve=[{"penetration": 1.0, "force": stiffness}])
