"""A case from matrices: M ü + C u̇ + K u = p(t) + Nᵀ P, with gaps g = g₀ + N u that obey contact laws.

For models of other programs: reduced by modes, read from Matrix Market, or assembled with SciPy.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _carom
from .laws import Law
from .schemes import Scheme

Load = ArrayLike | Callable[[float], ArrayLike]


@dataclass
class MatrixHistory:
    """The steps of a run: arrays with a row for each step.

    Attributes:
        time: ends of the steps, s.
        force: of each contact row in the step, N.
        displacement: of the unknowns, m.
        gap: of each contact row, m.
    """

    time: NDArray[np.float64]
    force: NDArray[np.float64]
    displacement: NDArray[np.float64]
    gap: NDArray[np.float64]


class Matrices:
    """A linear model with contact rows.

    Args:
        M: mass, symmetric positive definite, kg; dense, of scipy.sparse, or the path of a Matrix Market file, as K and C.
        K: stiffness, symmetric, N/m.
        N: contact rows, one for each contact point: the derivative of its gap by the unknowns.
        gap: gaps at u = 0, m.
        law: contact law, one for all rows or one each. A law per area sees an area of 1 m².
        scheme: time scheme.
        dt: step, s.
        C: damping, N s/m. Default: none.
        u, v: displacement (m) and velocity (m/s) at the start. Default: at rest.
        load: p in N, an array, or a function of time. Default: none.

    Held unknowns are left out of the matrices. Only schemes whose step is one solve, and laws that the scheme takes.

    Raises:
        ValueError: sizes that do not fit, a scheme or a law that cannot be used here.
        RunError: M, or M and K as the scheme joins them, are not positive definite.
    """

    def __init__(
        self,
        M: Any,
        K: Any,
        N: Any,
        gap: ArrayLike,
        *,
        law: Law | Sequence[Law],
        scheme: Scheme,
        dt: float,
        C: Any = None,
        u: ArrayLike | None = None,
        v: ArrayLike | None = None,
        load: Load | None = None,
    ) -> None:
        from scipy import sparse

        mass, stiffness, damping = (None if given is None else _matrix(given) for given in (M, K, C))
        assert mass is not None and stiffness is not None
        n = mass.shape[0]
        for name, matrix in (("M", mass), ("K", stiffness), ("C", damping)):
            if matrix is None:
                continue
            if matrix.shape != (n, n):
                raise ValueError(f"{name} of the shape {matrix.shape}; accepted: {(n, n)}")
            if abs(matrix - matrix.T).max() > 1e-9 * abs(matrix).max():
                raise ValueError(f"{name} is not symmetric")
        self._rows = sparse.csr_array(np.atleast_2d(N) if not hasattr(N, "tocsr") else N)
        self._gap = np.atleast_1d(np.asarray(gap, dtype=float))
        if self._rows.shape != (self._gap.size, n):
            raise ValueError(f"N of the shape {self._rows.shape}; accepted: {(self._gap.size, n)}, gaps by unknowns")
        laws = [law] * self._gap.size if isinstance(law, Law) else list(law)
        if len(laws) != self._gap.size:
            raise ValueError(f"{len(laws)} laws; accepted: {self._gap.size}, one for each row of N")
        self._load, self._n, self._dt = load, n, dt
        start = [np.zeros(n) if given is None else np.asarray(given, dtype=float) for given in (u, v)]
        rows = self._rows
        terms = [
            list(zip(rows.indices[a:b].tolist(), rows.data[a:b].tolist()))
            for a, b in zip(rows.indptr[:-1], rows.indptr[1:])
        ]
        self._raw = _carom.MatrixRun(
            (n, _csr(mass), None if damping is None else _csr(damping), _csr(stiffness)),
            (terms, self._gap.tolist(), [one._json for one in laws]),
            (scheme._json, dt),
            (start[0].tolist(), start[1].tolist(), self._at(0.0).tolist()),
        )

    @property
    def time(self) -> float:
        """Time reached, s."""
        return self._raw.time

    @property
    def velocity(self) -> NDArray[np.float64]:
        """Velocity of the unknowns now, m/s."""
        return np.array(self._raw.velocity)

    def _at(self, time: float) -> NDArray[np.float64]:
        load = self._load(time) if callable(self._load) else self._load
        return np.zeros(self._n) if load is None else np.asarray(load, dtype=float)

    def run(self, steps: int) -> MatrixHistory:
        """Takes steps; a second call goes on."""
        start, instant = round(self.time / self._dt), self._raw.instant
        loads = [self._at((start + k) * self._dt + instant).tolist() for k in range(steps)]
        # a gap within rounding of the largest one is closed
        tolerance = 1e-12 * float(np.abs(self._gap).max(initial=0.0))
        force, displacement = (np.array(rows, dtype=np.float64) for rows in self._raw.run(loads, tolerance))
        time = np.asarray((start + 1 + np.arange(steps)) * self._dt, dtype=np.float64)
        gap: NDArray[np.float64] = self._gap + (self._rows @ displacement.T).T
        return MatrixHistory(time, force, displacement, gap)


def _matrix(given: Any) -> Any:
    from scipy import io, sparse

    if isinstance(given, str) or hasattr(given, "__fspath__"):
        given = io.mmread(given)
    return sparse.csr_array(given).astype(float)


def _csr(matrix: Any) -> tuple[list[int], list[int], list[float]]:
    return matrix.indptr.tolist(), matrix.indices.tolist(), matrix.data.tolist()
