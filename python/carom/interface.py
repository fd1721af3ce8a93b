"""The interface problem by itself: forces and statuses of contact points, for the matrices of any program.

Without friction: find p with

    g = q + D p >= 0,   p >= 0,   p g = 0    for each row,

with D the compliance (m/N), symmetric and positive definite over the rows that close, q the gaps without forces (m), p the forces (N).
Bilateral rows have g = 0 and any sign of p. With Coulomb's friction each point has a normal row and after it its tangents: one in the plane,
two in space. Their q is the sliding without forces, and |t| <= mu p, no sliding where |t| < mu p, otherwise sliding against t.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _carom

OPEN, STICK, SLIP = 0, 1, 2


@dataclass
class Residuals:
    """How far a solution is from its laws, by code that knows no solver. All are in the unit of q.

    Attributes:
        penetration: largest -g of a normal row.
        tension: largest -p of a normal row times its diagonal of D.
        complementarity: largest |min(g, D_ii p)| of a normal row.
        bilateral: largest |g| of a bilateral row.
        friction: largest |t - proj(t - r s)| / r over the points, with r the inverse of the tangential compliance and the projection on the
            disc of radius mu p.
    """

    penetration: float = 0.0
    tension: float = 0.0
    complementarity: float = 0.0
    bilateral: float = 0.0
    friction: float = 0.0

    @property
    def largest(self) -> float:
        """The largest of all."""
        return max(self.penetration, self.tension, self.complementarity, self.bilateral, self.friction)


@dataclass
class Solution:
    """Forces and statuses.

    Attributes:
        force: p of all rows, N.
        gap: g = q + D p of all rows, m.
        status: of each unilateral point `OPEN`, `STICK` or `SLIP`; a closed point without friction slips.
        passes: passes of the status loop; of several independent parts the most.
        sweeps: sweeps that friction needed besides.
        residuals: how far the solution is from the laws.
    """

    force: NDArray[np.float64]
    gap: NDArray[np.float64]
    status: NDArray[np.int8]
    passes: int = 0
    sweeps: int = 0
    residuals: Residuals = field(default_factory=Residuals)


def solve(
    D: Any,
    q: ArrayLike,
    *,
    friction: ArrayLike | None = None,
    tangents: int = 0,
    bilateral: Sequence[int] = (),
    tolerance: float = 1e-9,
) -> Solution:
    """Solves an interface problem.

    Args:
        D: compliance, dense or of scipy.sparse, symmetric. Of a sparse one, rows that no chain of entries joins are solved by
            themselves.
        q: gaps (m) without forces, one for each row.
        friction: coefficient of friction of each unilateral point, or one for all.
        tangents: rows after the normal row of each unilateral point: 1 in the plane, 2 in space; 0 without friction.
        bilateral: rows that hold with any sign of their force; they are no part of a point.
        tolerance: defect over the largest force with which friction is taken where no nearer solution is found.

    Raises:
        ValueError: sizes that do not fit, entries that are not finite, a D that is not symmetric.
        RunError: no solution was found.
    """
    q = np.asarray(q, dtype=float)
    sparse = hasattr(D, "tocsr")
    D = D.tocsr().astype(float) if sparse else np.asarray(D, dtype=float)
    _sound(D, q, sparse)
    n = q.size
    held = np.zeros(n, dtype=bool)
    if any(not 0 <= row < n for row in bilateral):
        raise ValueError(f"bilateral: {list(bilateral)}; accepted: rows of D from 0 to {n - 1}")
    held[list(bilateral)] = True
    if tangents not in (0, 1, 2):
        raise ValueError(f"tangents: {tangents}; accepted: 0, 1 or 2")
    if (friction is None) != (tangents == 0):
        raise ValueError("friction and tangents are given together: tangents=1 in the plane, 2 in space")
    width = 1 + tangents
    free = np.flatnonzero(~held)
    if free.size % width:
        raise ValueError(f"{free.size} unilateral rows; accepted: a multiple of {width}, normal and tangents of each point")
    points = free.size // width
    mu = np.zeros(points) if friction is None else np.broadcast_to(np.asarray(friction, dtype=float), (points,))
    if not (np.isfinite(mu).all() and (mu >= 0.0).all()):
        raise ValueError("friction: accepted are finite coefficients of zero or more")
    force, status = np.zeros(n), np.zeros(points, dtype=np.int8)
    passes = sweeps = 0
    for rows in _parts(D, free, width) if sparse else [np.arange(n)]:
        own = np.ascontiguousarray(D[np.ix_(rows, rows)].toarray() if sparse else D[np.ix_(rows, rows)])
        places = np.flatnonzero(~held[rows])
        which = np.searchsorted(free, rows[places][::width]) // width
        forces, statuses, counts = _dense(own, q[rows], np.flatnonzero(held[rows]), mu[which], (tangents, tolerance))
        force[rows] = forces
        status[which] = statuses
        passes, sweeps = max(passes, counts[0]), max(sweeps, counts[1])
    gap = q + D @ force
    solution = Solution(force, gap, status, passes, sweeps)
    solution.residuals = _residuals(D, solution, (free, held), mu, width)
    return solution


def _sound(D: Any, q: NDArray[np.float64], sparse: bool) -> None:
    if q.ndim != 1 or D.shape != (q.size, q.size):
        raise ValueError(f"D of the shape {D.shape} beside q of the shape {q.shape}; accepted: (n, n) and (n,)")
    entries = D.data if sparse else D
    if not (np.isfinite(entries).all() and np.isfinite(q).all()):
        raise ValueError("D and q must be finite")
    size = np.abs(entries).max(initial=0.0)
    skew = abs(D - D.T).max() if q.size else 0.0
    if skew > 1e-9 * size:
        raise ValueError(f"D is not symmetric: entries differ by {skew:.3g} from their mirror images")


def _parts(D: Any, free: NDArray[np.intp], width: int) -> list[NDArray[np.intp]]:
    """Rows that depend on each other, those of a point together."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    first = free[::width]
    joined = [(np.repeat(first, 1), free[k::width]) for k in range(1, width)]
    ones = [(a, b) for a, b in joined]
    graph = abs(D)
    if ones:
        a, b = (np.concatenate(side) for side in zip(*ones))
        graph = graph + coo_array((np.ones(a.size), (a, b)), shape=D.shape)
    count, labels = connected_components(graph, directed=False)
    order = np.argsort(labels, kind="stable")
    return np.split(order, np.cumsum(np.bincount(labels, minlength=count))[:-1])


def _dense(
    D: NDArray[np.float64],
    q: NDArray[np.float64],
    held: NDArray[np.intp],
    mu: NDArray[np.float64],
    rules: tuple[int, float],
) -> tuple[NDArray[np.float64], Any, tuple[int, int]]:
    """Forces, statuses and counts of a dense problem: bilateral rows are condensed first."""
    free = np.setdiff1d(np.arange(q.size), held)
    small, gaps = D[np.ix_(free, free)], q[free]
    if held.size:
        # g_b = 0: p_b = -D_bb⁻¹ (q_b + D_bf p_f)
        answer = np.linalg.solve(D[np.ix_(held, held)], np.column_stack([D[np.ix_(held, free)], q[held]]))
        small = small - D[np.ix_(free, held)] @ answer[:, :-1]
        small = 0.5 * (small + small.T)
        gaps = gaps - D[np.ix_(free, held)] @ answer[:, -1]
    small, gaps = np.ascontiguousarray(small), np.ascontiguousarray(gaps)
    counts = (0, 0)
    if not free.size:
        found: Any = []
        statuses: Any = []
    elif rules[0] == 0:
        found, closed, passes = _carom.solve_normal(small, gaps)
        statuses, counts = np.where(closed, SLIP, OPEN), (passes, 0)
    else:
        found, told, counts = _carom.solve_friction(small, gaps, list(mu), rules)
        statuses = np.frombuffer(told, dtype=np.int8)
    force = np.zeros(q.size)
    force[free] = found
    if held.size:
        force[held] = -(answer[:, -1] + answer[:, :-1] @ force[free])
    return force, statuses, counts


def _residuals(
    D: Any,
    solution: Solution,
    rows: tuple[NDArray[np.intp], NDArray[np.bool_]],
    mu: NDArray[np.float64],
    width: int,
) -> Residuals:
    free, held = rows
    diagonal, p, g = D.diagonal(), solution.force, solution.gap
    normal = free[::width]
    pressed = diagonal[normal] * p[normal]
    found = Residuals(
        penetration=float(np.max(0.0 - g[normal], initial=0.0)),
        tension=float(np.max(0.0 - pressed, initial=0.0)),
        complementarity=float(np.max(np.abs(np.minimum(g[normal], pressed)), initial=0.0)),
        bilateral=float(np.max(np.abs(g[held]), initial=0.0)),
    )
    if width > 1 and normal.size:
        along = np.column_stack([free[k::width] for k in range(1, width)])
        r = (width - 1) / diagonal[along].sum(axis=1)
        trial = p[along] - r[:, None] * g[along]
        length = np.linalg.norm(trial, axis=1)
        bound = mu * np.maximum(p[normal], 0.0)
        share = np.where(length > bound, bound / np.maximum(length, 1e-300), 1.0)
        defect = np.linalg.norm(p[along] - share[:, None] * trial, axis=1)
        found.friction = float(np.max(defect / r, initial=0.0))
    return found
