"""Questions to a campaign from Python, with the answers of the programs: maps, sensitivity, audits."""

import json

import numpy as np
import paracosm as pc
import pytest


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    folder = tmp_path_factory.mktemp("campaign") / "out"
    return pc.Study("pedestrian-crossing", driver="planner", open=["friction"], strategy="halton", budget=120, seed=0).run(folder)


def test_a_map_over_named_parameters_is_that_of_the_program(campaign, fuzz, tmp_path):
    found = campaign.map("friction", "speed")
    assert found.axes == ("friction", "speed")
    said = json.loads(fuzz("map", str(campaign.folder), "--x", "friction", "--y", "speed", "--out", str(tmp_path / "theirs.png"), "--format", "json").stdout)
    assert (found.failing, found.decided) == (said["failing"], said["decided"])
    for kind in ("svg", "png", "csv"):
        found.save(tmp_path / f"ours.{kind}")
        fuzz("map", str(campaign.folder), "--x", "friction", "--y", "speed", "--out", str(tmp_path / f"theirs.{kind}"))
        assert (tmp_path / f"ours.{kind}").read_bytes() == (tmp_path / f"theirs.{kind}").read_bytes(), kind
    assert found._repr_png_() == (tmp_path / "ours.png").read_bytes() and found.svg().startswith("<svg")
    assert "friction" in found.estimate.columns


def test_a_map_without_names_takes_the_parameters_that_separate_best(campaign, fuzz):
    said = json.loads(fuzz("map", str(campaign.folder), "--format", "json").stdout)
    assert campaign.map().axes == (said["x"], said["y"])


@pytest.mark.parametrize(
    ("names", "show", "message"),
    [
        (("frictoin", None), "failures", "did you mean `friction`"),
        (("speed", "speed"), "failures", "speed"),
        ((None, None), "speed", 'expected "failures" or "severity"'),
    ],
)
def test_a_map_that_cannot_be_is_an_error(campaign, names, show, message):
    with pytest.raises(pc.Error, match=message):
        campaign.map(*names, show=show)


def test_a_map_is_saved_as_one_of_its_kinds(campaign, tmp_path):
    with pytest.raises(pc.Error, match="expected a file .svg, .png or .csv"):
        campaign.map().save(tmp_path / "map.pdf")
    with pytest.raises(pc.Error, match="nowhere"):
        campaign.map().save(tmp_path / "nowhere" / "map.png")


def test_the_sensitivity_is_that_of_the_program(campaign, fuzz):
    assert campaign.sensitivity() == json.loads(fuzz("sensitivity", str(campaign.folder), "--format", "json").stdout)
    ours = campaign.sensitivity(budget=80, seed=3)
    assert ours == json.loads(fuzz("sensitivity", str(campaign.folder), "--budget", "80", "--seed", "3", "--format", "json").stdout)
    with pytest.raises(pc.Error, match="budget"):
        campaign.sensitivity(budget=3)


def test_an_audit_is_that_of_the_program(fuzz, tmp_path):
    study = pc.Study("cut-in", driver="planner")
    ours = study.audit("halton:12", mutants=6, screen=16, executor=2)
    options = ["--driver", "planner", "--tests", "halton:12", "--mutants", "6", "--screen", "16", "--out", str(tmp_path / "audit"), "-q"]
    ran = fuzz("audit", "cut-in", *options)
    assert ran.returncode == 0, ran.stderr
    assert ours == json.loads((tmp_path / "audit" / "audit.json").read_text())


def test_a_suite_can_be_a_table_of_tests(tmp_path):
    study = pc.Study("cut-in", driver="planner")
    tests = pc.sample(study.space, n=10, method="lhs", seed=1)
    found = study.audit(tests, {name: np.asarray(tests[name]) for name in tests.columns}, mutants=0)
    other = found["others"][0]
    assert (found["suite"], other["suite"]) == ("suite 1", "suite 2") and found["tests"] == other["tests"] == 10
    assert found["hole"] == other["hole"] and found["rows"] == other["rows"]
    for suites, message in [((), "found no suite"), (("haltn:3",), "haltn"), (("halton",), "without a number of tests")]:
        with pytest.raises(pc.Error, match=message):
            study.audit(*suites, mutants=0)
