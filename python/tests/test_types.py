"""The types of the package: the stubs are those of the compiled module, and programs of users pass `mypy --strict`."""

import dataclasses
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import paracosm as pc
import pytest

HERE = Path(__file__).parent
# The packages that the types of this package come from are read once.
CACHE = tempfile.TemporaryDirectory()


def run(*arguments: str) -> None:
    pytest.importorskip("mypy")
    # Types are checked as users have them: with the installed package.
    environment = {**os.environ, "MYPY_CACHE_DIR": CACHE.name}
    done = subprocess.run([sys.executable, "-m", *arguments], capture_output=True, text=True, cwd=HERE, env=environment)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_stubs_are_those_of_the_compiled_module():
    run("mypy.stubtest", "paracosm._core", "--ignore-disjoint-bases")


def test_the_package_and_a_program_of_a_user_pass_strict_checks():
    pytest.importorskip("grpc")
    pytest.importorskip("google.protobuf")
    run("mypy", "--strict", "--package", "paracosm")
    run("mypy", "--strict", "typed_program.py")


@pytest.mark.parametrize("example", ["examples/python/scenarios.py", "python/examples/brake.py", "python/examples/lane_follow.py"])
def test_the_examples_pass_strict_checks(example):
    pytest.importorskip("grpc")
    run("mypy", "--strict", os.fspath(HERE.parents[1] / example))


def test_every_public_name_has_documentation():
    silent = [name for name in pc.__all__ if not (getattr(pc, name).__doc__ or "").strip()]
    assert not silent


def test_the_documentation_of_a_record_names_all_its_fields():
    records = [getattr(pc, name) for name in pc.__all__ if dataclasses.is_dataclass(getattr(pc, name))]
    assert len(records) >= 15
    for record in records:
        named = {name for line in re.findall(r"^ *- ([\w, ]+):", record.__doc__, re.M) for name in line.split(", ")}
        assert named == {field.name for field in dataclasses.fields(record)}, record


def test_a_program_of_a_user_runs():
    assert subprocess.run([sys.executable, HERE / "typed_program.py"]).returncode == 0
