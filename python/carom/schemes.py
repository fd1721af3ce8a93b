"""Time schemes as objects: the map of their step, amplification, spectral radius."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _carom


@dataclass(frozen=True)
class Row:
    """A vector of the step as a combination of what is known at its start, of the unknown x, and of the acceleration c by contact."""

    u: float
    v: float
    a: float
    m: float
    x: float
    c: float


class Scheme:
    """A time scheme with its parameters, as in the case file: `Scheme("newmark", beta=0.25, gamma=0.5)`.

    Attributes:
        name: as in the case file.
        table: name and parameters as the case file has them: `case["time"]["scheme"] = scheme`.
        order: of convergence in the step, without contact.
        critical: critical omega dt of an explicit scheme, otherwise None.

    Raises:
        ValueError: no such scheme or parameter; the message lists those there are.
    """

    def __init__(self, name: str, **parameters: Any) -> None:
        self.table: dict[str, dict[str, Any]] = {name: {key.replace("_", "-"): value for key, value in parameters.items()}}
        self._json = json.dumps(self.table)
        known = _carom.scheme(self._json, 1.0)
        self.name: str = known["name"]
        self.order: int = known["order"]
        self.critical: float | None = known["critical"]
        self._between: bool = known["between"]

    def __repr__(self) -> str:
        return f"<carom scheme {self._json}>"

    def step_map(self, dt: float) -> dict[str, Row]:
        """The rows of a step of `dt` (s): `inertia` and `force` say where the balance M ü + f(u) = p takes its acceleration and
        displacement; `displacement`, `velocity`, `acceleration` and `memory` are those of the end; `gap` and `rate` what laws constrain."""
        return {name: Row(*numbers) for name, numbers in _carom.scheme(self._json, dt)["rows"].items()}

    def amplification(self, omega_dt: float) -> NDArray[np.float64]:
        """The matrix that takes (u, dt v, dt² a), and the memory of a scheme that has one, over a step of the undamped oscillator.

        Raises:
            ValueError: forces of the scheme belong to the way between two states: it has no matrix.
        """
        if self._between:
            raise ValueError(f"the scheme {self.name} takes forces between two states, and has no step map of an oscillator")
        rows = self.step_map(1.0)

        def known(row: Row) -> NDArray[np.float64]:
            return np.array([row.u, row.v, row.a, row.m])

        inertia, force, square = rows["inertia"], rows["force"], omega_dt**2
        # inertia + square force = 0
        x = -(known(inertia) + square * known(force)) / (inertia.x + square * force.x)
        names = ["displacement", "velocity", "acceleration", "memory"]
        matrix = np.array([known(rows[name]) + rows[name].x * x for name in names])
        size = 4 if rows["memory"] != Row(0, 0, 0, 0, 0, 0) else 3
        return matrix[:size, :size]

    def spectral_radius(self, omega_dt: ArrayLike) -> Any:
        """Largest modulus of the eigenvalues of the amplification, at one or more values of omega dt."""
        values = np.asarray(omega_dt, dtype=float)
        radii = [np.abs(np.linalg.eigvals(self.amplification(w))).max() for w in values.ravel()]
        return np.array(radii).reshape(values.shape) if values.ndim else float(radii[0])
