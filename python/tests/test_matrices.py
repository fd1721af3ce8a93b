"""A case from matrices: against an oscillator by hand, and beams assembled by scikit-fem against the beam of a case."""

import numpy as np
import pytest
from scipy import io, sparse

import carom
from carom.laws import Law, spring
from carom.schemes import Scheme

# the beam: plane stress, 0.3 m by 20 mm, thick 12 mm, steel
LENGTH, HEIGHT, WIDTH, YOUNG, POISSON, DENSITY = 0.3, 0.02, 0.012, 210e9, 0.3, 7800.0
STIFFNESS, GAP, SPEED = 5e5, 1e-5, -1.0


def beam():
    """Mesh, mass and stiffness of linear triangles in plane stress, by scikit-fem, their basis, and the unknowns that no support holds."""
    fem = pytest.importorskip("skfem")
    from skfem.helpers import ddot, dot, eye, sym_grad, trace

    mesh = fem.MeshTri.init_tensor(np.linspace(0, LENGTH, 31), np.linspace(0, HEIGHT, 3))
    basis = fem.Basis(mesh, fem.ElementVector(fem.ElementTriP1()), intorder=2)
    mu = YOUNG / (2 * (1 + POISSON))
    lam = YOUNG * POISSON / (1 - POISSON**2)

    @fem.BilinearForm
    def stiffness(u, v, _):
        strain = sym_grad(u)
        return WIDTH * ddot(2 * mu * strain + lam * eye(trace(strain), 2), sym_grad(v))

    @fem.BilinearForm
    def mass(u, v, _):
        return WIDTH * DENSITY * dot(u, v)

    clamped = basis.get_dofs(lambda x: x[0] == 0.0).all()
    free = np.setdiff1d(np.arange(basis.N), clamped)
    matrices = [sparse.csr_array(form.assemble(basis)) for form in (mass, stiffness)]
    return mesh, matrices, basis, free


def counterclockwise(points, cells):
    a, b = (points[cells[:, k]] - points[cells[:, 0]] for k in (1, 2))
    turned = a[:, 0] * b[:, 1] < a[:, 1] * b[:, 0]
    return np.where(turned[:, None], cells[:, ::-1], cells)


def case_of(mesh, folder, scheme):
    points = mesh.p.T
    tip = int(np.flatnonzero((points[:, 0] == LENGTH) & (points[:, 1] == 0.0))[0])
    carom.mesh.write(
        folder / "beam.msh",
        points,
        {"beam": {"triangle": counterclockwise(points, mesh.t.T)}},
        sides={"clamp": points[:, 0] == 0.0},
        nodes={"tip": [tip]},
    )
    case = carom.Case(
        {
            "carom": 1,
            "mesh": {"file": "beam.msh"},
            "material": {"steel": {"density": DENSITY, "elastic": {"young": YOUNG, "poisson": POISSON}}},
            "body": {
                "beam": {
                    "region": "beam",
                    "material": "steel",
                    "mass": "consistent",
                    "section": {"plane-stress": {"thickness": WIDTH}},
                    "initial": {"velocity": [0.0, SPEED]},
                }
            },
            "support": {"clamp": {"on": "clamp", "fix": ["x", "y"]}},
            "stop": {"tip": {"ends": ["tip", "ground"], "axis": [0.0, -1.0], "gap": GAP, "stiffness": STIFFNESS}},
            "time": {"end": 2e-3, "step": 2e-6, "scheme": scheme},
        },
        folder=folder,
    )
    return case, tip


IMPLICIT = [
    ("newmark", {}),
    ("newmark", {"beta": 0.49, "gamma": 0.9}),
    ("theta", {"theta": 0.6}),
    ("hht", {"alpha": -0.1}),
    ("generalised-alpha", {"rho-inf": 0.8}),
    ("krenk", {"rho-inf": 0.8}),
    ("laursen-chawla", {}),
    ("paoli-schatzman", {}),
]
EXPLICIT = [("central-difference", {}), ("tchamwa-wielgosz", {})]


def both(name, parameters, folder, change, law):
    """Forces of a case and of its matrices; `change` makes the stop of the case another contact of the nodes that it returns."""
    mesh, (M, K), basis, free = beam()
    explicit = (name, parameters) in EXPLICIT
    dt = 2e-7 if explicit else 2e-6
    case, tip = case_of(mesh, folder, {name: parameters})
    nodes = change(case, mesh) if change else [tip]
    case["time"].update(step=dt, end=1000 * dt)
    if explicit:
        case["body"]["beam"]["mass"] = "lumped"
        M = sparse.diags_array(M.sum(axis=1)).tocsr()
    M, K = (matrix[free][:, free] for matrix in (M, K))
    simulation = case.simulate()
    points = simulation.force
    ours = np.array([points.copy() for _ in simulation])
    N = np.zeros((len(nodes), basis.N))
    N[range(len(nodes)), basis.nodal_dofs[1, nodes]] = 1.0
    v = np.zeros(basis.N)
    v[basis.nodal_dofs[1]] = SPEED
    model = carom.Matrices(
        M, K, N[:, free], [GAP] * len(nodes), law=law, scheme=Scheme(name, **parameters), dt=dt, v=v[free]
    )
    return ours.sum(axis=1), model.run(len(ours)).force.sum(axis=1)


@pytest.mark.parametrize("name, parameters", IMPLICIT + EXPLICIT)
def test_a_beam_of_scikit_fem_presses_as_that_of_a_case(name, parameters, tmp_path):
    """On an elastic stop. Both carry rounding alone, about 1e-16 times the condition of the effective matrix."""
    ours, theirs = both(name, parameters, tmp_path, None, spring(STIFFNESS))
    assert ours.max() > 0.0
    assert np.abs(theirs - ours).max() < 1e-8 * ours.max()


@pytest.mark.parametrize("law", ["displacement", "velocity"])
@pytest.mark.parametrize("name, parameters", IMPLICIT[:1] + IMPLICIT[2:5] + EXPLICIT[:1])
def test_it_does_so_on_a_rigid_plane(name, parameters, law, tmp_path):
    """Exact laws at the two last nodes of the lower side."""
    if (name, law) == ("central-difference", "displacement"):
        pytest.skip("no such pair")
    given = {"capture": "now"} if law == "velocity" else {}

    def change(case, mesh):
        x, y = mesh.p
        chosen = np.flatnonzero((x > 0.985 * LENGTH - 0.01) & (y == 0.0))
        carom.mesh.write(
            tmp_path / "beam.msh",
            mesh.p.T,
            {"beam": {"triangle": counterclockwise(mesh.p.T, mesh.t.T)}},
            sides={"clamp": x == 0.0, "tip": chosen},
        )
        del case["stop"]
        plane = {"plane": {"point": [0.0, -GAP], "normal": [0.0, 1.0]}}
        case["contact"] = {"tip": {"secondary": "tip", "obstacle": plane, "law": {law: given}}}
        return chosen

    ours, theirs = both(name, parameters, tmp_path, change, Law(law, **given))
    assert ours.max() > 0.0
    assert np.abs(theirs - ours).max() < 1e-8 * ours.max()


def test_a_mass_on_a_spring_bounces_off_a_rigid_stop():
    """Mass 1 kg, 100 N/m, at rest at x = 1, exact stop at x = 0 in the rate: it comes to the stop at a quarter of its period."""
    law = Law("displacement")
    model = carom.Matrices([[1.0]], [[100.0]], [[1.0]], [0.0], law=law, scheme=Scheme("newmark", beta=0.5, gamma=1.0), dt=1e-4, u=[1.0])
    history = model.run(2000)
    first = history.time[np.flatnonzero(history.force[:, 0] > 0)[0]]
    assert first == pytest.approx(np.pi / 20, abs=2e-3)
    assert history.gap.min() > -1e-14


def test_an_oscillator_with_damping_and_load_follows_its_formula():
    """u'' + 2 ζ ω u' + ω² u = p: with p constant u tends to p/ω²; errors of second order in the step."""
    omega, zeta, p = 10.0, 0.05, 3.0
    errors = []
    for dt in (2e-3, 1e-3):
        model = carom.Matrices(
            [[1.0]], [[omega**2]], [[1.0]], [1.0], C=[[2 * zeta * omega]], law=Law("displacement"),
            scheme=Scheme("newmark"), dt=dt, load=lambda time: [p],
        )
        history = model.run(round(1.0 / dt))
        t, damped = history.time, omega * np.sqrt(1 - zeta**2)
        exact = p / omega**2 * (1 - np.exp(-zeta * omega * t) * (np.cos(damped * t) + zeta * omega / damped * np.sin(damped * t)))
        errors.append(np.abs(history.displacement[:, 0] - exact).max())
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.05)


def test_matrices_come_from_matrix_market_and_runs_go_on(tmp_path):
    K = sparse.diags_array([[-1e4] * 4, [2e4] * 5, [-1e4] * 4], offsets=[-1, 0, 1], format="csr")
    M = sparse.eye_array(5, format="csr")
    io.mmwrite(tmp_path / "K.mtx", K)
    options = dict(law=Law("displacement"), scheme=Scheme("theta", theta=0.6), dt=1e-3, v=-np.ones(5))
    options["law"] = Law("velocity", capture="now")
    N = np.eye(5)[-1:]
    one = carom.Matrices(M, tmp_path / "K.mtx", N, [0.005], **options)
    two = carom.Matrices(M, K, N, [0.005], **options)
    whole, parts = one.run(100), [two.run(60), two.run(40)]
    assert whole.force.max() > 0.0
    assert np.array_equal(whole.force, np.concatenate([part.force for part in parts]))
    assert np.array_equal(whole.time[60:], parts[1].time)


def test_what_cannot_be_used_is_refused():
    good = dict(law=Law("displacement"), scheme=Scheme("newmark"), dt=1e-3)
    eye = np.eye(2)
    with pytest.raises(ValueError, match="not symmetric"):
        carom.Matrices(eye, [[1.0, 2.0], [0.0, 1.0]], eye, [0, 0], **good)
    with pytest.raises(ValueError, match="gaps by unknowns"):
        carom.Matrices(eye, eye, eye, [0.0], **good)
    with pytest.raises(ValueError, match="cannot hold"):
        carom.Matrices(eye, eye, eye, [0, 0], **{**good, "scheme": Scheme("central-difference")})
    with pytest.raises(ValueError, match="further stages"):
        carom.Matrices(eye, eye, eye, [0, 0], **{**good, "scheme": Scheme("kane")})
    with pytest.raises(carom.RunError, match="positive"):
        carom.Matrices(-eye, eye, eye, [0, 0], **good)
