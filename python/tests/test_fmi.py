"""Drivers that are FMUs: an FMU that this test builds drives as the same driver in Python."""

import os
import platform
import shutil
import subprocess
import sys
import zipfile
from importlib import import_module
from pathlib import Path

import paracosm as pc
import pytest
from test_executors import SPAWN, Elsewhere, same

pytest.importorskip("fmpy")
from paracosm import fmi  # noqa: E402

HERE = Path(__file__).parent

VARIABLES = [
    ("speed", 0, "input"),
    ("cruise_speed", 1, "input"),
    ("lead_distance", 2, "input"),
    ("offset", 3, "input"),
    ("throttle", 4, "output"),
    ("steering", 5, "output"),
    ("gain", 6, "parameter"),
]


def described(version, variables=VARIABLES, kind="CoSimulation", more=""):
    """Returns a model description."""

    def scalar(name, reference, causality):
        start = "" if causality == "output" else ' start="0.2"'
        variability = ' variability="tunable"' if causality == "parameter" else ""
        common = f'name="{name}" valueReference="{reference}" causality="{causality}"{variability}'
        return f"<Float64 {common}{start}/>" if version == 3 else f"<ScalarVariable {common}><Real{start}/></ScalarVariable>"

    listed = "".join(scalar(*variable) for variable in variables)
    outputs = [(i, reference) for i, (_, reference, causality) in enumerate(variables, 1) if causality == "output"]
    if version == 3:
        identity, structure = "instantiationToken", "".join(f'<Output valueReference="{reference}"/>' for _, reference in outputs)
    else:
        identity, structure = "guid", f"<Outputs>{''.join(f'<Unknown index={chr(34)}{i}{chr(34)}/>' for i, _ in outputs)}</Outputs>"
    return (
        f'<?xml version="1.0" encoding="UTF-8"?><fmiModelDescription fmiVersion="{version}.0" modelName="acc" {identity}="{{acc}}">'
        f'<{kind} modelIdentifier="acc"{more}/><ModelVariables>{listed}</ModelVariables><ModelStructure>{structure}</ModelStructure></fmiModelDescription>'
    )


@pytest.fixture(scope="module", params=[2, 3], ids=["fmi2", "fmi3"])
def library(request, tmp_path_factory):
    compiler = shutil.which("cc")
    if compiler is None or not sys.platform.startswith("linux") or platform.machine() != "x86_64":
        pytest.skip("nothing compiles the FMU here")
    folder = tmp_path_factory.mktemp("fmu")
    # FMPy wants all functions of the standard.
    slave = import_module(f"fmpy.fmi{request.param}")
    names = [name for name in dir(getattr(slave, f"FMU{request.param}Slave")) if name.startswith(f"fmi{request.param}")]
    own = (HERE / "acc.c").read_text()
    (folder / "acc.c").write_text(own + "".join(f"E int {name}(void) {{ return 3; }}\n" for name in names if f" {name}(" not in own and f"*{name}(" not in own))
    flags = ["-DFMI3"] if request.param == 3 else []
    subprocess.run([compiler, "-shared", "-fPIC", "-O1", *flags, "-o", folder / "acc.so", folder / "acc.c"], check=True)
    return request.param, folder / "acc.so"


@pytest.fixture
def unit(library, tmp_path):
    version, built = library

    def packed(**changes):
        file = tmp_path / "acc.fmu"
        with zipfile.ZipFile(file, "w") as archive:
            archive.writestr("modelDescription.xml", described(version, **changes))
            archive.write(built, "binaries/x86_64-linux/acc.so" if version == 3 else "binaries/linux64/acc.so")
        return file

    return packed


OFFSET = {"offset": "way_offset"}


class Same(pc.Driver):
    """The driver of the FMU in Python."""

    period = 0.1
    others = True

    def reset(self, briefing: pc.Briefing) -> None:
        self.cruise_speed = briefing.cruise_speed

    def step(self, observation: pc.Observation) -> pc.Control:
        throttle = 0.2 * (self.cruise_speed - observation.speed)
        if fmi.QUANTITIES["lead_distance"](observation) < 2.0 * observation.speed:
            throttle = -1.0
        return pc.Control(min(max(throttle, -1.0), 1.0), -0.05 * observation.way.offset)


@pytest.mark.parametrize("scenario", ["cut-in", "follow-leader"])
def test_an_fmu_drives_as_the_same_driver_in_python(unit, tmp_path, scenario):
    study = pc.Study(scenario, driver=fmi.Driver(unit(), inputs=OFFSET), budget=16)
    ours = study.run(tmp_path / "fmu", executor=2)
    python = study.replace(driver=Same()).run(tmp_path / "python")
    assert ours.verdicts["error"] == 0 and ours.verdicts["fail"] + ours.verdicts["pass"] > 8
    assert [trial.trace_hash for trial in ours] == [trial.trace_hash for trial in python]
    again = pc.load(tmp_path / "fmu", driver=fmi.Driver(unit(), inputs=OFFSET))
    assert again[0].replay()["time"].size > 1


def test_an_fmu_leaves_the_present_folder_of_the_process_alone(unit, tmp_path, monkeypatch):
    # FMPy changes the folder while it loads code, which threads of a campaign would do to each other.
    driver, changes = fmi.Driver(unit(), inputs=OFFSET), []
    change = os.chdir
    monkeypatch.setattr(os, "chdir", lambda folder: (changes.append(folder), change(folder)))
    before = os.getcwd()
    pc.Study("cut-in", driver=driver, budget=30).run(tmp_path / "out", executor=4)
    assert changes == [] and os.getcwd() == before
    broken = tmp_path / "broken.fmu"
    with zipfile.ZipFile(unit()) as whole, zipfile.ZipFile(broken, "w") as archive:
        for name in whole.namelist():
            archive.writestr(name, b"no code" if name.endswith(".so") else whole.read(name))
    with pytest.raises(pc.Error, match="the code of .* cannot be loaded"):
        fmi.Driver(broken, inputs=OFFSET)
    assert os.getcwd() == before


def test_an_fmu_travels_to_other_machines(unit, tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", os.fspath(tmp_path / "cache"))
    monkeypatch.chdir(tmp_path)
    study = pc.Study("cut-in", driver=fmi.Driver(unit().name, inputs=OFFSET, parameters={"gain": 0.4}), budget=8)
    with Elsewhere(2, mp_context=SPAWN, initializer=os.chdir, initargs=("/",)) as executor:
        assert same(study, executor, tmp_path)
        assert executor.sent


def test_parameters_and_functions_reach_the_fmu(unit, tmp_path):
    study = pc.Study("cut-in", budget=6)
    usual, eager = (
        study.replace(driver=fmi.Driver(unit(), inputs={"offset": lambda observation: observation.way.offset}, parameters=parameters)).run(tmp_path / str(i))
        for i, parameters in enumerate([{}, {"gain": 0.9}])
    )
    assert [trial.trace_hash for trial in usual] != [trial.trace_hash for trial in eager]


def test_an_fmu_that_fails_ends_its_test_alone(unit, tmp_path):
    report = pc.Study("cut-in", driver=fmi.Driver(unit(), inputs=OFFSET, parameters={"gain": -1.0}), budget=8).run(tmp_path / "out")
    errors = [trial.error for trial in report if trial.verdict == "error"]
    assert len(errors) >= 4 and report.verdicts["error"] + report.verdicts["invalid"] == 8
    assert all("DoStep" in str(error) for error in errors)


@pytest.mark.parametrize(
    ("changes", "choices", "message"),
    [
        ({}, {}, "nothing is known for the input `offset`.*did you mean `way_offset`"),
        ({}, {"inputs": {"ofset": "speed"}}, "no input `ofset` .did you mean `offset`"),
        ({}, {"inputs": OFFSET, "outputs": {"throttle": "gas"}}, "no output `gas`.*it has throttle, steering"),
        ({}, {"inputs": OFFSET, "outputs": {"brake": "throttle"}}, "found the control `brake`"),
        ({}, {"inputs": OFFSET, "parameters": {"gian": 1.0}}, "no parameter `gian` .did you mean `gain`"),
        ({"kind": "ModelExchange"}, {"inputs": OFFSET}, "for model exchange, expected one for co-simulation"),
    ],
)
def test_an_fmu_that_does_not_fit_is_an_error(unit, changes, choices, message):
    with pytest.raises(pc.Error, match=message):
        fmi.Driver(unit(**changes), **choices)


def test_a_file_that_is_no_fmu_is_an_error(tmp_path):
    (tmp_path / "text.fmu").write_text("nothing")
    with pytest.raises(pc.Error, match="is no FMU that FMPy reads"):
        fmi.Driver(tmp_path / "text.fmu")
    with pytest.raises(pc.Error, match="found no file"):
        fmi.Driver(tmp_path / "missing.fmu")


def test_a_unit_with_one_instance_in_a_process_says_how_to_run_it(unit, tmp_path):
    driver = fmi.Driver(unit(more=' canBeInstantiatedOnlyOncePerProcess="true"'), inputs=OFFSET)
    study = pc.Study("cut-in", driver=driver, budget=6)
    assert study.run(tmp_path / "one", executor=1).verdicts["error"] == 0
