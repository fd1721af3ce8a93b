"""Meshes from arrays: each kind of cells, whichever way its nodes run."""

import numpy as np
import pytest

import carom
from carom.kinds import KINDS

CORNERS = {
    "triangle": [[0, 0], [1, 0], [0, 1]],
    "quad": [[0, 0], [1, 0], [1, 1], [0, 1]],
    "tetra": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
    "pyramid": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1]],
    "wedge": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]],
    "hexahedron": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
}
VOLUME = {"triangle": 1 / 2, "quad": 1, "tetra": 1 / 6, "pyramid": 1 / 3, "wedge": 1 / 2, "hexahedron": 1}
SOLID_AND_PLANE = [name for name, kind in KINDS.items() if kind.dimension > 1]


def places(name):
    """Nodes of a straight cell: those between the corners of its facets are in the middle of them."""
    corners = np.array(CORNERS[name.rstrip("0123456789")], dtype=float)
    kind = KINDS[name]
    x = np.full((kind.nodes, kind.dimension), np.nan)
    x[: len(corners)] = corners
    # the middle of the cell, of a kind that has one, is the last node
    x[-1] = np.where(np.isnan(x[-1]), corners.mean(axis=0), x[-1])
    for facet, local in kind.facets:
        first = len(local) if facet in ("line", "triangle", "quad") else {"line3": 2, "triangle6": 3}.get(facet, 4)
        own = local[:first]
        edges = [(0, 1)] if first == 2 else [(k, (k + 1) % first) for k in range(first)]
        for (a, b), node in zip(edges, local[first:]):
            x[node] = (x[own[a]] + x[own[b]]) / 2
        for node in local[first + len(edges) :]:
            x[node] = x[own].mean(axis=0)
    assert not np.isnan(x).any()
    return x


def fallen(folder, name, x, cell):
    """The mass of a cell that falls freely, and the nodes of the facet of the mesh on x = 0 that all of its nodes are given of."""
    carom.mesh.write(folder / "cell.msh", x, {"body": {name: [cell]}}, sides={"side": x[:, 0] == 0.0})
    dimension = KINDS[name].dimension
    body = {"region": "body", "material": "soft"}
    if dimension == 2:
        body["section"] = {"plane-strain": {"thickness": 1.0}}
    case = carom.Case(
        {
            "carom": 1,
            "mesh": {"file": "cell.msh"},
            "material": {"soft": {"density": 1000.0, "elastic": {"young": 1e6, "poisson": 0.3}}},
            "body": {"cell": body},
            "load": {"gravity": {"acceleration": [0.0] * (dimension - 1) + [-10.0]}},
            "time": {"end": 0.1, "step": 1e-2, "scheme": {"newmark": {}}},
        },
        folder=folder,
    )
    with case.simulate(folder / "results") as simulation:
        simulation.run()
        side = simulation.nodes("side")
    return simulation.summary.momentum.final[dimension - 1] / -(10.0 * 0.1), set(side.tolist())


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("name", SOLID_AND_PLANE)
def test_each_kind_has_its_volume_and_sides(name, turned, tmp_path):
    x = places(name)
    cell = np.array(KINDS[name].mirror) if turned else np.arange(len(x))
    mass, side = fallen(tmp_path, name, x, cell)
    assert mass == pytest.approx(1000.0 * VOLUME[name.rstrip("0123456789")], rel=1e-9)
    assert side == set(np.flatnonzero(x[:, 0] == 0.0).tolist())


def test_kinds_of_vtk(tmp_path):
    """Cells of PyVista: the linear wedge of VTK runs the other way, and cells of images have their corners in rows."""
    pyvista = pytest.importorskip("pyvista")
    for name, order in (("wedge", [0, 2, 1, 3, 5, 4]), ("tetra10", range(10)), ("hexahedron20", range(20))):
        x = places(name)
        grid = pyvista.UnstructuredGrid({KINDS[name].vtk: np.array([order])}, x)
        ours = carom.mesh.write(tmp_path / "ours.msh", x, {"body": {name: [np.arange(len(x))]}})
        theirs = carom.mesh.from_pyvista(tmp_path / "theirs.msh", grid)
        assert theirs.read_text() == ours.read_text(), name
    image = pyvista.ImageData(dimensions=(3, 2, 2))
    carom.mesh.from_pyvista(tmp_path / "image.msh", image, sides={"low": np.asarray(image.points)[:, 2] == 0.0})
    assert (tmp_path / "image.msh").read_text().count("\n") > 20
