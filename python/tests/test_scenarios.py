"""Scenarios in Python: the same worlds as in Rust, and what happens to functions that go wrong."""

import importlib.util
import json
import os
import pickle
import subprocess
import sys
import textwrap
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import paracosm as pc
import pytest

EXAMPLES = Path(__file__).parents[2] / "examples" / "python"

CROSSING = """
    import paracosm as pc

    @pc.scenario
    def crossing(s):
        '''A pedestrian crosses.'''
        speed = s.interval("speed", 0.5, 10.0, unit="m/s")
        gap = s.interval("distance", 5.0, 60.0, unit="m")
        road = s.place(pc.RoadSegment(800).lanes(2))
        car = s.place(pc.AutonomousVehicle(road.on_lane(1, 10.0)).speed(16.7))
        walker = s.place(pc.Pedestrian(road.on_sidewalk("left", 100.0)))
        near = car.gap_along(road.crossing(100.0)) < gap
        walker.walk(road.on_sidewalk("right", 100.0), speed).skip_until(near).take_until(walker.arrived())
        s.require("no-collision", pc.never(car.collides()))
"""


def examples() -> Any:
    spec = importlib.util.spec_from_file_location("example_scenarios", EXAMPLES / "scenarios.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["example_scenarios"] = module
    spec.loader.exec_module(module)
    return module


def street(s: pc.Scenario) -> tuple[pc.Road, pc.Car]:
    road = s.place(pc.RoadSegment(300.0))
    return road, s.place(pc.AutonomousVehicle(road.on_lane(1, 10.0)).speed(10.0))


def declared(function: Callable[[pc.Scenario], Any]) -> pc.Study:
    return pc.Study(pc.scenario(function), budget=4)


OPENED = ["friction", "rain", "lanes", "zebra", "side", "acceleration", "approach_speed", "roadside"]


@pytest.mark.parametrize(
    ("name", "budget", "opened"),
    [
        ("pedestrian_crossing", 200, OPENED),
        ("cut_in", 120, ["acceleration", "side", "vehicle", "fog"]),
        ("follow_leader", 30, ["gap", "friction"]),
        ("t_loop", 3, []),
        ("grid_traffic", 3, ["cars"]),
        ("roundabout_entry", 30, ["friction"]),
        ("highway_traffic", 8, ["traffic_seed", "ego_speed"]),
    ],
)
def test_a_scenario_in_python_has_the_traces_of_the_scenario_in_rust(tmp_path, name, budget, opened):
    choices = {"budget": budget, "open": opened, "seed": 1}
    ours = pc.Study(getattr(examples(), name), **choices).run(tmp_path / "python").trials.to_pandas()
    theirs = pc.Study(name.replace("_", "-"), **choices).run(tmp_path / "rust").trials.to_pandas()
    # The messages of invalid tests name the scenario.
    assert ours.drop(columns="error").equals(theirs.drop(columns="error"))
    assert (ours["error"].isna() == theirs["error"].isna()).all()
    assert ours["trace_hash"].notna().sum() >= budget // 2


def test_a_study_of_a_scenario_in_python_differs_by_the_name_and_the_file_alone(tmp_path):
    def entries(scenario: str | pc.Program) -> dict[str, Any]:
        folder = tmp_path / str(isinstance(scenario, str))
        pc.Study(scenario, budget=2).run(folder)
        return json.loads((folder / "campaign.json").read_text())

    ours, theirs = entries(examples().cut_in), entries("cut-in")
    assert ours.pop("scenario").endswith("scenarios.py:cut-in") and len(ours.pop("scenario_files")) == 32
    assert theirs.pop("scenario") == "cut-in"
    assert ours == theirs


def test_the_operators_make_the_nodes_of_the_graph():
    seen = {}

    @pc.scenario
    def world(s):
        road, car = street(s)
        count = s.forward("count")
        before = count.pre().initially(0.0)
        count.define(before + 1.0)
        fast = (car.speed() > 5.0) & ~(car.position().x() < 20.0) | (3.0 < abs(-car.heading()))
        seen["fast"] = repr(fast)
        s.require("x", pc.eventually(fast.when(count >= 3.0).hold(False), within=(0, 5)).implies(pc.once(fast)))

    dot = world.dot()
    assert "count" in dot and "pre" in dot
    assert seen["fast"] == "Stream((((car.speed > 5) and not((x(car.position) < 20))) or (abs(-car.heading) > 3)))"


def test_streams_and_statements_mix_on_both_sides():
    @pc.scenario
    def world(s):
        slow = street(s)[1].speed() < 5.0
        s.require("a", slow | pc.eventually(~slow))
        s.require("b", pc.eventually(~slow) | slow)
        s.require("c", ~slow & pc.never(slow, within=(0, 1)))
        s.require("d", pc.until(~slow, slow, within=(0, 9)).implies(pc.historically(~slow)))

    formulas = [requirement["text"] for requirement in world.describe()["requirements"]]
    assert formulas[0] == "(car.speed < 5) or eventually not (car.speed < 5)"
    assert formulas[1] == "eventually not (car.speed < 5) or (car.speed < 5)"


def values_of(function: Callable[[pc.Car], pc.Stream], tmp_path: Path) -> np.ndarray:
    """Returns the samples of a stream of numbers over a run."""

    def world(s):
        s.interval("v", 0.0, 1.0)
        s.duration(1.0)
        _, car = street(s)
        s.require("x", pc.always(function(car).named("asked") > -1e9))

    report = pc.Study(pc.scenario(world), budget=1).run(tmp_path / "run")
    assert report.verdicts["pass"] == 1, report.trials.to_pandas()["error"]
    return np.asarray(report[0].replay()["asked"])


@pytest.mark.parametrize(
    ("stream", "expected"),
    [
        (lambda car: pc.Stream.time() * 2.0 + 1.0, lambda t: 2.0 * t + 1.0),
        (lambda car: 1.0 - pc.Stream.time() / 4.0, lambda t: 1.0 - t / 4.0),
        (lambda car: pc.Stream.time().max(0.5).min(0.7), lambda t: np.clip(t, 0.5, 0.7)),
        (lambda car: pc.Stream.vector(3.0, pc.Stream.time()).norm(), lambda t: np.hypot(3.0, t)),
        (lambda car: (pc.Stream.vector(1.0, 2.0) * pc.Stream.time()).dot((3.0, 4.0)), lambda t: 11.0 * t),
        (lambda car: pc.Stream.time().pre().initially(-1.0), lambda t: np.concatenate([[-1.0], t[:-1]])),
        (lambda car: pc.Stream.time().map(lambda x: x**2), lambda t: t**2),
        (lambda car: pc.Stream.time().scan(0.0, lambda total, x: total + x), np.cumsum),
        (lambda car: pc.Stream.time().map(lambda x: (x, 2 * x), returns=tuple).y(), lambda t: 2 * t),
        (lambda car: pc.Stream.time().filter(lambda x: x > 0.505).hold(0.0), lambda t: np.where(t > 0.505, t, 0.0)),
        (lambda car: pc.Stream.time().take(2).concat(7.0), lambda t: np.where(np.arange(len(t)) < 2, t, 7.0)),
        (lambda car: np.float64(2.0) * pc.Stream.time(), lambda t: 2.0 * t),
    ],
)
def test_a_stream_has_the_values_of_numpy(stream, expected, tmp_path):
    found = values_of(stream, tmp_path)
    times = np.arange(len(found)) * 0.01
    np.testing.assert_allclose(found, expected(times), rtol=1e-9, atol=1e-9)


def test_for_each_calls_a_function_of_python(tmp_path):
    told = []

    @pc.scenario
    def world(s):
        s.interval("v", 0.0, 1.0)
        s.duration(0.1)
        street(s)
        s.place(pc.Stream.time().for_each(told.append))

    pc.Study(world, budget=1).run(tmp_path / "run", executor=1)
    assert told[:3] == [0.0, 0.01, 0.02]


def raises(s):
    street(s)
    raise ValueError("no such street")


def returns(s):
    street(s)
    return 5


def no_lane(s):
    s.place(pc.RoadSegment(300.0)).on_lane(7, 10.0)


def branches(s):
    if street(s)[1].speed() < 3.0:
        pass


def chains(s):
    1 < street(s)[1].speed() < 3


def compares(s):
    street(s)[1].speed() == 3.0


def compares_a_parameter(s):
    if s.choice("lanes", [2, 4]) == 2:
        street(s)


def adds_a_word(s):
    street(s)[1].speed() + "km/h"


def mixes_types(s):
    (street(s)[1].speed() < 3.0) + 1.0


def drives_by_a_stream(s):
    speed, road = s.interval("v", 1.0, 2.0), s.place(pc.RoadSegment(300.0))
    s.place(pc.AutonomousVehicle(road.on_lane(1, 10.0)).speed(speed))


def streams_words(s):
    s.choice("v", ["a", "b"]) + 1.0


def asks_a_stream(s):
    street(s)[1].speed().value()


def places_a_number(s):
    s.place(5)


def misspells(s):
    road, _ = street(s)
    s.place(pc.Mover("other", "trck", road.path(1)))


def chooses_nothing(s):
    s.choice("v", [])


def takes_a_truth(s):
    s.choice("v", [True, False])


def looks_left(s):
    s.place(pc.RoadSegment(300.0)).on_sidewalk("lefty", 10.0)


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (raises, "ValueError: no such street"),
        (returns, "returned a value of the type int, expected nothing"),
        (no_lane, "has no lane 7"),
        (branches, "`&`, `|` and `~`"),
        (chains, "(a < b) & (b < c)"),
        (compares, "`a.equals(b)`"),
        (compares_a_parameter, "`parameter.value() == 2`"),
        (adds_a_word, "`+`: found a value of the type str, expected a stream or a number"),
        (mixes_types, "`+` does not work between a stream of truths and a stream of numbers"),
        (drives_by_a_stream, "`parameter.value()`"),
        (streams_words, "the values of the parameter `v` are words"),
        (asks_a_stream, "only a parameter has one"),
        (places_a_number, "found a value of the type int, expected an object"),
        (misspells, "no kind of body is called `trck` (did you mean `truck`?)"),
        (chooses_nothing, "parameter `v` has no values"),
        (takes_a_truth, "expected a number or a word"),
        (looks_left, 'found the side "lefty", expected "left" or "right"'),
    ],
)
def test_a_mistake_is_an_error_with_its_line(function, message):
    with pytest.raises(pc.Error) as error:
        declared(function)
    assert message in str(error.value)
    if function is not returns:
        first = function.__code__.co_firstlineno
        line = int(str(error.value).rsplit("test_scenarios.py, line ", 1)[1].split(",")[0])
        assert first < line <= first + 3


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (lambda s: None, "the number of ego vehicles is 0"),
        (lambda s: (s.interval("v", 0.0, 1.0), s.interval("v", 0.0, 1.0), street(s)), "declared twice"),
        (lambda s: (s.interval("v", 2.0, 1.0), street(s)), "interval [2, 1]"),
        (lambda s: (s.interval("v", 0.0, float("nan")), street(s)), "interval [0, NaN]"),
    ],
)
def test_what_only_the_whole_world_shows_is_an_error_too(function, message):
    def world(s):
        function(s)

    with pytest.raises(pc.Error, match=message.replace("[", r"\[")):
        declared(world)


def test_nothing_of_a_test_can_be_kept_for_the_next(tmp_path):
    kept: dict[str, pc.Stream] = {}

    def world(s):
        s.interval("v", 0.0, 1.0)
        _, car = street(s)
        s.require("x", pc.never(kept.setdefault("speed", car.speed()) > 100.0))

    with pytest.raises(pc.Error, match="belongs to the world of an earlier test"):
        declared(world)
    with pytest.raises(pc.Error, match="keep none"):
        kept["speed"] + 1.0


def errors_of(function: Callable[[pc.Scenario], None], folder: Path) -> tuple[dict[str, int], list[str]]:
    report = pc.Study(pc.scenario(function), budget=6).run(folder)
    return report.verdicts, [error for error in report.trials.to_pandas()["error"] if isinstance(error, str)]


def test_what_goes_wrong_in_a_test_ends_that_test_alone(tmp_path):
    def too_quick(s):
        speed = s.interval("v", 1.0, 2.0)
        street(s)
        if speed.value() > 1.5:
            raise ValueError("too quick")

    verdicts, errors = errors_of(too_quick, tmp_path / "run")
    assert verdicts["error"] == len(errors) == 2 and verdicts["pass"] == 4
    assert all("ValueError: too quick (test_scenarios.py, line " in error for error in errors)


def test_a_refused_test_is_invalid(tmp_path):
    def refuses(s):
        speed = s.interval("v", 1.0, 2.0)
        street(s)
        if speed.value() > 1.5:
            s.refuse("too quick")

    verdicts, errors = errors_of(refuses, tmp_path / "run")
    assert verdicts["invalid"] == 2 and verdicts["error"] == 0 and all("too quick" in error for error in errors)


def test_a_function_that_asks_for_other_parameters_each_time_gives_errors(tmp_path):
    asked = iter(range(1000))

    def changes(s):
        s.interval(f"v{next(asked)}", 1.0, 2.0)
        street(s)

    verdicts, errors = errors_of(changes, tmp_path / "run")
    assert verdicts["error"] == 6 and all("asked for other parameters than the test has" in error for error in errors)


@pytest.mark.parametrize(
    ("function", "message"), [(lambda x: 1 / 0, "ZeroDivisionError"), (lambda x: "no", "found 'no', expected a number")]
)
def test_a_function_of_a_stream_that_goes_wrong_ends_its_test(function, message, tmp_path):
    def world(s):
        s.interval("v", 1.0, 2.0)
        s.require("x", pc.never(street(s)[1].speed().map(function) > 3.0))

    verdicts, errors = errors_of(world, tmp_path / "run")
    assert verdicts["error"] == 6
    assert all(message in error and "in the function of a stream at test_scenarios.py, line" in error for error in errors)


def test_a_function_without_the_decorator_is_an_error_that_says_so():
    with pytest.raises(pc.Error, match="write `@paracosm.scenario` above the function"):
        pc.Study(raises)  # type: ignore[arg-type]
    with pytest.raises(pc.Error, match="expected a name or a file of a scenario"):
        pc.Study(5)  # type: ignore[arg-type]


def test_a_scenario_can_extend_another(tmp_path):
    @pc.scenario
    def base(s):
        s.interval("v", 1.0, 2.0)
        street(s)

    @pc.scenario(name="longer", about="the same street for longer")
    def extended(s):
        base(s)
        s.duration(12.0)

    assert extended.name.endswith(":longer") and extended.about == "the same street for longer"
    assert pc.Study(extended, budget=2).space.names == ["v"]


def test_a_study_of_a_scenario_at_the_level_of_a_module_can_be_pickled():
    study = pc.Study(examples().cut_in, budget=7)
    again = pickle.loads(pickle.dumps(study))
    assert repr(again) == repr(study) and again.scenario == study.scenario


def test_ctrl_c_ends_a_function_that_never_returns(interrupted, tmp_path):
    script = """
        import paracosm as pc
        @pc.scenario
        def loops(s):
            speed = s.interval("v", 1.0, 2.0)
            road = s.place(pc.RoadSegment(300.0))
            s.place(pc.AutonomousVehicle(road.on_lane(1, 10.0)).speed(10.0))
            if 1.7 < speed.value() < 1.8:
                print("looping", flush=True)
                while True: pass
        pc.Study(loops, budget=20).run("out", executor=2)
    """
    assert "KeyboardInterrupt" in interrupted(script, "looping")
    # The test that was interrupted did not end, so it is not in the log.
    report = pc.load(tmp_path / "out")
    assert report.verdicts["error"] == 0


def test_ctrl_c_ends_a_function_of_a_stream_that_never_returns(interrupted):
    script = """
        import paracosm as pc
        def stuck(value):
            print("stuck", flush=True)
            while True: pass
        @pc.scenario
        def world(s):
            speed = s.interval("v", 1.0, 2.0)
            road = s.place(pc.RoadSegment(300.0))
            s.place(pc.AutonomousVehicle(road.on_lane(1, 10.0)).speed(10.0))
            s.require("m", pc.never(speed.map(stuck) < 0.0))
        pc.Study(world, budget=20).run("out", executor=1)
    """
    assert "KeyboardInterrupt" in interrupted(script, "stuck")


def test_the_program_takes_a_scenario_in_a_file(fuzz, tmp_path):
    (tmp_path / "crossing.py").write_text(textwrap.dedent(CROSSING))
    ran = fuzz("crossing.py", "--driver", "aeb", "--budget", "30", "--fail-on-violation")
    assert ran.returncode == 1, ran.stderr
    study = json.loads((tmp_path / "paracosm-out" / "campaign.json").read_text())
    assert study["scenario"] == "crossing.py:crossing"
    listed = fuzz("describe", "crossing.py:crossing")
    assert "A pedestrian crosses" in listed.stdout and "speed" in listed.stdout
    assert fuzz("describe", "crossing.py", "--dot").stdout.startswith("digraph")
    # The commands that are printed can be typed as they are.
    replay = next(line for line in ran.stdout.splitlines() if line.split()[:1] == ["replay"]).split()
    assert replay[-1] == "--trust"
    assert "as logged" in fuzz(*replay[2:]).stdout
    assert "30 of 30 tests" in fuzz("repeat", "paracosm-out", "--out", "again", "--trust").stdout


def test_the_file_that_a_folder_names_runs_only_with_trust(fuzz, tmp_path):
    (tmp_path / "crossing.py").write_text(textwrap.dedent(CROSSING) + "\nprint('it ran')\n")
    assert "it ran" in fuzz("crossing.py", "--budget", "5").stdout
    for command in (("replay", "paracosm-out", "1"), ("map", "paracosm-out"), ("report", "paracosm-out", "--out", "r.html")):
        done = fuzz(*command)
        assert "it ran" not in done.stdout, command
    refused = fuzz("replay", "paracosm-out", "1")
    assert refused.returncode == 2 and "--trust" in refused.stderr
    assert "it ran" in fuzz("replay", "paracosm-out", "1", "--trust").stdout


def test_shards_of_a_scenario_in_a_file_are_merged_with_trust_alone(fuzz, tmp_path):
    (tmp_path / "crossing.py").write_text(textwrap.dedent(CROSSING))
    for number in (1, 2):
        fuzz("crossing.py", "--budget", "10", "--shard", f"{number}/2", "--out", f"part-{number}")
    refused = fuzz("merge", "whole", "part-1", "part-2")
    assert refused.returncode == 2 and "--trust" in refused.stderr
    assert not (tmp_path / "whole").exists(), "a folder that merge cannot complete is in the way of the next merge"
    assert fuzz("merge", "whole", "part-1", "part-2", "--trust").returncode == 0
    fuzz("crossing.py", "--budget", "10", "--out", "one")
    whole, one = (json.loads((tmp_path / name / "modes.json").read_text()) for name in ("whole", "one"))
    assert whole == one
    assert (tmp_path / "whole" / "trials.jsonl").read_bytes() == (tmp_path / "one" / "trials.jsonl").read_bytes()


@pytest.mark.parametrize("name", ["night: rain", "two\nlines"])
def test_a_name_that_no_command_could_give_is_refused(name):
    with pytest.raises(pc.Error, match="the name of the scenario is"):
        pc.scenario(name=name)(lambda s: None)


def test_roads_of_a_file_are_roads_of_a_scenario(fuzz, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert fuzz("cut-in", "--budget", "2", "--out", "logged", "-q").returncode == 0
    assert fuzz("export", "logged", "1", "--out", "written", "-q").returncode == 0
    file = next(Path("written").glob("*.xodr"))
    roads = pc.RoadNetwork.read(file)
    road = roads.elements[0]

    @pc.scenario
    def on_a_file(s: pc.Scenario) -> None:
        speed = s.interval("speed", 5.0, 15.0)
        streets = s.place(roads)
        car = s.place(pc.AutonomousVehicle(streets.on_lane(road, -1, 10.0)).speed(10.0))
        s.require("slow", pc.always(car.speed() < speed))

    study = pc.Study(on_a_file, budget=4)
    report = study.run("out")
    assert report.verdicts["error"] == 0 and report.verdicts["invalid"] == 0
    assert report.verdicts["fail"] > 0 and report.verdicts["pass"] > 0
    # The roads belong to the campaign: other roads are noticed.
    named = json.loads(Path("out/campaign.json").read_text())["scenario_files"]
    assert named.count("+") == 1
    file.write_text(file.read_text().replace("</OpenDRIVE>", "<!-- changed -->\n</OpenDRIVE>"))
    roads = pc.RoadNetwork.read(file)
    with pytest.raises(pc.Error, match="another campaign|different campaign|has changed"):
        pc.Study(on_a_file, budget=4).run("out", resume=True)
    with pytest.raises(pc.Error, match="nowhere.xodr"):
        pc.RoadNetwork.read("nowhere.xodr")


def test_a_file_that_has_changed_is_noticed(fuzz, tmp_path):
    (tmp_path / "crossing.py").write_text(textwrap.dedent(CROSSING))
    fuzz("crossing.py", "--budget", "5")
    (tmp_path / "crossing.py").write_text(textwrap.dedent(CROSSING).replace('"left", 100.0', '"left", 101.0'))
    resumed = fuzz("crossing.py", "--budget", "5", "--resume")
    assert resumed.returncode == 2 and "scenario_files" in resumed.stderr
    replayed = fuzz("replay", "paracosm-out", "1", "--trust")
    assert replayed.returncode == 2 and "trace hash: " in replayed.stderr and ", logged " in replayed.stderr
    shares = fuzz("sensitivity", "paracosm-out", "--budget", "64", "--trust")
    assert "has another trace than in the log" in shares.stdout and "the shares describe the present scenario and driver" in shares.stdout


@pytest.mark.parametrize(
    ("text", "name", "message"),
    [
        ("x = 1", "worlds.py", "worlds.py has no scenario: write `@paracosm.scenario`"),
        ("x = (", "worlds.py", "SyntaxError: '(' was never closed (worlds.py, line 1)"),
        ("1 / 0", "worlds.py", "ZeroDivisionError: division by zero (worlds.py, line 1, in <module>)"),
        (CROSSING, "worlds.py:crosing", "worlds.py has no scenario `crosing` (did you mean `crossing`?)"),
        (CROSSING + CROSSING.replace("crossing(", "second("), "worlds.py", "worlds.py has 2 scenarios: crossing, second"),
        (CROSSING, "world.py", "found no file world.py"),
    ],
)
def test_a_file_without_the_scenario_is_an_error_that_says_what_it_has(fuzz, tmp_path, text, name, message):
    (tmp_path / "worlds.py").write_text(textwrap.dedent(text))
    done = fuzz(name, "--budget", "5")
    assert done.returncode == 2 and message in done.stderr, done.stderr


def test_a_fresh_process_reads_a_campaign_and_runs_its_tests_only_with_trust(tmp_path):
    (tmp_path / "crossing.py").write_text(textwrap.dedent(CROSSING))
    script = "import paracosm as pc; from crossing import crossing; pc.Study(crossing, budget=5).run('out')"
    subprocess.run([sys.executable, "-c", script], cwd=tmp_path, check=True, env={**os.environ, "PYTHONPATH": str(tmp_path)})
    report = pc.load(tmp_path / "out")
    assert len(report) == 5
    with pytest.raises(pc.Error, match="trust=True"):
        report[0].replay()
    assert len(pc.load(tmp_path / "out", trust=True)[0].replay()) > 0


def requires_a_stream(s):
    s.require("slow", street(s)[1].speed() < 5.0)


def starts_at_a_stream(s):
    speed, (road, _) = s.interval("v", 1.0, 2.0), street(s)
    s.place(pc.Mover.car(road.path(1)).starting(speed))


def drives_a_stream_of_lanes(s):
    s.place(pc.RoadSegment(300.0).lanes(s.choice("lanes", [2, 4])))


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (requires_a_stream, "write `pc.always(..)`, `pc.never(..)` or `pc.eventually(..)`"),
        (starts_at_a_stream, "write `parameter.value()`"),
        (drives_a_stream_of_lanes, "write `parameter.value()`"),
    ],
)
def test_a_stream_in_the_wrong_place_is_an_error_that_says_what_to_write(function, message):
    with pytest.raises(pc.Error) as error:
        declared(function)
    assert message in str(error.value)


@pytest.mark.parametrize(
    ("state", "message"),
    [
        (lambda s, car: s.require("x", pc.never(car.collides)), "found a method, expected what it returns: write `collides()`"),
        (lambda s, car: s.require("x", pc.never(car.collides(), within=5)), "within is 5, expected a pair of numbers of seconds"),
        (lambda s, car: s.require("x", pc.never(car.collides(), within=(5, 1))), "the smaller one first"),
        (lambda s, car: s.monitor(pc.never(car.collides())), "`s.require("),
    ],
)
def test_a_statement_that_is_none_is_an_error_that_says_what_to_write(state, message):
    def world(s):
        state(s, street(s)[1])

    with pytest.raises(pc.Error) as error:
        declared(world)
    assert message in str(error.value)


def deep(s, x):
    for _ in range(100_000):
        x = x + 1.0
    s.require("r", pc.never(x < 0.0))


def wide(s, x):
    for _ in range(100):
        x = x + x
    s.require("r", pc.never(x < 0.0))


def wide_statement(s, x):
    statement = pc.never(x < 0.0)
    for _ in range(100):
        statement = statement & statement
    s.require("r", statement)


def deep_statement(s, x):
    statement = pc.never(x < 0.0)
    for _ in range(100_000):
        statement = ~statement
    s.require("r", statement)


@pytest.mark.parametrize("nest", [deep, wide, wide_statement, deep_statement])
def test_a_loop_that_nests_without_end_is_an_error_and_not_the_end_of_the_interpreter(nest):
    def world(s):
        speed = s.interval("v", 0.0, 1.0)
        street(s)
        nest(s, speed)

    with pytest.raises(pc.Error, match="more than 1"):
        declared(world)


def test_many_operators_are_no_mistake_if_a_stream_that_is_used_often_has_a_name(tmp_path):
    def world(s):
        total = s.interval("v", 0.0, 1.0)
        street(s)
        s.duration(0.5)
        for i in range(300):
            total = (total + total * 0.001).named(f"total-{i}")
        s.require("r", pc.always(total >= 0.0))

    assert pc.Study(pc.scenario(world), budget=3).run(tmp_path / "run").verdicts["pass"] == 3


def test_a_scenario_describes_itself():
    told = examples().cut_in.describe()
    side = next(parameter for parameter in told["parameters"] if parameter["name"] == "side")
    assert side["choice"] == ["left", "right"] and not side["open"] and side["nominal"] == "left"
    assert told["duration"] == 20.0 and told["dt"] == 0.01 and "other.position" in told["premise"]
    seen = []

    @pc.scenario
    def world(s):
        seen.append(repr(s.choice("kind", ["a", "b"])))
        street(s)

    assert world.describe()["premise"] is None and seen == ["Stream(kind, a parameter of words)"]


def test_the_lanes_of_a_path_follow_each_other():
    loop = examples().LOOP
    assert loop.path([("side 1", 1), ("tee 2", "three", "two", 1)]).length > 60.0
    with pytest.raises(pc.Error, match="lane 2 of the path does not begin where lane 1 ends"):
        loop.path([("side 1", 1), ("side 3", 1)])


def test_objects_that_are_not_placed_can_stand_outside_of_the_function(tmp_path):
    road = pc.RoadSegment(300.0).friction(0.5)
    place = pc.Pose(5.0, 0.0)
    car = pc.AutonomousVehicle(place).speed(10.0)
    other = pc.Mover("other", "van", pc.Path.straight(pc.Pose(60.0, 0.0), pc.Pose(200.0, 0.0))).speed(4.0).offset(0.5)
    fog = pc.Environment(fog=0.3, sun=(0.5, 1.0))

    def world(s):
        s.interval("v", 1.0, 2.0)
        s.place(road)
        under_test = s.place(car)
        s.place(other)
        s.place(fog)
        s.require("x", pc.never(under_test.collides()))

    verdicts, errors = errors_of(world, tmp_path / "run")
    assert errors == [] and verdicts["error"] == 0


@pytest.mark.parametrize("use", ["stream", "statement", "monitor", "handle"])
def test_what_belongs_to_one_world_cannot_stand_outside_of_the_function(tmp_path, use):
    kept: dict[str, Any] = {}
    outside = {"stream": pc.Stream.time(), "statement": pc.never(pc.Stream.time() > 100.0)}

    def world(s):
        s.interval("v", 1.0, 2.0)
        road, car = street(s)
        if use == "stream":
            s.require("x", pc.never((outside["stream"] + car.speed()) > 100.0))
        if use == "statement":
            s.require("x", outside["statement"])
        if use == "monitor":
            s.monitor(kept.setdefault("monitor", pc.Monitor.no_collision(car)))
        if use == "handle":
            kept.setdefault("road", road).on_lane(1, 10.0)

    if use in ("stream", "statement"):
        with pytest.raises(pc.Error, match="outside of the function of the scenario"):
            errors_of(world, tmp_path / "run")
    else:
        with pytest.raises(pc.Error, match="belongs to the world of an earlier test"):
            declared(world)


def test_the_collector_of_python_may_drop_handles_in_any_thread(tmp_path):
    program = """
        import gc, threading
        import paracosm as pc

        @pc.scenario
        def world(s):
            speed = s.interval("v", 1.0, 2.0)
            road = s.place(pc.RoadSegment(300.0))
            car = s.place(pc.AutonomousVehicle(road.on_lane(1, 10.0)).speed(10.0))
            cycle = {"car": car, "speed": speed, "slow": car.speed() < 100.0}
            cycle["self"] = cycle
            s.require("x", pc.always(cycle["slow"]))

        gc.disable()
        print(pc.Study(world, budget=40).run("run", executor=2).verdicts["pass"])
        threading.Thread(target=gc.collect).start()
    """
    (tmp_path / "cycles.py").write_text(textwrap.dedent(program))
    ran = subprocess.run([sys.executable, "-W", "ignore:no effect", "cycles.py"], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert (ran.returncode, ran.stdout, ran.stderr) == (0, "40\n", "")


def test_a_requirement_that_a_later_test_does_not_state_is_no_pass(tmp_path):
    tests = iter(range(1000))

    def world(s):
        s.interval("v", 1.0, 2.0)
        _, car = street(s)
        if next(tests) < 3:
            s.require("slow", pc.never(car.speed() > 100.0))
        s.require("forward", pc.never(car.speed() < -1.0))

    verdicts, errors = errors_of(world, tmp_path / "run")
    assert verdicts["error"] >= 3 and verdicts["error"] == len(errors)
    assert all("one side only: slow" in error for error in errors)


def test_a_name_of_any_length_is_described(fuzz, tmp_path):
    name = "v" * 70_000
    (tmp_path / "long.py").write_text(textwrap.dedent(CROSSING).replace('"speed"', f'"{name}"'))
    described = fuzz("describe", "long.py")
    assert described.returncode == 0 and name in described.stdout


HELPER = """
    import functools
    import paracosm as pc

    def slowly(build):
        def slow(s):
            build(s)
        return slow

    def of_speed(speed):
        def world(s):
            s.interval("v", 1.0, 2.0)
            road = s.place(pc.RoadSegment(300.0))
            s.place(pc.AutonomousVehicle(road.on_lane(1, 10.0)).speed(speed))
        return world

    class World:
        '''A world of an object.'''
        def __call__(self, s):
            of_speed(5.0)(s)

    def with_speed(s, speed):
        of_speed(speed)(s)
"""


def test_partial_functions_objects_and_decorated_functions_are_scenarios_of_the_file_that_names_them(fuzz, tmp_path):
    (tmp_path / "helper.py").write_text(textwrap.dedent(HELPER))
    scenarios = """
        import functools
        import paracosm as pc
        from helper import World, of_speed, slowly, with_speed

        @pc.scenario
        @slowly
        def decorated(s):
            of_speed(4.0)(s)

        fast = pc.scenario(name="fast")(of_speed(9.0))
        partial = pc.scenario(functools.partial(with_speed, speed=3.0))
        called = pc.scenario(World())
    """
    (tmp_path / "several.py").write_text(textwrap.dedent(scenarios))
    found = fuzz("describe", "several.py:nothing")
    assert "several.py has 4" in found.stderr or "the file has slow, fast, with-speed, World" in found.stderr
    ran = fuzz("run", "several.py:World", "--budget", "2", "--out", "out")
    assert ran.returncode == 0, ran.stderr
    assert json.loads((tmp_path / "out" / "campaign.json").read_text())["scenario"] == "several.py:World"


def test_two_scenarios_of_a_file_need_two_names(fuzz, tmp_path):
    (tmp_path / "helper.py").write_text(textwrap.dedent(HELPER))
    twice = "import paracosm as pc\nfrom helper import of_speed\none = pc.scenario(of_speed(1.0))\nother = pc.scenario(of_speed(2.0))\n"
    (tmp_path / "twice.py").write_text(twice)
    found = fuzz("describe", "twice.py")
    assert found.returncode == 2 and "twice.py has two scenarios called `world`" in found.stderr


def test_a_scenario_of_a_notebook_cannot_take_a_name_of_the_catalogue():
    space: dict[str, Any] = {"pc": pc}
    with pytest.raises(pc.Error, match="the catalogue has a scenario `cut-in`"):
        exec("@pc.scenario\ndef cut_in(s): pass", space)


@pytest.mark.parametrize(
    ("use", "message"),
    [
        (lambda s, speed: speed**2, "streams have no `**`: write `a * a`"),
        (lambda s, speed: speed % 2, "streams have no `%`"),
        (lambda s, speed: max(speed, 3.0), "`a.max(b)`"),
        (lambda s, speed: speed + 10**400, "an integer that is too large"),
        (lambda s, speed: s.choice("c", "abc"), "the values of parameter `c` are 'abc', expected a list"),
        (lambda s, speed: s.intervall("c", 1, 2), "did you mean `interval`?"),
        (lambda s, speed: pc.RoadSegment(10).lanes(2.5), "while processing 'lanes'"),
    ],
)
def test_a_wrong_word_or_type_is_an_error_that_says_what_to_write(use, message):
    def world(s):
        s.interval("v", 1.0, 2.0)
        _, car = street(s)
        use(s, car.speed())

    with pytest.raises(pc.Error) as error:
        declared(world)
    assert message in str(error.value)


def test_what_a_function_of_a_stream_raises_is_the_error_of_the_test(tmp_path):
    def world(s):
        s.interval("v", 1.0, 2.0)
        _, car = street(s)
        s.require("x", pc.never(car.speed().map(lambda speed: 1 / 0) > 3.0))

    _, errors = errors_of(world, tmp_path / "run")
    assert errors and all(error.startswith("ZeroDivisionError: division by zero (test_scenarios.py, line") for error in errors)
