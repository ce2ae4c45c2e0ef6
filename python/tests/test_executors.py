"""Executors: a campaign on other processes has the folder of a campaign on threads, byte for byte."""

import dataclasses
import multiprocessing
import os
import shutil
import subprocess
import sys
import threading
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path

import example_drivers
import paracosm as pc
import pytest
from paracosm import _parcels, _station

SPAWN = multiprocessing.get_context("spawn")


def files(folder):
    return {path.name: path.read_bytes() for path in Path(folder).iterdir()}


def same(study, executor, folder, **how):
    """Runs a study on threads and on an executor, and returns whether the folders are the same."""
    study.run(folder / "threads", executor=2)
    study.run(folder / "executor", executor=executor, **how)
    expected, found = files(folder / "threads"), files(folder / "executor")
    return expected == found and len(expected) > 3


@pc.scenario
def crossing(s):
    """A pedestrian crosses in front of the car."""
    speed = s.interval("speed", 0.5, 10.0, unit="m/s")
    gap = s.interval("distance", 5.0, 60.0, unit="m")
    road = s.place(pc.RoadSegment(300).lanes(2))
    car = s.place(pc.AutonomousVehicle(road.on_lane(1, 10.0)).speed(16.7))
    walker = s.place(pc.Pedestrian(road.on_sidewalk("left", 100.0)))
    near = car.gap_along(road.crossing(100.0)) < gap
    walker.walk(road.on_sidewalk("right", 100.0), speed).skip_until(near).take_until(walker.arrived())
    s.require("no-collision", pc.never(car.collides()))


def ridge(test):
    return abs(test["x"] - 0.3) + test["y"] - 0.2


RIDGE = pc.Space({"x": pc.Interval(0, 1), "y": pc.Interval(0, 1)})

STUDIES = {
    "open-loop": lambda: pc.Study("cut-in", strategy="halton", budget=60),
    "adaptive": lambda: pc.Study("pedestrian-crossing", driver="aeb", strategy="cmaes", budget=60),
    "covering": lambda: pc.Study("map-traffic", open={"route": None, "traffic_seed": None}, fix={"cars": 2}, budget=8),
    "python": lambda: pc.Study(crossing, driver=example_drivers.Cautious(), strategy="auto", budget=40),
    "function": lambda: pc.Study.of_function(ridge, RIDGE, strategy="nelder-mead", budget=60),
    "references": lambda: pc.Study("cut-in", driver="cruise", references=["aeb"], budget=20),
}


@pytest.mark.parametrize("name", STUDIES)
def test_a_campaign_on_processes_is_the_campaign_on_threads(name, tmp_path):
    with ProcessPoolExecutor(2, mp_context=SPAWN) as executor:
        assert same(STUDIES[name](), executor, tmp_path)


def test_a_campaign_on_an_executor_of_threads_is_the_same(tmp_path):
    with ThreadPoolExecutor(3) as executor:
        assert same(STUDIES["python"](), executor, tmp_path, locate=None)


def test_a_client_of_dask_is_an_executor(tmp_path):
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=2, dashboard_address=None) as cluster, distributed.Client(cluster) as client:
        assert same(STUDIES["adaptive"](), client, tmp_path)


def test_cameras_draw_on_other_processes(tmp_path):
    study = pc.Study("pedestrian-crossing", driver=example_drivers.Sensing(), budget=4)
    with ProcessPoolExecutor(2, mp_context=SPAWN) as executor:
        assert same(study, executor, tmp_path)


def test_a_campaign_goes_on_where_another_executor_has_stopped(tmp_path):
    study = STUDIES["adaptive"]()
    study.run(tmp_path / "whole", executor=1)

    class Enough(Exception):
        pass

    def stop(done, budget):
        if done >= 10:
            raise Enough

    with ThreadPoolExecutor(2) as executor:
        with pytest.raises(Enough):
            pc.Study.replace(study).run(tmp_path / "out", executor=Slow(executor), progress=stop)
        lines = (tmp_path / "out" / "trials.jsonl").read_text().count("\n")
        assert 10 <= lines < 60
        study.run(tmp_path / "out", executor=executor, resume=True)
    assert files(tmp_path / "out") == files(tmp_path / "whole")


class Slow(Executor):
    """An executor that waits before each part, so that a test can stop a campaign."""

    def __init__(self, inner):
        self.inner = inner

    def submit(self, fn, /, *args, **kwargs):
        return self.inner.submit(_slowly, fn, *args)


def _slowly(fn, *args):
    threading.Event().wait(0.05)
    return fn(*args)


def test_the_probability_of_a_failure_is_estimated_on_an_executor():
    study = pc.Study("cut-in", driver="aeb")
    with ProcessPoolExecutor(2, mp_context=SPAWN) as executor:
        assert study.likelihood(budget=100, executor=executor) == study.likelihood(budget=100)


class Elsewhere(ProcessPoolExecutor):
    """Processes of another machine: no file of this machine is there."""

    def submit(self, fn, /, parcel, *args, **kwargs):
        self.sent = getattr(self, "sent", 0) + bool(args[-1])
        return super().submit(fn, dataclasses.replace(parcel, root="/no/such/folder"), *args, **kwargs)


@pytest.fixture
def elsewhere(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", os.fspath(tmp_path / "cache"))
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    with Elsewhere(2, mp_context=SPAWN, initializer=os.chdir, initargs=("/",)) as executor:
        yield executor


def test_a_scenario_and_its_roads_travel(elsewhere, fuzz, tmp_path):
    assert fuzz("cut-in", "--budget", "2", "--out", "logged", "-q").returncode == 0
    assert fuzz("export", "logged", "1", "--out", "here/written", "--ego-as", "controller").returncode == 0
    scenario = next(Path("written").glob("*.xosc"))
    study = pc.Study(scenario)
    assert same(study, elsewhere, tmp_path)
    assert 1 <= elsewhere.sent <= 8
    assert list((tmp_path / "cache").glob("paracosm/parcels/*/**/*.xodr"))
    # The roads are a parameter of another scenario.
    roads = next(Path("written").glob("*.xodr"))
    (tmp_path / "more").mkdir()
    study = pc.Study("map-traffic", fix={"roads": os.fspath(roads), "cars": 0}, strategy="halton", budget=4)
    assert same(study, elsewhere, tmp_path / "more")


def test_a_file_above_the_present_folder_travels(elsewhere, tmp_path):
    (tmp_path / "rules.toml").write_text('[[requirement]]\nid = "slow"\nformula = "always (car.speed < 30)"\n')
    study = pc.Study("cut-in", requirements="../rules.toml", budget=4)
    assert same(study, elsewhere, tmp_path)
    assert elsewhere.sent


def test_a_driver_of_a_command_travels(elsewhere, tmp_path):
    shutil.copy(Path(example_drivers.__file__), "driver.py")
    study = pc.Study("cut-in", driver_command=f"{sys.executable} driver.py Cautious", budget=4)
    assert same(study, elsewhere, tmp_path)
    # A program of the user may be run elsewhere, too. Each machine has its own Python.
    Path("drive.sh").write_text(f"#!/bin/sh\nexec {sys.executable} driver.py Cautious\n")
    Path("drive.sh").chmod(0o755)
    (tmp_path / "more").mkdir()
    study = pc.Study("cut-in", driver_command="./drive.sh driver.py", budget=2)
    assert same(study, elsewhere, tmp_path / "more")
    assert _parcels.packed(study).parcel.absolute == ()


def test_doubts_come_back_from_other_processes(elsewhere):
    # Each process drives one test, and breaks at the second.
    Path("worn.py").write_text(
        "import paracosm as pc\n"
        "class Worn(pc.Driver):\n"
        "    tests = 0\n"
        "    def reset(self, briefing):\n"
        "        self.tests += 1\n"
        "    def step(self, observation):\n"
        "        if self.tests > 1: raise ValueError('worn out')\n"
        "        return pc.Control()\n"
        "Worn().serve()\n"
    )
    study = pc.Study("cut-in", driver_command=f"{sys.executable} worn.py", budget=6)
    for out, executor in {"threads": 1, "executor": elsewhere}.items():
        report = study.run(out, executor=executor)
        assert report.verdicts["error"] == 0
        assert len(report.doubts) == 1 and "had a result when" in report.doubts[0] and "worn out" in report.doubts[0]
        assert report.doubts == pc.load(out).doubts and report.doubts[0].split(":")[0] in report._repr_html_()
    assert Path("threads/trials.jsonl").read_bytes() == Path("executor/trials.jsonl").read_bytes()


def test_a_file_that_is_named_by_its_whole_path_is_asked_for(elsewhere, tmp_path):
    rules = tmp_path / "rules.toml"
    rules.write_text('[[requirement]]\nid = "slow"\nformula = "always (car.speed < 30)"\n')
    study = pc.Study("cut-in", requirements=rules, budget=4)
    study.run("out", executor=elsewhere)
    rules.write_text(rules.read_text() + "\n")
    parcel = _parcels.packed(study).parcel
    rules.write_text("")
    with pytest.raises(pc.Error, match="has another file .*rules.toml: give its path from the present folder"):
        _station.run_part(parcel, 0, [], {})
    rules.unlink()
    with pytest.raises(pc.Error, match="has no file .*rules.toml: give its path from the present folder"):
        _station.run_part(parcel, 0, [], {})


def test_a_file_that_changes_while_a_campaign_runs_is_an_error(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("rules.toml").write_text('[[requirement]]\nid = "slow"\nformula = "always (car.speed < 30)"\n')
    packed = _parcels.packed(pc.Study("cut-in", requirements="rules.toml", budget=4))
    Path("rules.toml").write_text("")
    with pytest.raises(pc.Error, match="the file rules.toml has changed since the campaign began"):
        packed.contents([packed.parcel.files[0].hash])
    Path("rules.toml").unlink()
    with pytest.raises(pc.Error, match="cannot read .*rules.toml"):
        packed.contents([packed.parcel.files[0].hash])


def test_other_versions_do_not_run_tests():
    parcel = dataclasses.replace(_parcels.packed(pc.Study("cut-in", budget=4)).parcel, version="0.0.1", key="older")
    with pytest.raises(pc.Error, match=r"has paracosm 0.0.1: install the same version on all machines"):
        _station.run_part(parcel, 0, [], {})


def test_a_path_that_leads_out_of_a_link_cannot_travel(tmp_path, monkeypatch):
    (tmp_path / "work").mkdir()
    (tmp_path / "far" / "away").mkdir(parents=True)
    (tmp_path / "far" / "rules.toml").write_text('[[requirement]]\nid = "slow"\nformula = "always (car.speed < 30)"\n')
    monkeypatch.chdir(tmp_path / "work")
    os.symlink(tmp_path / "far" / "away", "link")
    with pytest.raises(pc.Error, match="the file link/../rules.toml cannot travel, because its path leads out of a link"):
        _parcels.packed(pc.Study("cut-in", requirements="link/../rules.toml", budget=4))


@pytest.mark.parametrize("given", [["nothing.bin"], ["."], [3]])
def test_the_files_of_a_driver_have_to_be_there(given):
    driver = example_drivers.Cautious()
    driver.files = given
    with pytest.raises(pc.Error, match="files of the driver: found .*, expected the path of a file"):
        _parcels.packed(pc.Study("cut-in", driver=driver, budget=4))


def test_a_folder_that_was_removed_is_filled_again(elsewhere, tmp_path):
    Path("rules.toml").write_text('[[requirement]]\nid = "slow"\nformula = "always (car.speed < 30)"\n')
    study = pc.Study("cut-in", requirements="rules.toml", budget=4)
    study.run("first", executor=elsewhere)
    shutil.rmtree(tmp_path / "cache")
    study.run("again", executor=elsewhere)
    assert files("first") == files("again")
    assert list((tmp_path / "cache").glob("paracosm/parcels/*/rules.toml"))


def test_a_cache_that_cannot_be_written_is_an_error(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("rules.toml").write_text('[[requirement]]\nid = "slow"\nformula = "always (car.speed < 30)"\n')
    monkeypatch.setenv("XDG_CACHE_HOME", "/proc/nothing")
    packed = _parcels.packed(pc.Study("cut-in", requirements="rules.toml", budget=4))
    parcel = dataclasses.replace(packed.parcel, root="/no/such/folder")
    with pytest.raises(pc.Error, match="cannot write .* the variable XDG_CACHE_HOME names another folder"):
        _station.run_part(parcel, 0, [], packed.contents([parcel.files[0].hash]))


def test_a_large_driver_travels_once_to_each_process(tmp_path):
    class Large(example_drivers.Cautious):
        network = os.urandom(1 << 20)

    with Counting(2, mp_context=SPAWN) as executor:
        assert same(pc.Study("cut-in", driver=Large(), budget=40), executor, tmp_path)
        assert executor.parts > 10
        assert executor.bytes < 8 << 20


class Counting(ProcessPoolExecutor):
    """Processes, with the number of parts that they were given and of the bytes that travelled with the parts."""

    parts = 0
    bytes = 0

    def submit(self, fn, /, parcel, first, tests, given):
        self.parts += 1
        self.bytes += len(repr(parcel)) + sum(map(len, given.values()))
        return super().submit(fn, parcel, first, tests, given)


def test_processes_that_were_forked_end_at_once(tmp_path):
    script = """
import concurrent.futures, multiprocessing, time, paracosm as pc
context = multiprocessing.get_context("fork")
with concurrent.futures.ProcessPoolExecutor(2, mp_context=context) as executor:
    pc.Study("cut-in", budget=20).run("out", executor=executor)
    begun = time.monotonic()
assert time.monotonic() - begun < 5, time.monotonic() - begun
"""
    subprocess.run([sys.executable, "-c", script], cwd=tmp_path, check=True, timeout=120)


def test_an_executor_that_cancels_its_futures_ends_the_campaign(tmp_path):
    executor = ThreadPoolExecutor(1)

    def close(done, budget):
        executor.shutdown(wait=False, cancel_futures=True)

    with pytest.raises(pc.Error, match="the executor has cancelled them|cannot schedule new futures"):
        STUDIES["open-loop"]().run(tmp_path / "out", executor=Slow(executor), progress=close)


def test_a_client_that_was_closed_is_an_error_before_the_campaign(tmp_path):
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=1, processes=False, dashboard_address=None) as cluster:
        client = distributed.Client(cluster)
        client.close()
        with pytest.raises(pc.Error, match="the executor does not answer, perhaps because it was closed"):
            STUDIES["open-loop"]().run(tmp_path / "out", executor=client)
    assert not (tmp_path / "out").exists()


class Interrupting(Executor):
    def submit(self, fn, /, *args, **kwargs):
        future = Future()
        future.set_exception(KeyboardInterrupt())
        return future


def test_a_worker_that_was_interrupted_does_not_interrupt_this_process(tmp_path):
    with pytest.raises(pc.Error, match="test .*: the executor failed: KeyboardInterrupt$"):
        STUDIES["open-loop"]().run(tmp_path / "out", executor=Interrupting())


class Broken(Executor):
    """An executor that breaks after some parts."""

    def __init__(self, parts):
        self.left = parts

    def submit(self, fn, /, *args, **kwargs):
        future = Future()
        if self.left == 0:
            future.set_exception(OSError("the network is gone"))
        else:
            self.left -= 1
            future.set_result(fn(*args, **kwargs))
        return future


def test_an_executor_that_breaks_ends_the_campaign_and_loses_no_test(tmp_path):
    study = STUDIES["adaptive"]()
    with pytest.raises(pc.Error, match="tests? .*: the executor failed: OSError: the network is gone"):
        study.run(tmp_path / "out", executor=Broken(6))
    assert (tmp_path / "out" / "trials.jsonl").read_text().count("\n") >= 3
    study.run(tmp_path / "out", resume=True)
    study.run(tmp_path / "whole")
    assert files(tmp_path / "out") == files(tmp_path / "whole")


class Lying(Executor):
    def __init__(self, change):
        self.change = change

    def submit(self, fn, /, *args, **kwargs):
        future = Future()
        ran = fn(*args, **kwargs)
        future.set_result(dataclasses.replace(ran, lines=self.change(ran.lines)))
        return future


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda lines: [], "returned no trial of test 0"),
        (lambda lines: lines * 2, "returned a trial of test .* that does not belong to the campaign"),
        (lambda lines: ["{}" for _ in lines], "the executor returned no trial: the line is not a trial"),
    ],
)
def test_trials_that_nobody_asked_for_end_a_campaign(change, says, tmp_path):
    with pytest.raises(pc.Error, match=says):
        STUDIES["open-loop"]().run(tmp_path / "out", executor=Lying(change))


@pytest.mark.parametrize("executor", ["two", 2.5, True, object()])
def test_what_is_no_executor_is_an_error(executor, tmp_path):
    with pytest.raises(pc.Error, match="executor is .*, expected a number of tests, an executor of concurrent.futures, a client of Dask"):
        STUDIES["open-loop"]().run(tmp_path / "out", executor=executor)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("number", [0, -1])
def test_no_test_at_a_time_is_an_error(number, tmp_path):
    with pytest.raises(pc.Error, match=f"executor is {number}, expected at least 1 test"):
        STUDIES["open-loop"]().run(tmp_path / "out", executor=number)


def test_a_study_that_cannot_be_pickled_is_an_error(tmp_path):
    lock = threading.Lock()

    def locked(test):
        with lock:
            return test["x"]

    study = pc.Study.of_function(locked, RIDGE, budget=4)
    with ProcessPoolExecutor(1, mp_context=SPAWN) as executor, pytest.raises(pc.Error, match="the study cannot be sent to other processes: .*lock"):
        study.run(tmp_path / "out", executor=executor)
    assert not (tmp_path / "out").exists()


def test_a_scenario_with_roads_of_a_file_travels(elsewhere, fuzz, tmp_path):
    pytest.importorskip("cloudpickle")
    assert fuzz("cut-in", "--budget", "2", "--out", "logged", "-q").returncode == 0
    assert fuzz("export", "logged", "1", "--out", "here/written", "-q").returncode == 0
    roads = pc.RoadNetwork.read(next(Path("written").glob("*.xodr")))
    road = roads.elements[0]

    @pc.scenario
    def on_a_file(s):
        speed = s.interval("speed", 5.0, 15.0)
        car = s.place(pc.AutonomousVehicle(s.place(roads).on_lane(road, -1, 10.0)).speed(10.0))
        s.require("slow", pc.always(car.speed() < speed))

    assert same(pc.Study(on_a_file, budget=4), elsewhere, tmp_path)
    assert elsewhere.sent


def test_a_script_may_define_what_travels(tmp_path):
    script = """
import concurrent.futures, multiprocessing, paracosm as pc

class Mine(pc.Driver):
    def step(self, observation):
        return pc.Control(0.2, 0.0)

@pc.scenario
def straight(s):
    speed = s.interval("speed", 5.0, 10.0)
    road = s.place(pc.RoadSegment(100))
    car = s.place(pc.AutonomousVehicle(road.on_lane(1, 10.0)).speed(speed.value()))
    s.require("slow", pc.always(car.speed() < 12.0))

if __name__ == "__main__":
    study = pc.Study(straight, driver=Mine(), budget=10)
    with concurrent.futures.ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as executor:
        study.run("executor", executor=executor)
    study.run("threads")
"""
    (tmp_path / "script.py").write_text(script)
    subprocess.run([sys.executable, "script.py"], cwd=tmp_path, check=True)
    assert files(tmp_path / "executor") == files(tmp_path / "threads")
