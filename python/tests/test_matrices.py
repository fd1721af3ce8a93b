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
    ("energy-momentum", {}),
]
EXPLICIT = [("central-difference", {}), ("tchamwa-wielgosz", {})]


# those of which cases ask for a lumped mass
LUMPED = ["central-difference", "tchamwa-wielgosz", "kane", "nonsmooth-alpha"]


def both(name, parameters, folder, change, law, friction=None):
    """Forces of a case and of its matrices, and what they differ in displacement over the largest one; `change` makes the stop of the case another
    contact of the nodes that it returns."""
    mesh, (M, K), basis, free = beam()
    dt = 2e-7 if (name, parameters) in EXPLICIT else 2e-6
    case, tip = case_of(mesh, folder, {name: parameters})
    nodes = change(case, mesh) if change else [tip]
    case["time"].update(step=dt, end=1000 * dt)
    if name in LUMPED:
        case["body"]["beam"]["mass"] = "lumped"
        M = sparse.diags_array(M.sum(axis=1)).tocsr()
    M, K = (matrix[free][:, free] for matrix in (M, K))
    simulation = case.simulate()
    points = simulation.force
    ours = np.array([points.copy() for _ in simulation])
    N, T = np.zeros((2, len(nodes), basis.N))
    N[range(len(nodes)), basis.nodal_dofs[1, nodes]] = 1.0
    T[range(len(nodes)), basis.nodal_dofs[0, nodes]] = 1.0
    v = np.zeros(basis.N)
    v[basis.nodal_dofs[1]] = SPEED
    options = {} if friction is None else {"friction": friction, "tangents": T[:, free]}
    model = carom.Matrices(
        M, K, N[:, free], [GAP] * len(nodes), law=law, scheme=Scheme(name, **parameters), dt=dt, v=v[free], **options
    )
    history = model.run(len(ours))
    end = np.zeros(basis.N)
    end[free] = history.displacement[-1]
    end = end[basis.nodal_dofs].T
    apart = np.abs(end - simulation.displacement[:, :2]).max() / np.abs(end).max()
    return ours.sum(axis=1), history, apart


@pytest.mark.parametrize("name, parameters", IMPLICIT + EXPLICIT)
def test_a_beam_of_scikit_fem_presses_as_that_of_a_case(name, parameters, tmp_path):
    """On an elastic stop. Both carry rounding alone, about 1e-16 times the condition of the effective matrix."""
    ours, history, apart = both(name, parameters, tmp_path, None, spring(STIFFNESS))
    assert ours.max() > 0.0
    assert np.abs(history.force.sum(axis=1) - ours).max() < 1e-8 * ours.max()
    assert apart < 1e-8


def plane(tmp_path, law, given, friction=None):
    """A change of the stop into a rigid plane under the last nodes of the lower side."""

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
        surface = {"plane": {"point": [0.0, -GAP], "normal": [0.0, 1.0]}}
        case["contact"] = {"tip": {"secondary": "tip", "obstacle": surface, "law": {law: given}}}
        if friction is not None:
            case["contact"]["tip"]["friction"] = {"coulomb": friction}
            # what the iterations of a case with friction may leave over is rounding, as of matrices
            case["time"]["newton"] = {"tolerance": 1e-14}
        return chosen

    return change


NOW = {"capture": "now"}
BOTH = IMPLICIT[:1] + IMPLICIT[2:5] + IMPLICIT[-1:]
ON_A_PLANE = [
    *[(*scheme, law, given) for scheme in BOTH for law, given in (("displacement", {}), ("velocity", NOW))],
    ("central-difference", {}, "velocity", NOW),
    # schemes with stages beside the step, or with forces that act through the mass
    ("contact-stabilised", {}, "displacement", {}),
    ("laursen-love", {}, "displacement", {}),
    ("kane", {}, "displacement", {}),
    ("kane", {"beta": 0.4, "gamma": 0.7}, "displacement", {}),
    ("nonsmooth-alpha", {"rho-inf": 0.8}, "velocity", NOW),
    ("nonsmooth-alpha", {"rho-inf": 0.5}, "restitution", {"coefficient": 0.5}),
    ("newmark", {}, "displacement", {"projection": True}),
    ("newmark", {"beta": 0.49, "gamma": 0.9}, "displacement", {"projection": True}),
]


@pytest.mark.parametrize("name, parameters, law, given", ON_A_PLANE)
def test_it_does_so_on_a_rigid_plane(name, parameters, law, given, tmp_path):
    """Exact laws at the last nodes of the lower side."""
    ours, history, apart = both(name, parameters, tmp_path, plane(tmp_path, law, given), Law(law, **given))
    assert ours.max() > 0.0
    assert np.abs(history.force.sum(axis=1) - ours).max() < 1e-8 * ours.max()
    assert apart < 1e-8
    assert history.friction.shape == (len(ours), history.force.shape[1], 0)


RUBBING = [
    ("newmark", {"beta": 0.49, "gamma": 0.9}, "displacement", {}),
    ("theta", {"theta": 0.6}, "velocity", NOW),
    ("central-difference", {}, "velocity", NOW),
    ("energy-momentum", {}, "velocity", NOW),
    ("contact-stabilised", {}, "displacement", {}),
    ("kane", {}, "displacement", {}),
    ("nonsmooth-alpha", {"rho-inf": 0.8}, "velocity", NOW),
    ("newmark", {}, "displacement", {"projection": True}),
]


@pytest.mark.parametrize("name, parameters, law, given", RUBBING)
def test_it_does_so_with_friction(name, parameters, law, given, tmp_path):
    """Newmark's scheme with damping: without it and without projection a mass larger by 1e-14 changes the force by 2e-7, so that nothing
    can be compared to 1e-8."""
    mu = 0.3
    ours, history, apart = both(name, parameters, tmp_path, plane(tmp_path, law, given, mu), Law(law, **given), mu)
    assert ours.max() > 0.0
    assert np.abs(history.force.sum(axis=1) - ours).max() < 1e-8 * ours.max()
    assert apart < 1e-8
    rubbed = np.abs(history.friction[:, :, 0])
    assert rubbed.max() > 0.0
    assert (rubbed <= mu * history.force * (1 + 1e-12)).all()


def test_a_block_slides_until_friction_stops_it():
    """2 kg on a floor in space, pressed by its weight, at (0.3, 0.4) m/s: it stops after v/(μ g) by v²/(2 μ g), and does not turn."""
    mass, g, mu = 2.0, 10.0, 0.25
    floor, tangents = [[0.0, 0.0, 1.0]], [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
    model = carom.Matrices(
        mass * np.eye(3), np.zeros((3, 3)), floor, [0.0], law=Law("velocity", **NOW), scheme=Scheme("theta", theta=0.5), dt=1e-3,
        v=[0.3, 0.4, 0.0], load=[0.0, 0.0, -mass * g], friction=mu, tangents=tangents,
    )
    history = model.run(300)
    sliding = history.time < 0.2 - 1e-9
    assert history.force[:, 0] == pytest.approx(np.full(300, mass * g), rel=1e-12)
    assert history.friction[sliding, 0] == pytest.approx(np.tile(-mu * mass * g * np.array([0.6, 0.8]), (sliding.sum(), 1)), rel=1e-9)
    assert history.displacement[-1] == pytest.approx([0.6 * 0.05, 0.8 * 0.05, 0.0], rel=1e-9, abs=1e-15)
    assert model.velocity == pytest.approx(np.zeros(3), abs=1e-12)
    assert history.friction[-1, 0] == pytest.approx(np.zeros(2), abs=1e-9)


@pytest.mark.parametrize("scheme", [Scheme("newmark"), Scheme("theta", theta=0.5), Scheme("central-difference")])
def test_a_mass_leaves_a_hertz_point_with_its_speed(scheme):
    """2 kg at 3 m/s against k = 1e7 N/m^1.5: (5 m v²/(4 k))^(2/5) deep, for 2.943275 δ/v, in 400 steps; (ω dt)² is 1e-4, ω² = 1.5 k √δ/m. The
    end of a step may miss the largest depth by an eighth of that."""
    mass, v, k = 2.0, 3.0, 1e7
    depth = (1.25 * mass * v**2 / k) ** 0.4
    dt = 2.943275 * depth / v / 400
    model = carom.Matrices(
        [[mass]], [[0.0]], [[-1.0]], [0.0], law=Law("hertz", stiffness=k), scheme=scheme, dt=dt, v=[v],
    )
    history = model.run(410)
    assert history.displacement.max() == pytest.approx(depth, rel=2e-4)
    assert history.force.max() == pytest.approx(k * depth**1.5, rel=3e-4)
    assert model.velocity == pytest.approx([-v], rel=1e-4)


def test_friction_is_larger_at_rest_than_in_motion():
    """1 kg under 10 N is pushed with 0.4 and 0.6 of its weight: below and above the coefficient of sticking, 0.5; it then slides with
    (0.6 - 0.3) g, of which the first step begins at rest. Round-off."""
    law = {"static-kinetic": {"static": 0.5, "kinetic": 0.3}}
    for push, speed in [(4.0, 0.0), (6.0, 3.0 * 0.1)]:
        model = carom.Matrices(
            np.eye(2), np.zeros((2, 2)), [[0.0, 1.0]], [0.0], law=Law("velocity", **NOW), scheme=Scheme("theta", theta=0.5), dt=1e-3,
            load=[push, -10.0], friction=law, tangents=[[1.0, 0.0]],
        )
        model.run(100)
        assert model.velocity == pytest.approx([speed, 0.0], rel=1e-10, abs=1e-14)
    for static, kinetic in [(0.3, 0.5), (-0.1, -0.2)]:
        wrong = {"static-kinetic": {"static": static, "kinetic": kinetic}}
        with pytest.raises(ValueError, match="from 0 to that of sticking"):
            carom.Matrices(
                np.eye(2), np.zeros((2, 2)), [[0.0, 1.0]], [0.0], law=Law("velocity", **NOW), scheme=Scheme("theta", theta=0.5), dt=1e-3,
                friction=wrong, tangents=[[1.0, 0.0]],
            )


def test_a_force_below_friction_moves_nothing():
    """Pushed with 0.9 and 1.1 times the friction."""
    moved = []
    for part in (0.9, 1.1):
        model = carom.Matrices(
            np.eye(2), np.zeros((2, 2)), [[0.0, 1.0]], [0.0], law=Law("displacement"), scheme=Scheme("newmark"), dt=1e-3,
            load=[part * 0.5 * 10.0, -10.0], friction=[0.5], tangents=[[1.0, 0.0]],
        )
        history = model.run(100)
        moved.append(history.displacement[-1, 0])
    assert abs(moved[0]) < 1e-14
    # 0.1 × 5 N on 1 kg for 0.1 s
    assert moved[1] == pytest.approx(0.5 * 0.5 * 0.1**2, rel=0.02)


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


def test_runs_go_on(tmp_path):
    K = sparse.diags_array([[-1e4] * 4, [2e4] * 5, [-1e4] * 4], offsets=[-1, 0, 1], format="csr")
    options = dict(law=Law("velocity", **NOW), scheme=Scheme("theta", theta=0.6), dt=1e-3, v=-np.ones(5))
    one, two = (carom.Matrices(np.eye(5), K, np.eye(5)[-1:], [0.005], **options) for _ in range(2))
    whole, parts = one.run(100), [two.run(60), two.run(40)]
    assert whole.force.max() > 0.0
    assert np.array_equal(whole.force, np.concatenate([part.force for part in parts]))
    assert np.array_equal(whole.time[60:], parts[1].time)


@pytest.mark.parametrize("symmetry", ["general", "symmetric"])
def test_matrices_come_from_matrix_market(symmetry, tmp_path):
    """M and K of the beam as files, given by their paths and as what scipy.io.mmread makes of them: same bits as the matrices themselves."""
    _, matrices, basis, free = beam()
    M, K = (matrix[free][:, free] for matrix in matrices)
    # the halves that a symmetric file does not hold are those that it holds
    M, K = (((matrix + matrix.T) / 2).tocsr() for matrix in (M, K))
    paths = [tmp_path / "M.mtx", tmp_path / "K.mtx"]
    for path, matrix in zip(paths, (M, K)):
        io.mmwrite(path, matrix, precision=17, symmetry=symmetry)
        assert symmetry in path.read_text().splitlines()[0]
    read = [io.mmread(path) for path in paths]
    assert all((matrix != own).nnz == 0 for matrix, own in zip(read, (M, K)))
    last = np.flatnonzero(free == basis.nodal_dofs[1, -1])
    N = np.zeros((1, len(free)))
    N[0, last] = 1.0
    v = np.where(np.isin(free, basis.nodal_dofs[1]), SPEED, 0.0)
    options = dict(law=spring(STIFFNESS), scheme=Scheme("newmark"), dt=2e-6, v=v)
    histories = [carom.Matrices(*pair, N, [GAP], **options).run(500) for pair in ((M, K), read, paths, map(str, paths))]
    assert histories[0].force.max() > 0.0
    for history in histories[1:]:
        assert np.array_equal(history.force, histories[0].force)
        assert np.array_equal(history.displacement, histories[0].displacement)


def test_what_cannot_be_used_is_refused():
    good = dict(law=Law("displacement"), scheme=Scheme("newmark"), dt=1e-3)
    eye = np.eye(2)
    with pytest.raises(ValueError, match="not symmetric"):
        carom.Matrices(eye, [[1.0, 2.0], [0.0, 1.0]], eye, [0, 0], **good)
    with pytest.raises(ValueError, match="gaps by unknowns"):
        carom.Matrices(eye, eye, eye, [0.0], **good)
    with pytest.raises(ValueError, match="cannot hold"):
        carom.Matrices(eye, eye, eye, [0, 0], **{**good, "scheme": Scheme("central-difference")})
    with pytest.raises(ValueError, match="cannot hold in the scheme kane"):
        carom.Matrices(eye, eye, eye, [0, 0], **{**good, "scheme": Scheme("kane"), "law": Law("velocity")})
    with pytest.raises(ValueError, match="displacement with projection cannot hold in the scheme theta"):
        carom.Matrices(eye, eye, eye, [0, 0], **{**good, "scheme": Scheme("theta"), "law": Law("displacement", projection=True)})
    with pytest.raises(ValueError, match="`friction` and `tangents`"):
        carom.Matrices(eye, eye, eye, [0, 0], **good, friction=0.3)
    with pytest.raises(ValueError, match="zero or more"):
        carom.Matrices(eye, eye, eye, [0, 0], **good, friction=-0.3, tangents=eye)
    with pytest.raises(ValueError, match="tangents of the shape"):
        carom.Matrices(eye, eye, eye, [0, 0], **good, friction=0.3, tangents=eye[:1])
    with pytest.raises(carom.RunError, match="positive"):
        carom.Matrices(-eye, eye, eye, [0, 0], **good)


def test_a_file_of_a_matrix_that_is_not_there_is_told(tmp_path):
    with pytest.raises(FileNotFoundError, match="none.mtx"):
        carom.Matrices(tmp_path / "none.mtx", np.eye(1), [[1.0]], [0.0], law=spring(1.0), scheme=Scheme("newmark"), dt=1e-3)
