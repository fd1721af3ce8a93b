"""Fields as VTKHDF, read by VTK itself, against the .vtu files of the same instants."""

import numpy as np
import pytest

import carom
from conftest import ROOT

vtk = pytest.importorskip("vtk")
pyvista = pytest.importorskip("pyvista")


def run(folder, case):
    case["output"] = {"fields": {"every": "20 us", "record": ["displacement", "velocity", "stress"], "vtkhdf": True}}
    return case.run(folder / "results")


@pytest.fixture(params=["linear", "finite"])
def results(request, tmp_path):
    if request.param == "linear":
        case = carom.Case(ROOT / "cases/two-bars/case.toml")
        for name in ("striker", "target"):
            case["mesh"]["generate"][name]["line"]["elements"] = 20
        return run(tmp_path, case)
    case = carom.Case(
        {
            "carom": 1,
            "mesh": {"generate": {"b": {"rectangle": {"origin": [0.0, 0.001], "size": [0.1, 0.1], "elements": [4, 4]}}}},
            "material": {"m": {"density": 1000.0, "neo-hooke": {"young": 1e8, "poisson": 0.3}}},
            "body": {
                "b": {
                    "region": "b",
                    "material": "m",
                    "section": {"plane-strain": {"thickness": 0.1}},
                    "initial": {"velocity": [1.0, -10.0]},
                }
            },
            "contact": {
                "floor": {
                    "secondary": "b.bottom",
                    "obstacle": {"plane": {"point": [0.0, 0.0], "normal": [0.0, 1.0]}},
                    "law": {"velocity": {}},
                }
            },
            "time": {"end": 2e-4, "step": 1e-5, "scheme": {"theta": {}}},
        }
    )
    return run(tmp_path, case)


def test_vtk_reads_all_instants(results):
    folder = results.folder / "fields"
    whole = sorted(folder.glob("*.vtkhdf"))
    assert len(whole) == 2
    for path in whole:
        part = path.stem
        files = sorted(folder.glob(f"{part}-*.vtu"))
        reader = vtk.vtkHDFReader()
        reader.SetFileName(str(path))
        reader.UpdateInformation()
        assert reader.GetNumberOfSteps() == len(files) > 5
        times = reader.GetOutputInformation(0).Get(vtk.vtkStreamingDemandDrivenPipeline.TIME_STEPS())
        for number, file in enumerate(files):
            single = pyvista.read(file)
            reader.SetStep(number)
            reader.Update()
            grid = pyvista.wrap(reader.GetOutput())
            assert times[number] == single.field_data["TimeValue"][0]
            assert np.array_equal(grid.points, single.points)
            assert np.array_equal(grid.cells, single.cells) and np.array_equal(grid.celltypes, single.celltypes)
            for name in single.point_data:
                assert np.array_equal(grid.point_data[name], single.point_data[name], equal_nan=True), name
            for name in single.cell_data:
                assert np.array_equal(grid.cell_data[name], single.cell_data[name], equal_nan=True), name
