"""Cases from files, dicts and keyword arguments; their messages are those of the command."""

import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import carom
from conftest import ROOT

TWO_BARS = ROOT / "cases/two-bars/case.toml"
# bars, a reduced body, friction in the plane, a beam on a stop by an implicit scheme, and zones with schemes of their own
FIVE = ["two-bars", "mass-on-stop", "beam-on-stop", "bars-in-zones", "reduced-bracket"]


@pytest.mark.parametrize("name", FIVE)
def test_results_are_those_of_the_command_to_the_last_bit(name, command, tmp_path):
    path = ROOT / "cases" / name / "case.toml"
    subprocess.run([command, "run", path, "--results", tmp_path / "command", "--quiet"], check=True, capture_output=True)
    carom.Case(path).run(tmp_path / "python")
    for table in ("histories.csv", "impacts.csv"):
        ours, theirs = (tmp_path / who / table for who in ("python", "command"))
        assert ours.read_bytes() == theirs.read_bytes(), table


def test_a_dict_gives_the_bits_of_its_file(tmp_path):
    case = carom.Case(TWO_BARS)
    one = case.run(tmp_path / "file")
    other = carom.Case(dict(case)).run(tmp_path / "dict")
    assert np.array_equal(one.columns["contact.shock.force_n"], other.columns["contact.shock.force_n"])


def test_values_are_changed_by_their_keys(bars):
    bars["time"]["step"] = "1 us"
    assert bars.simulate().dt == 1e-6
    assert "42 nodes" in bars.check().facts["model"]
    bars["time"]["step"] = np.float64(2e-6)
    with bars.simulate() as simulation:
        assert simulation.dt == 2e-6


def test_keyword_arguments_replace_tables(bars):
    case = carom.Case(dict(bars), time={"end": 1e-5, "step": 1e-6, "scheme": {"newmark": {}}}, contact=None)
    del case["contact"]
    del case["reference"], case["expect"]
    assert case.simulate().run().steps == 10


def test_schemes_and_laws_as_objects(bars, tmp_path):
    scheme, law = carom.schemes.Scheme("newmark", beta=0.49, gamma=0.9), carom.laws.Law("velocity", capture="half")
    bars["time"]["scheme"], bars["contact"]["shock"]["law"] = scheme, law
    bars.save(tmp_path / "case.toml")
    read = carom.Case(tmp_path / "case.toml")
    assert read["time"]["scheme"] == {"newmark": {"beta": 0.49, "gamma": 0.9}} == scheme.table
    assert read["contact"]["shock"]["law"] == {"velocity": {"capture": "half"}}
    assert "newmark" in carom.Case(read).check().facts["time"] and carom.Case(read).folder == tmp_path
    stop = {"stop": {"curve": [{"penetration": "1 mm", "force": "50 MN"}]}}
    table = carom.compare(read, [scheme], [law, stop], folder=tmp_path / "compare", reference="none")
    assert len(table) == 2 and "failed" not in {verdict for _, verdict, _ in table.runs}
    forces = [results.columns["contact.shock.force_n"] for results in (table[list(table)[0]], read.run(tmp_path / "run"))]
    assert np.array_equal(*forces)


def test_axes_take_arrays_and_tables(bars, tmp_path):
    axis = {"time.step.courant": np.array([1, 2]), "time.scheme": [{"theta": {"theta": 0.5}}, carom.schemes.Scheme("newmark")]}
    study = carom.study(bars, axis, folder=tmp_path / "study")
    names = [study[name].summary.scheme for name in study]
    assert ["newmark" in name for name in names] == [False, True]


@pytest.mark.parametrize("as_dict", [False, True])
def test_a_misspelt_key_has_the_message_and_path_of_the_command(as_dict, command, tmp_path):
    text = TWO_BARS.read_text().replace("density =", "densty =")
    path = tmp_path / "case.toml"
    path.write_text(text)
    told = subprocess.run([command, "check", path], capture_output=True, text=True)
    assert told.returncode == 2
    case = carom.Case(path)
    case = carom.Case(dict(case)) if as_dict else case
    with pytest.raises(carom.CaseError) as caught:
        case.check()
    problems = {problem["path"]: problem for problem in caught.value.problems}
    problem = problems["material.steel.densty"]
    assert problem["nearest"] == "density"
    assert (problem["line"] is None) == as_dict
    for problem in problems.values():
        assert f"error: {problem['message']}\n" in told.stderr
        assert problem["path"] in told.stderr and problem["path"] in str(caught.value)
    assert told.stderr.count("error: ") == len(problems)


def test_wrong_input_never_leaves_a_folder(bars, tmp_path):
    bars["time"]["end"] = "3 kg"
    with pytest.raises(carom.CaseError, match="time.end"):
        bars.run(tmp_path / "results")
    assert not (tmp_path / "results").exists()
    with pytest.raises(TypeError, match="time.end"):
        bars["time"]["end"] = object()
        bars.check()
    with pytest.raises(carom.CaseError, match="no.toml"):
        carom.Case(tmp_path / "no.toml")
    (tmp_path / "broken.toml").write_text("[time\n")
    with pytest.raises(carom.CaseError, match="broken.toml:1"):
        carom.Case(tmp_path / "broken.toml")


def test_other_threads_run_meanwhile(tmp_path):
    """The lock of Python is free during a run: a thread that only counts must not stand still."""
    count, over = [0], threading.Event()

    def work():
        while not over.is_set():
            count[0] += 1
            time.sleep(1e-4)

    thread = threading.Thread(target=work)
    thread.start()
    try:
        case = carom.Case(TWO_BARS)
        before = count[0]
        case.run(tmp_path / "results")
        assert count[0] - before > 20
    finally:
        over.set()
        thread.join()


def test_progress_ends_at_the_end(bars, tmp_path):
    told = []
    bars.run(tmp_path / "results", progress=lambda time, end: told.append((time, end)))
    assert told[-1][0] >= told[-1][1] * (1 - 1e-6)


def test_an_exception_in_progress_leaves_an_intact_folder(tmp_path):
    case = carom.Case(TWO_BARS)
    case["time"]["end"] = "50 ms"

    def fail(time, end):
        raise ZeroDivisionError("enough")

    with pytest.raises(ZeroDivisionError, match="enough"):
        case.run(tmp_path / "results", progress=fail)
    results = carom.Results(tmp_path / "results")
    assert results.summary.verdict.unfinished == "the run was interrupted"
    assert 0 < results.summary.time.end < 0.05


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_ctrl_c_ends_a_run_with_a_checkpoint_that_goes_on(tmp_path):
    script = f"""
import carom
case = carom.Case({str(TWO_BARS)!r})
case["time"]["end"] = "1 s"
del case["output"]
try:
    case.run({str(tmp_path / "results")!r}, progress=lambda time, end: print("running", flush=True))
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""
    import signal

    # what was started in the background of a shell ignores the signal, and so do its children
    def heed():
        signal.signal(signal.SIGINT, signal.SIG_DFL)

    process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True, preexec_fn=heed)
    assert process.stdout.readline() == "running\n"
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=60)
    assert out.endswith("interrupted\n")
    reached = carom.Results(tmp_path / "results").summary.time.end
    assert 0 < reached < 1
    results = carom.resume(tmp_path / "results", until=reached + 1e-5)
    assert results.summary.time.end >= reached + 1e-5 * 0.99


def test_tables_of_variants_and_of_values(bars, tmp_path):
    table = carom.compare(bars, ["theta", {"newmark": {"beta": 0.49, "gamma": 0.9}}], folder=tmp_path / "compare", reference="exact")
    with pytest.raises(KeyError, match="there are: theta"):
        table["nothing"]
    assert len(table) == 2 and [verdict for _, verdict, _ in table.runs] != ["failed"] * 2
    frame = table.frame
    assert len(frame) == 2
    study = carom.study(bars, {"time.step.courant": [1.0, 0.5, 0.25]}, folder=tmp_path / "study", jobs=2)
    assert [float(name.rsplit("-", 1)[1]) for name in study] == [1.0, 0.5, 0.25]
    steps = [study[name].summary.time.steps for name in study]
    assert steps[1] == pytest.approx(2 * steps[0], abs=1) and steps[2] == pytest.approx(4 * steps[0], abs=2)
    with pytest.raises(carom.CaseError):
        carom.study(bars, {"time.stepp": [1.0]}, folder=tmp_path / "wrong")
    assert not (tmp_path / "wrong").exists()


def test_other_cases_get_rows_beside_the_variants(bars, tmp_path):
    coarse = bars.copy()
    coarse["time"]["step"] = {"courant": 1.0}
    coarse.save(tmp_path / "coarse.toml")
    table = carom.compare(bars, ["theta"], beside=[tmp_path / "coarse.toml", coarse], folder=tmp_path / "all", reference="none")
    assert list(table) == ["theta", "coarse", "beside"]
    steps = [table[name].summary.time.steps for name in table]
    assert steps[1] == steps[2] == pytest.approx(steps[0] / 2, abs=1)
    forces = [table[name].columns["contact.shock.force_n"] for name in ("coarse", "beside")]
    assert forces[0].max() > 0.0 and np.array_equal(*forces)
    with pytest.raises(carom.CaseError, match="cannot read the case file"):
        carom.compare(bars, ["theta"], beside=[tmp_path / "none.toml"], folder=tmp_path / "wrong")
    assert not (tmp_path / "wrong").exists()


KEY = "time.scheme.theta.theta"


def test_a_fit_finds_what_the_command_finds(bars, tmp_path, command):
    study = carom.study(bars, fit=KEY, between=(0.5, 1), to={"restitution": 0.92}, contact="shock", folder=tmp_path / "ours")
    found = study.fitted
    assert (found.key, found.goal, found.reason) == (KEY, {"restitution": 0.92}, None)
    assert found.reached == pytest.approx(0.92, abs=1e-6) and 0.5 < found.value < 1
    assert found.run in list(study)
    # the run of that name is a run with that value
    chosen = bars.copy()
    chosen["time"]["scheme"] = {"theta": {"theta": found.value}}
    again = chosen.run(tmp_path / "again")
    assert np.array_equal(again.columns["contact.shock.force_n"], study[found.run].columns["contact.shock.force_n"])
    bars.save(tmp_path / "case.toml")
    options = ["--fit", KEY, "--between", "0.5,1", "--to", "restitution=0.92", "--contact", "shock", "--quiet"]
    subprocess.run([command, "study", tmp_path / "case.toml", *options], check=True, capture_output=True)
    assert (tmp_path / "case.study/fit.json").read_bytes() == (tmp_path / "ours/fit.json").read_bytes()


def test_a_fit_comes_nearest_to_a_force_history(bars, tmp_path):
    bars["time"]["scheme"] = {"theta": {"theta": 0.8}}
    bars.run(tmp_path / "measured")
    history = tmp_path / "measured/histories.csv"
    study = carom.study(bars, fit=KEY, between=(0.5, 1), to={"force": history}, contact="shock", folder=tmp_path / "fit")
    assert study.fitted.goal == "force"
    # within a thousandth of the range
    assert study.fitted.value == pytest.approx(0.8, abs=5e-4)


def test_what_cannot_be_fitted_is_said(bars, tmp_path):
    far = carom.study(bars, fit=KEY, between=(0.5, 1), to={"restitution": 0.1}, folder=tmp_path / "far")
    assert far.fitted.value is None and far.fitted.run is None and far.fitted.reason
    assert len(far) == len(far.frame) > 0
    assert carom.study(bars, {KEY: [0.6]}, folder=tmp_path / "axes").fitted is None
    for wrong in ({"fit": KEY}, {"fit": KEY, "between": (0, 1)}, {"to": {"restitution": 0.5}}):
        with pytest.raises(TypeError, match="`fit`, `between` and `to`"):
            carom.study(bars, folder=tmp_path / "wrong", **wrong)
    with pytest.raises(TypeError, match="no axes"):
        carom.study(bars, {KEY: [0.6]}, fit=KEY, between=(0.5, 1), to={"restitution": 0.5}, folder=tmp_path / "wrong")
    for key, to in ((KEY, {"rest": 0.5}), ("time.scheme.theta.teta", {"restitution": 0.9})):
        with pytest.raises(carom.CaseError):
            carom.study(bars, fit=key, between=(0.5, 1), to=to, folder=tmp_path / "wrong")
    with pytest.raises(carom.CaseError, match="no range"):
        carom.study(bars, fit=KEY, between=(1, 0.5), to={"restitution": 0.9}, folder=tmp_path / "wrong")
    assert not (tmp_path / "wrong").exists()


def test_the_schema_names_the_tables():
    assert {"mesh", "body", "time", "contact"} <= set(carom.schema()["properties"])
