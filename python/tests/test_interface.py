"""The interface problem by itself: against solutions by hand and by enumeration, dense and sparse."""

import itertools

import numpy as np
import pytest
from scipy import sparse

import carom
from carom.interface import OPEN, SLIP, STICK, solve


def problem(seed, n):
    random = np.random.default_rng(seed)
    B = random.standard_normal((n, n + 2))
    return B @ B.T, random.standard_normal(n)


def enumerated(D, q):
    """The one solution, by all choices of closed rows."""
    n = q.size
    for choice in itertools.product([False, True], repeat=n):
        closed = np.flatnonzero(choice)
        p = np.zeros(n)
        if closed.size:
            p[closed] = np.linalg.solve(D[np.ix_(closed, closed)], -q[closed])
        if p.min() >= 0.0 and (q + D @ p)[~np.array(choice)].min(initial=0.0) >= 0.0:
            return p
    raise AssertionError("a positive definite problem has a solution")


@pytest.mark.parametrize("seed", range(20))
def test_forces_are_those_of_the_only_solution(seed):
    D, q = problem(seed, 8)
    found = solve(D, q)
    # rounding: condition of the matrices below 1e4
    assert np.allclose(found.force, enumerated(D, q), rtol=0, atol=1e-11)
    assert found.residuals.largest < 1e-12 * np.abs(D).max() * max(1.0, np.abs(found.force).max())
    assert np.array_equal(found.status != OPEN, found.force > 0)


def test_two_rows_by_hand():
    found = solve([[2.0, 1.0], [1.0, 2.0]], [-3.0, 1.0])
    assert np.allclose(found.force, [1.5, 0.0]) and np.allclose(found.gap, [0.0, 2.5])


@pytest.mark.parametrize("seed", range(5))
def test_a_sparse_matrix_gives_the_same_by_its_parts(seed):
    parts = [problem(10 * seed + k, n) for k, n in enumerate((3, 1, 5))]
    D, q = sparse.block_diag([D for D, _ in parts], format="csr"), np.concatenate([q for _, q in parts])
    order = np.random.default_rng(seed).permutation(q.size)
    found = solve(D[order][:, order], q[order])
    assert np.allclose(found.force, solve(D.toarray(), q).force[order], rtol=0, atol=1e-12)


def test_bilateral_rows_pull_too():
    D, q = problem(3, 6)
    held = [1, 4]
    found = solve(D, q, bilateral=held)
    # eliminated by hand: g_b = 0
    free = [0, 2, 3, 5]
    S = D[np.ix_(free, free)] - D[np.ix_(free, held)] @ np.linalg.solve(D[np.ix_(held, held)], D[np.ix_(held, free)])
    r = q[free] - D[np.ix_(free, held)] @ np.linalg.solve(D[np.ix_(held, held)], q[held])
    assert np.allclose(found.force[free], enumerated(S, r), atol=1e-12)
    assert found.residuals.bilateral < 1e-13 and found.residuals.largest < 1e-12
    assert found.force[held].min() < 0.0


def test_a_block_on_a_rough_floor_sticks_or_slips():
    """One point of compliance 1: pressed with 10 N, pushed along with 2 N and with 8 N, mu = 0.5."""
    D = np.eye(2)
    stuck = solve(D, [-10.0, 2.0], friction=0.5, tangents=1)
    assert np.allclose(stuck.force, [10.0, -2.0]) and stuck.status[0] == STICK
    slid = solve(D, [-10.0, 8.0], friction=0.5, tangents=1)
    assert np.allclose(slid.force, [10.0, -5.0]) and slid.status[0] == SLIP and np.allclose(slid.gap, [0.0, 3.0])
    space = solve(np.eye(3), [-10.0, 6.0, 8.0], friction=[0.5], tangents=2)
    assert np.allclose(space.force, [10.0, -3.0, -4.0])
    apart = solve(D, [1.0, 2.0], friction=0.5, tangents=1)
    assert apart.status[0] == OPEN and not apart.force.any()


@pytest.mark.parametrize("tangents", [1, 2])
def test_friction_satisfies_its_laws_with_bilateral_rows_and_sparse_matrices(tangents):
    width = 1 + tangents
    for seed in range(10):
        D, q = problem(seed, 4 * width + 1)
        found = solve(D, q, friction=0.3, tangents=tangents, bilateral=[0])
        assert found.residuals.largest < 1e-8 * np.abs(q).max(), seed
        both = sparse.block_diag([D, D], format="csr")
        twice = solve(both, np.concatenate([q, q]), friction=0.3, tangents=tangents, bilateral=[0, q.size])
        assert np.allclose(twice.force[: q.size], found.force, atol=1e-10)


def test_bad_input_is_told():
    with pytest.raises(ValueError, match="not symmetric"):
        solve([[1.0, 0.5], [0.0, 1.0]], [0.0, 0.0])
    with pytest.raises(ValueError, match="shape"):
        solve(np.eye(3), [0.0, 0.0])
    with pytest.raises(ValueError, match="finite"):
        solve(np.eye(2), [np.nan, 0.0])
    with pytest.raises(ValueError, match="multiple of 2"):
        solve(np.eye(3), np.zeros(3), friction=0.1, tangents=1)
    with pytest.raises(ValueError, match="together"):
        solve(np.eye(2), np.zeros(2), friction=0.1)
    with pytest.raises(ValueError, match="rows of D from 0 to 1"):
        solve(np.eye(2), np.zeros(2), bilateral=[2])
    with pytest.raises(carom.RunError):
        solve(-np.eye(2), [-1.0, -1.0])
