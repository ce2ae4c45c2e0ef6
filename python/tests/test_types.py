"""The types of the package: the stubs are those of the compiled module, and programs of users pass `mypy --strict`."""

import os
import subprocess
import sys
from pathlib import Path

import paracosm as pc
import pytest

HERE = Path(__file__).parent


def run(*arguments: str) -> None:
    pytest.importorskip("mypy")
    # Types are checked as users have them: with the installed package.
    environment = {**os.environ, "MYPY_CACHE_DIR": os.devnull}
    done = subprocess.run([sys.executable, "-m", *arguments], capture_output=True, text=True, cwd=HERE, env=environment)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_stubs_are_those_of_the_compiled_module():
    run("mypy.stubtest", "paracosm._core", "--ignore-disjoint-bases")


def test_the_package_and_a_program_of_a_user_pass_strict_checks():
    pytest.importorskip("grpc")
    pytest.importorskip("google.protobuf")
    run("mypy", "--strict", "--package", "paracosm")
    run("mypy", "--strict", "typed_program.py")


def test_every_public_name_has_documentation():
    silent = [name for name in pc.__all__ if not (getattr(pc, name).__doc__ or "").strip()]
    assert not silent


def test_a_program_of_a_user_runs():
    assert subprocess.run([sys.executable, HERE / "typed_program.py"]).returncode == 0
