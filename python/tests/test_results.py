"""Results folders opened: summary, frames with units, fields, report, figures; meshes from other libraries."""

import numpy as np
import pytest

import carom
from conftest import ROOT


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return carom.Case(ROOT / "cases/two-bars/case.toml").run(tmp_path_factory.mktemp("results") / "two-bars")


def test_the_summary_has_attributes(results):
    summary = results.summary
    assert summary.verdict.grade == "good" and results.good
    assert summary.contacts.shock.peak_force == summary["contacts"]["shock"]["peak_force"] > 0
    assert summary.verdict.lines[0].name == "energy-residual"
    assert "peak_force" in dir(summary.contacts.shock)
    with pytest.raises(AttributeError, match="there are"):
        summary.nothing


def test_a_folder_without_results_is_refused(tmp_path):
    with pytest.raises(FileNotFoundError, match="no results folder"):
        carom.Results(tmp_path)


def test_frames_have_units_and_all_digits(results):
    frame = results.histories
    assert frame.index.name == "time_s"
    units = frame.attrs["units"]
    assert units["contact.shock.force_n"] == "N" and units["probe.tip.velocity_x_m_s"] == "m/s"
    assert units["probe.tip.acceleration_x_m_s2"] == "m/s²" and units["momentum.x_n_s"] == "N s"
    assert units["energy.kinetic_j"] == "J" and units["status.passes"] == ""
    assert np.array_equal(frame["contact.shock.force_n"], results.columns["contact.shock.force_n"])
    impacts = results.impacts
    assert len(impacts) == 1 and impacts["pair"][0] == "shock"
    # Z v / 2 = 66.74 kN (issue 1), within the error of the mesh
    assert impacts["peak_mean_force_n"][0] == pytest.approx(66.74e3, rel=0.01)


def test_compressed_histories_are_read(bars, tmp_path):
    plain = bars.run(tmp_path / "plain")
    bars["output"] = {"compress-histories": True}
    packed = bars.run(tmp_path / "packed")
    assert not (tmp_path / "packed/histories.csv").exists()
    assert packed.histories.equals(plain.histories)


def test_frames_of_polars(results):
    polars = pytest.importorskip("polars")
    assert isinstance(results.frame(library="polars"), polars.DataFrame)


def test_fields_are_read_when_asked_for(results):
    pytest.importorskip("pyvista")
    fields = results.fields
    assert len(fields) == len(fields.times) == 16
    blocks = fields.at(50e-6)
    bodies = blocks["bodies"]
    assert bodies.n_points == 402
    assert "displacement" in " ".join(bodies.point_data.keys()).lower()
    assert fields.times[fields.times.searchsorted(50e-6)] == pytest.approx(50e-6, rel=0.02)


def test_the_report_is_shown_in_a_notebook(results):
    report = results.report()
    assert report.html.lstrip().startswith("<!DOCTYPE html>") or "<html" in report.html[:200]
    shown = report._repr_html_()
    assert shown.startswith("<iframe") and '"' not in shown.split('srcdoc="')[1].split('" width')[0]


def test_figures(results):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    axes = results.plot.force()
    (line,) = axes.get_lines()
    assert np.array_equal(line.get_ydata(), results.columns["contact.shock.force_n"])
    assert axes.get_ylabel() == "contact force, N"
    results.plot.energy()
    with pytest.raises(KeyError, match="there are"):
        results.plot.columns("nothing")


def cube(folder, write):
    """A block of two hexahedra falls freely: its nodes and their motion are what they were given."""
    write(folder / "block.msh")
    case = carom.Case(
        {
            "carom": 1,
            "mesh": {"file": "block.msh"},
            "material": {"soft": {"density": 1000.0, "elastic": {"young": 1e6, "poisson": 0.3}}},
            "body": {"block": {"region": "body", "material": "soft"}},
            "load": {"gravity": {"acceleration": [0.0, 0.0, -10.0]}},
            "time": {"end": 0.1, "step": 1e-2, "scheme": {"newmark": {}}},
        },
        folder=folder,
    )
    simulation = case.simulate().run()
    assert simulation.places.shape == (12, 3)
    assert np.allclose(simulation.displacement, [0.0, 0.0, -0.05], atol=1e-12)
    return simulation


POINTS = np.array([[x, y, z] for z in (0.0, 1.0, 2.0) for y in (0.0, 1.0) for x in (0.0, 1.0)])
CELLS = np.array([[0, 1, 3, 2, 4, 5, 7, 6], [4, 5, 7, 6, 8, 9, 11, 10]])


def test_meshes_from_arrays_meshio_and_pyvista(tmp_path):
    bottom = POINTS[:, 2] == 0.0
    one = cube(tmp_path, lambda path: carom.mesh.write(path, POINTS, {"body": {"hexahedron": CELLS}}, sides={"bottom": bottom}))
    assert sorted(one.nodes("bottom")) == [0, 1, 2, 3]
    meshio = pytest.importorskip("meshio")
    other = meshio.Mesh(POINTS, {"hexahedron": CELLS})
    cube(tmp_path, lambda path: carom.mesh.from_meshio(path, other))
    pyvista = pytest.importorskip("pyvista")
    grid = pyvista.UnstructuredGrid({pyvista.CellType.HEXAHEDRON: CELLS}, POINTS)
    cube(tmp_path, lambda path: carom.mesh.from_pyvista(path, grid))
    with pytest.raises(ValueError, match="accepted"):
        carom.mesh.write(tmp_path / "a.msh", POINTS, {"body": {"hexa": CELLS}})
    with pytest.raises(ValueError, match="no facet"):
        carom.mesh.write(tmp_path / "a.msh", POINTS, {"body": {"hexahedron": CELLS}}, sides={"none": [0, 1]})
