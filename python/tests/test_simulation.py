"""Stepping: the same bits, views, forces from outside, callbacks, memory."""

import gc
import json
import time

import numpy as np
import pytest

import carom
from conftest import ROOT

# one oscillator of 1 kg on a spring of 100 N/m, without contact
OSCILLATOR = {
    "carom": 1,
    "mass": {"weight": {"mass": 1.0, "at": [0.0]}},
    "spring": {"spring": {"ends": ["weight", "ground"], "axis": [1.0], "stiffness": 100.0}},
    "time": {"end": 1.0, "step": 1e-3, "scheme": {"newmark": {}}},
}


def test_steps_have_the_bits_of_a_run(bars, tmp_path):
    results = bars.run(tmp_path / "results")
    forces = [step.contact_forces["shock"] for step in bars.simulate()]
    assert np.array_equal(forces, results.columns["contact.shock.force_n"][1:])


def test_stepping_with_a_folder_leaves_the_folder_of_a_run(bars, tmp_path):
    bars.run(tmp_path / "run")
    with bars.simulate(tmp_path / "steps") as simulation:
        simulation.run()
    for table in ("histories.csv", "impacts.csv"):
        assert (tmp_path / "run" / table).read_bytes() == (tmp_path / "steps" / table).read_bytes()
    assert simulation.summary.verdict.grade == carom.Results(tmp_path / "run").summary.verdict.grade


def test_views_are_no_copies(bars):
    simulation = bars.simulate()
    for name in ("displacement", "velocity", "acceleration", "force", "gap", "gap_rate", "pressure", "status"):
        view, again = getattr(simulation, name), getattr(simulation, name)
        assert view.base is not None and not view.flags.owndata and not view.flags.writeable
        assert view.ctypes.data == again.ctypes.data and np.shares_memory(view, again)
    v, before = simulation.velocity, simulation.velocity.copy()
    simulation.step(5)
    assert v.ctypes.data == simulation.velocity.ctypes.data
    assert not np.array_equal(v, before) and np.array_equal(v, simulation.velocity)
    # a view keeps its memory alive
    del simulation, again, view
    gc.collect()
    assert np.isfinite(v).all()


def test_views_show_the_state(bars, tmp_path):
    bars["probe"] = {"tip": {"on": "striker.right", "record": ["displacement", "velocity"]}}
    results = bars.run(tmp_path / "results")
    simulation = bars.simulate()
    tip = simulation.nodes("striker.right")
    points = simulation.contact_points["shock"]
    u, v, gap, force, status = (
        simulation.displacement, simulation.velocity, simulation.gap, simulation.force, simulation.status,
    )
    rows = [(u[tip, 0][0], v[tip, 0][0], force[points].sum(), gap[points][0], status[points][0]) for _ in simulation]
    columns = results.columns
    assert np.array_equal([row[0] for row in rows], columns["probe.tip.displacement_x_m"][1:])
    assert np.array_equal([row[1] for row in rows], columns["probe.tip.velocity_x_m_s"][1:])
    assert np.array_equal([row[2] for row in rows], columns["contact.shock.force_n"][1:])
    assert np.array_equal([row[4] for row in rows], columns["contact.shock.closed_points"][1:] > 0)


def test_a_saved_state_goes_on_with_the_same_bits(bars):
    simulation = bars.simulate()
    simulation.step(40)
    saved = simulation.save()
    u = simulation.displacement
    simulation.step(60)
    end, reached = u.copy(), simulation.time
    simulation.restore(saved)
    assert simulation.steps == 40 and not np.array_equal(u, end)
    simulation.step(60)
    assert np.array_equal(u, end) and simulation.time == reached
    other = bars.simulate()
    other.restore(saved)
    other.step(60)
    assert np.array_equal(other.displacement, end)
    with pytest.raises(carom.RunError):
        other.restore(saved[:50])


def test_a_force_as_a_function_is_that_of_an_amplitude(tmp_path):
    """A force that is constant over each step, on an oscillator at rest: u = (F/k)(1 - cos ωt) to the order of the scheme."""
    simulation = carom.Case(OSCILLATOR).simulate()
    simulation.add_force("weight", [1.0], lambda step: 5.0)
    u = simulation.displacement
    times, found = zip(*[(step.time, u[0, 0]) for step in simulation])
    exact = 5.0 / 100.0 * (1.0 - np.cos(10.0 * np.array(times)))
    # period error of the trapezoid (ω dt)²/12 = 8e-6 over 10 rad, and half a step of delay where the force starts from nothing
    assert np.abs(np.array(found) - exact).max() < 0.05 * (10 * 1e-4 / 12 + 10.0 * 0.5e-3) * 2
    assert abs(simulation.energy_residual) < 1e-9


def test_a_controller_damps_the_oscillator():
    """Feedback -c v of a damper of one tenth of the critical one: the amplitude falls by exp(-0.1 ω t), with the delay of a step."""
    case = carom.Case(OSCILLATOR)
    case["mass"]["weight"]["initial"] = {"velocity": [1.0]}
    case["time"]["end"] = 3.0
    simulation = case.simulate()
    c, omega = 2.0 * 0.1 * 10.0, 10.0
    push = simulation.add_force("weight", [1.0])
    v, u = simulation.velocity, simulation.displacement
    for step in simulation:
        push.value = -c * v[0, 0]
    energy = 0.5 * v[0, 0] ** 2 + 50.0 * u[0, 0] ** 2
    expected = 0.5 * np.exp(-2.0 * 0.1 * omega * simulation.time)
    # the damper acts half a step to one and a half late: a relative change of the damping of that over 1/ω, and the ripple of the
    # energy within a period, ±ζ
    assert energy == pytest.approx(expected, rel=0.1 + 2 * 0.1 * omega * 3.0 * omega * 1.5e-3 / 2)


BAR = {"density": 7800.0, "young": 210e9, "area": 6.45e-4, "length": 10.0}
PUSHED = {"far": "bar.left", "inner": "tip.right"}


def glued(substeps, outer):
    """A free bar of 10 m whose last 2 m are a zone of their own with steps as many times as short, glued over 0.8 m."""
    mesh = {"bar": {"from": [-10.0], "to": [-1.2], "elements": 44}, "tip": {"from": [-2.0], "to": [0.0], "elements": 40}}
    body = {"material": "steel", "section": {"bar": {"area": BAR["area"]}}}
    return carom.Case(
        {
            "carom": 1,
            "mesh": {"generate": {name: {"line": line} for name, line in mesh.items()}},
            "material": {"steel": {"density": BAR["density"], "elastic": {"young": BAR["young"], "poisson": 0.0}}},
            "body": {name: {"region": name, **body} for name in mesh},
            "zone": {
                "inner": {"bodies": ["tip"], "scheme": {"newmark": {}}},
                "outer": {"bodies": ["bar"], "scheme": outer, "substeps": {"inner": substeps}},
            },
            "arlequin": {"glue": {"inner": "tip", "outer": "bar"}},
            "time": {"end": 2e-3, "step": 2e-5},
        }
    )


@pytest.mark.parametrize("outer", [{"newmark": {}}, {"central-difference": {}}])
@pytest.mark.parametrize("substeps", [1, 4])
@pytest.mark.parametrize("group", PUSHED.values())
def test_a_force_in_zones_is_that_of_a_load(substeps, outer, group):
    """A constant force of a program is the load of the same size, to the last bit."""
    loaded = glued(substeps, outer)
    points = [{"time": time, "factor": 1.0} for time in (0.0, 1.0)]
    loaded["load"] = {"push": {"on": group, "force": [1000.0], "amplitude": points}}
    expected = loaded.simulate().run()
    simulation = glued(substeps, outer).simulate()
    simulation.add_force(group, [1.0], 1000.0)
    simulation.run()
    assert np.abs(expected.displacement).max() > 0.0
    assert np.array_equal(simulation.displacement, expected.displacement)
    assert np.array_equal(simulation.velocity, expected.velocity)


def controlled(case, group, folder):
    """The simulation after a run under a controller on a group, and the sizes that this gave, one before each outer step."""
    sizes = []

    def push(simulation):
        assert simulation.steps == len(sizes)
        sizes.append(1000.0 * np.sin(0.1 * simulation.steps + 0.5) - 2e3 * simulation.velocity[pushed, 0].mean())
        return sizes[-1]

    with case.simulate(folder) as simulation:
        simulation.add_force(group, [1.0], push)
        pushed = simulation.nodes(group)
        simulation.run()
    assert len(sizes) == simulation.steps == round(case["time"]["end"] / case["time"]["step"])
    return simulation, np.array(sizes)


@pytest.mark.parametrize("outer", [{"newmark": {}}, {"theta": {"theta": 0.5}}, {"central-difference": {}}])
@pytest.mark.parametrize("substeps", [1, 4])
@pytest.mark.parametrize("group", PUSHED.values())
def test_a_controller_in_zones_keeps_the_balances(group, substeps, outer, tmp_path):
    simulation, _ = controlled(glued(substeps, outer), group, tmp_path / "results")
    assert abs(simulation.summary.momentum.final[0]) > 0.1
    assert simulation.summary.momentum.relative_residual < 1e-11
    assert abs(simulation.energy_residual) < 1e-11


@pytest.mark.parametrize("substeps", [1, 4])
@pytest.mark.parametrize("group", PUSHED.values())
def test_a_controller_in_zones_gives_its_impulse(group, substeps, tmp_path):
    """In a scheme that balances forces at one instant of the step, the momentum is the sum of the sizes times the outer step."""
    case = glued(substeps, {"theta": {"theta": 0.5}})
    case["zone"]["inner"]["scheme"] = {"theta": {"theta": 0.5}}
    simulation, sizes = controlled(case, group, tmp_path / "results")
    assert simulation.summary.momentum.final[0] == pytest.approx(sizes.sum() * simulation.dt, rel=1e-11)


def test_forces_are_checked(bars):
    simulation = bars.simulate()
    with pytest.raises(carom.CaseError, match="no group of this name"):
        simulation.add_force("nowhere", [1.0])
    with pytest.raises(carom.CaseError, match="not a direction"):
        simulation.add_force("striker.left", [1.0, 0.0])
    force = simulation.add_force("striker.left", [1.0])
    with pytest.raises(ValueError, match="finite"):
        force.value = float("nan")
    simulation.step()
    with pytest.raises(RuntimeError, match="before the first step"):
        simulation.add_force("striker.left", [1.0])


def test_forces_are_added_after_a_look_at_the_case(bars):
    """What does not depend on the state does not begin the run."""
    simulation = bars.simulate()
    assert "step 0" in repr(simulation) and simulation.dt > 0.0 and len(simulation.places) == 42
    force = simulation.add_force("striker.left", [1.0], 5.0)
    assert repr(force) == "<carom.Force of 5 N>"
    assert simulation.nodes("target.right").tolist() == [41]


def test_steps_go_on_beyond_the_end_without_a_folder(bars, tmp_path):
    bars["time"]["end"] = "1 us"
    simulation = bars.simulate().run()
    steps = simulation.steps
    simulation.step(2)
    assert simulation.steps == steps + 2 and list(simulation) == []
    with pytest.raises(ValueError, match="-1 steps"):
        simulation.step(-1)
    complete = bars.simulate(tmp_path / "results").run()
    with pytest.raises(RuntimeError, match="has ended"):
        complete.step()


def test_an_exception_in_a_callback_ends_the_run_with_its_traceback(bars, tmp_path):
    def callback(simulation):
        if simulation.steps == 7:
            raise LookupError("here")

    with pytest.raises(LookupError, match="here") as caught:
        bars.run(tmp_path / "callback", callback=callback)
    assert caught.traceback[-1].name == "callback"

    def control(simulation):
        return 0.0 if simulation.steps < 7 else 1 / 0

    with pytest.raises(ZeroDivisionError) as caught:
        with bars.simulate(tmp_path / "control") as simulation:
            simulation.add_force("striker.left", [1.0], control)
            simulation.run()
    assert caught.traceback[-1].name == "control"
    for name in ("callback", "control"):
        folder = tmp_path / name
        results = carom.Results(folder)
        assert results.summary.time.steps == 7
        assert results.summary.verdict.unfinished == "the run was interrupted"
        assert len(results.columns["time_s"]) == 8
        listed = (folder / "files.txt").read_text().split()
        assert "report.html" in listed and not list(folder.glob(".carom-*"))
    # what was interrupted goes on; what a program pushed does not
    assert carom.resume(tmp_path / "callback").summary.verdict.unfinished is None
    with pytest.raises(carom.CaseError, match="another model"):
        carom.resume(tmp_path / "control")


@pytest.mark.slow
def test_a_run_leaks_nothing(bars):
    """A thousand runs of a small case in one process: the memory of the last 800 does not grow beyond what allocators keep."""
    psutil = pytest.importorskip("psutil")
    bars["time"]["end"] = "5 us"
    process, sizes = psutil.Process(), []
    for k in range(1000):
        simulation = bars.simulate()
        _ = simulation.displacement, simulation.force
        simulation.run()
        if k in (199, 999):
            gc.collect()
            sizes.append(process.memory_info().rss)
    # a leak of one displacement array alone, 42 nodes, would be 0.8 MB in 800 runs; a leaked system some hundred
    assert sizes[1] - sizes[0] < 0.8e6


@pytest.mark.slow
def test_a_thousand_results_folders_leak_nothing(bars, tmp_path):
    psutil = pytest.importorskip("psutil")
    bars["time"]["end"] = "1 us"
    process, sizes, files = psutil.Process(), [], []
    for k in range(1000):
        bars.run(tmp_path / "results")
        if k in (299, 999):
            gc.collect()
            sizes.append(process.memory_info().rss)
            files.append((process.num_fds() if hasattr(process, "num_fds") else 0, process.num_threads()))
    assert files[0] == files[1]
    # 700 runs: a leak of 4 kB each, far less than one system, is 2.8 MB
    assert sizes[1] - sizes[0] < 2.8e6


@pytest.mark.slow
def test_a_million_steps_cost_at_most_a_fifth_more_than_a_run(bars, tmp_path):
    # two elements each: the less a step costs, the more stepping shows
    for name in ("striker", "target"):
        bars["mesh"]["generate"][name]["line"]["elements"] = 2
    bars["time"].update(end=1.0, step=1e-6)
    bars["output"] = {"histories": {"every": "1 ms"}}
    del bars["reference"]

    def clock(work):
        # of the processor: other programs on the machine do not count
        begin = time.process_time()
        work()
        return time.process_time() - begin

    def stepping():
        with bars.simulate(tmp_path / "steps") as simulation:
            for _ in simulation:
                pass
        assert simulation.steps == 1_000_000

    # in turns, so that a change of the clock rate meets both
    pairs = [(clock(lambda: bars.run(tmp_path / "run")), clock(stepping)) for _ in range(3)]
    ratios = sorted(steps / run for run, steps in pairs)
    print(json.dumps({"run_s, stepping_s": pairs, "ratios": ratios}))
    assert ratios[1] < 1.2
