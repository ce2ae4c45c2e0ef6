"""Drivers in this process: they drive as over gRPC, and what they do wrong ends a test and nothing else."""

import json
import sys
import threading
from pathlib import Path

import paracosm as pc
import pytest
from example_drivers import Cautious, Sensing, still
from paracosm import protocol
from paracosm.driver import _welcome

HERE = Path(__file__).parent


@pytest.mark.parametrize(("driver", "budget"), [(Cautious, 30), (Sensing, 3)])
def test_a_driver_in_process_has_the_traces_of_the_same_driver_over_grpc(driver, budget, tmp_path):
    pytest.importorskip("grpc")
    command = f"{sys.executable} {HERE / 'example_drivers.py'} {driver.__name__}"
    settings = {"driver_settings": {"gain": 0.05, "seed": 7}, "budget": budget}
    try:
        ours = pc.Study(driver=driver(), **settings).run(tmp_path / "here", executor=2).trials.to_pandas()
    except pc.Error as error:
        if "adapter" in str(error):
            pytest.skip(str(error))
        raise
    there = pc.Study(driver_command=command, **settings).run(tmp_path / "there", executor=2).trials.to_pandas()
    assert ours.equals(there)
    assert ours["trace_hash"].notna().all()


def test_results_do_not_depend_on_the_number_of_threads(tmp_path):
    study = pc.Study(driver=Cautious(), budget=30)
    one, two = (study.run(tmp_path / str(n), executor=n).trials.to_pandas() for n in (1, 3))
    assert one.equals(two)


def test_a_function_or_a_class_is_a_driver_too(tmp_path):
    report = pc.Study(driver=still, budget=3).run(tmp_path / "function")
    assert report.verdicts["pass"] == 0 and "driver still" in repr(report)
    assert json.loads((tmp_path / "function" / "campaign.json").read_text())["driver"] == {"name": "still", "settings": {}}
    assert "driver Cautious" in repr(pc.Study(driver=Cautious, budget=3))
    assert "driver function" in repr(pc.Study(driver=lambda observation: pc.Control(), budget=3))


def test_settings_are_given_to_the_driver_and_noted_in_the_folder(tmp_path):
    def hashes(folder: str, **settings: float) -> list[str]:
        report = pc.Study(driver=Cautious(), driver_settings=settings, budget=4).run(tmp_path / folder)
        return list(report.trials.to_pandas()["trace_hash"])

    usual, quick, late = hashes("usual"), hashes("quick", gain=0.09), hashes("late", latency=0.3)
    assert usual != quick and usual != late and usual == hashes("same", gain=0.04)
    noted = json.loads((tmp_path / "quick" / "campaign.json").read_text())["driver"]
    assert noted == {"name": "Cautious", "settings": {"gain": 0.09}}


def test_a_test_can_be_replayed_while_the_driver_is_there_and_not_from_a_folder_alone(tmp_path):
    report = pc.Study(driver=Cautious(), budget=3).run(tmp_path / "run")
    assert len(report[1].replay()) > 0
    with pytest.raises(pc.Error, match="Cautious"):
        pc.load(tmp_path / "run")[1].replay()


class Wrong(pc.Driver):
    """A driver that does something wrong."""

    def __init__(self, what: str) -> None:
        self.what = what

    def reset(self, briefing: pc.Briefing) -> None:
        if self.what == "reset":
            raise ValueError("no such car")

    def step(self, observation: pc.Observation) -> pc.Control:
        if self.what == "raises":
            raise ValueError("no idea")
        if self.what == "exits":
            sys.exit(3)
        return {"number": 0.5, "nan": pc.Control(float("nan")), "range": pc.Control(2.0), "words": pc.Control("a")}[self.what]  # type: ignore


@pytest.mark.parametrize(
    ("what", "message"),
    [
        ("reset", "ValueError: no such car (test_drivers.py, line "),
        ("raises", "ValueError: no idea (test_drivers.py, line "),
        ("exits", "SystemExit: 3"),
        ("number", "step returned 0.5, expected a Control"),
        ("nan", "the driver's throttle is NaN"),
        ("range", "the driver's throttle is 2, expected -1 to 1"),
        ("words", "must be real number"),
    ],
)
def test_what_a_driver_does_wrong_ends_its_test_with_an_error(what, message, tmp_path):
    report = pc.Study(driver=Wrong(what), budget=4).run(tmp_path / "run")
    errors = list(report.trials.to_pandas()["error"])
    assert report.verdicts["error"] == 4 and all(message in error for error in errors), errors


class Locked(pc.Driver):
    def __init__(self) -> None:
        self.lock = threading.Lock()


class OddSensor(pc.Driver):
    cameras = {"front": "wide"}  # type: ignore[dict-item]


class OddLook(pc.Driver):
    look = "texture"


class NoLook(pc.Driver):
    look = None  # type: ignore[assignment]


class NoPeriod(pc.Driver):
    period = 0.0


class NoRays(pc.Driver):
    lidars = {"roof": pc.Lidar(channels=0)}


class Needy(pc.Driver):
    def __init__(self, network: str) -> None: ...


class OddPeriod(pc.Driver):
    period = "x"  # type: ignore[assignment]


class OddSettings(pc.Driver):
    settings = ["gain"]  # type: ignore[assignment]


class NoNumber(pc.Driver):
    settings = {"gain": float("nan")}


class OddOthers(pc.Driver):
    others = "no"  # type: ignore[assignment]


@pytest.mark.parametrize(
    ("driver", "settings", "message"),
    [
        (Locked, {}, "Locked cannot be copied, and each session has its own copy"),
        (OddPeriod, {}, "period of the driver is 'x', expected a number of seconds"),
        (OddSettings, {}, "settings of the driver is ['gain'], expected a dictionary"),
        (NoNumber, {}, "`gain` is nan, expected a number"),
        (OddOthers, {}, "others of the driver is 'no', expected True or False"),
        (Cautious(), {"gian": 0.1}, "Cautious has no setting `gian` (did you mean `gain`?)"),
        (Cautious(), {"gain": float("nan")}, "gain"),
        (Locked(), {}, "cannot be copied"),
        (OddSensor(), {}, "the sensor `front` is 'wide', expected a Camera"),
        (OddLook(), {}, "no look is called `texture` (did you mean `textured`?)"),
        (NoLook(), {}, "look of the driver is None, expected the name of a look"),
        (NoPeriod(), {}, "the driver's period is 0 s"),
        (NoRays(), {}, "impossible sensor"),
        (Needy, {}, "the class Needy needs arguments"),
        (5, {}, "driver is 5, expected the name of a driver, a Driver, or a function"),
    ],
)
def test_a_driver_that_cannot_begin_is_a_mistake_of_the_study(driver, settings, message):
    with pytest.raises(pc.Error) as error:
        pc.Study(driver=driver, driver_settings=settings, budget=3)
    assert message in str(error.value)


def test_a_study_has_one_driver():
    with pytest.raises(pc.Error, match="driver and driver_command exclude each other"):
        pc.Study(driver=Cautious(), driver_command="python3 brake.py", budget=3)


def test_ctrl_c_ends_a_step_that_never_returns(interrupted, tmp_path):
    script = """
        import paracosm as pc
        class Stuck(pc.Driver):
            def step(self, observation):
                if observation.time > 0.5:
                    print("stuck", flush=True)
                    while True: pass
                return pc.Control()
        pc.Study(driver=Stuck(), budget=20).run("out", executor=2)
    """
    assert "KeyboardInterrupt" in interrupted(script, "stuck")
    assert len(pc.load(tmp_path / "out")) == 0


def test_a_campaign_of_a_folder_gets_its_driver_again(tmp_path):
    class Coasting(pc.Driver):
        def step(self, observation: pc.Observation) -> pc.Control:
            return pc.Control(0.0, 0.0)

    pc.Study("cut-in", driver=Coasting, driver_settings={"latency": 0.1}, budget=2).run(tmp_path / "out")
    with pytest.raises(pc.Error, match="the program that ran the campaign made this driver"):
        pc.load(tmp_path / "out")[0].replay()
    assert len(pc.load(tmp_path / "out", driver=Coasting)[0].replay()["time"]) > 1
    with pytest.raises(pc.Error, match="found the driver `lambda`, expected `Coasting`|expected `Coasting`"):
        pc.load(tmp_path / "out", driver=lambda observation: pc.Control(0.0, 0.0))
    with pytest.raises(pc.Error, match="found the name of a driver"):
        pc.load(tmp_path / "out", driver="aeb")


def test_sensors_that_are_no_dictionary_are_an_error():
    class Blind(pc.Driver):
        cameras = None

        def step(self, observation: pc.Observation) -> pc.Control:
            return pc.Control(0.0, 0.0)

    with pytest.raises(pc.Error, match="cameras of the driver is None, expected a dictionary"):
        pc.Study("cut-in", driver=Blind, budget=2)


def test_a_driver_in_a_process_of_its_own_names_the_look_of_its_images():
    class Sees(pc.Driver):
        look = "textured"

    answer = protocol.Answer()
    _welcome(Sees(), protocol.Request().hello, answer.welcome, protocol.VERSION)
    assert answer.welcome.look == "textured"
