"""The installed package is tested, with its compiled module and its programs."""

import json
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

Program = Callable[..., str]


def _found(name: str) -> str:
    beside = Path(sys.executable).with_name(name)
    found = str(beside) if beside.exists() else shutil.which(name)
    assert found is not None, f"the package did not install {name}"
    return found


@pytest.fixture
def cover(tmp_path: Path) -> Program:
    """Runs `paracosm-cover` in an empty folder, and returns what it prints."""

    def run(*arguments: str) -> str:
        done = subprocess.run([_found("paracosm-cover"), *arguments], cwd=tmp_path, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run


@pytest.fixture
def fuzz(tmp_path: Path) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Runs `paracosm-fuzz` in an empty folder."""

    def run(*arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run([_found("paracosm-fuzz"), *arguments], cwd=tmp_path, capture_output=True, text=True)

    return run


@pytest.fixture
def estimate(cover: Program) -> Callable[..., Any]:
    """Measures tests by `paracosm-cover estimate`."""

    def run(*arguments: str) -> Any:
        return json.loads(cover("estimate", *arguments, "--format", "json"))

    return run
