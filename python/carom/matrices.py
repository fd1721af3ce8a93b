"""A case from matrices: M ü + C u̇ + K u = p(t) + Nᵀ P + Tᵀ t, with gaps g = g₀ + N u that obey contact laws, and friction along T u̇.

For models of other programs: reduced by modes, read from Matrix Market, or assembled with SciPy.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping, Sequence
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
        force: of each contact row in the step, N, positive in compression.
        friction: along each tangent in the step, N; shape (steps, contact rows, tangents of one), without friction none.
        displacement: of the unknowns, m.
        gap: of each contact row, m.
    """

    time: NDArray[np.float64]
    force: NDArray[np.float64]
    friction: NDArray[np.float64]
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
        friction: coefficient of Coulomb's friction, one for all rows or one each, or a friction law as a case has it, such as
            ``{"static-kinetic": {"static": 0.5, "kinetic": 0.3}}``, for all rows. Default: none.
        tangents: with friction the derivatives of the sliding by the unknowns: one row for each row of N in the plane, two in space, those of a
            point one after another. The friction is at most `friction` times the normal force, and opposes the sliding.

    Held unknowns are left out of the matrices. All schemes of one stage can be used, with the laws that they take in a case; Bathe's scheme, whose
    steps have two, is refused. The mass need not be lumped. Schemes with stages beside the step (contact-stabilised, Laursen-Love) and those whose contact forces act through the mass (Kane,
    nonsmooth-alpha), like laws with projection, factorise M as well. Energy-momentum is the scheme of Laursen and Chawla here: on a linear
    model they are the same.

    What matrices cannot say is refused or not there. A law that the scheme cannot hold is refused, as in a case: in explicit steps no force
    changes the gap at the end. Contact rows are constant, so that points neither slide to other faces nor turn. A massless
    contact node has no place in a positive definite M: eliminate it. Steps are of one length, since the matrix of the step is factorised once.

    Raises:
        ValueError: sizes that do not fit, or a law that the scheme cannot hold.
        FileNotFoundError: there is no file of a matrix.
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
        friction: float | ArrayLike | Mapping[str, Any] | None = None,
        tangents: Any = None,
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
        terms = [[normal] for normal in _terms(self._rows)]
        rubbing = [json.dumps({"coulomb": 0.0})] * self._gap.size
        self._tangents = 0
        if (friction is None) != (tangents is None):
            raise ValueError("friction takes `friction` and `tangents`")
        if friction is not None:
            rubbing = _friction(friction, self._gap.size)
            sliding = sparse.csr_array(np.atleast_2d(tangents) if not hasattr(tangents, "tocsr") else tangents)
            points = self._gap.size
            if sliding.shape not in ((points, n), (2 * points, n)):
                raise ValueError(f"tangents of the shape {sliding.shape}; accepted: {(points, n)} in the plane, {(2 * points, n)} in space")
            self._tangents = sliding.shape[0] // points
            for k, tangent in enumerate(_terms(sliding)):
                terms[k // self._tangents].append(tangent)
        self._raw = _carom.MatrixRun(
            (n, _csr(mass), None if damping is None else _csr(damping), _csr(stiffness)),
            ([row for rows in terms for row in rows], self._gap.tolist(), [one._json for one in laws], rubbing),
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
        force, friction, displacement = (np.array(rows, dtype=np.float64) for rows in self._raw.run(loads, tolerance))
        time = np.asarray((start + 1 + np.arange(steps)) * self._dt, dtype=np.float64)
        gap: NDArray[np.float64] = self._gap + (self._rows @ displacement.T).T
        friction = friction.reshape(steps, self._gap.size, 2)[:, :, : self._tangents]
        return MatrixHistory(time, force, friction, displacement, gap)


def _matrix(given: Any) -> Any:
    from scipy import io, sparse

    if isinstance(given, str) or hasattr(given, "__fspath__"):
        # SciPy says of a file that is not there that it has no banner
        if not os.path.isfile(given):
            raise FileNotFoundError(f"{os.fspath(given)}: no such file of a matrix")
        given = io.mmread(given)
    return sparse.csr_array(given).astype(float)


def _friction(given: float | ArrayLike | Mapping[str, Any], points: int) -> list[str]:
    """The friction law of each point, as a case has it."""
    if isinstance(given, Mapping):
        return [json.dumps(given)] * points
    coefficients = np.broadcast_to(np.asarray(given, dtype=float), (points,))
    if not (np.isfinite(coefficients) & (coefficients >= 0.0)).all():
        raise ValueError("friction accepts finite numbers of zero or more")
    return [json.dumps({"coulomb": float(one)}) for one in coefficients]


def _terms(rows: Any) -> list[list[tuple[int, float]]]:
    """Unknowns and coefficients of each row."""
    ends = zip(rows.indptr[:-1], rows.indptr[1:])
    return [list(zip(rows.indices[a:b].tolist(), rows.data[a:b].tolist())) for a, b in ends]


def _csr(matrix: Any) -> tuple[list[int], list[int], list[float]]:
    return matrix.indptr.tolist(), matrix.indices.tolist(), matrix.data.tolist()
