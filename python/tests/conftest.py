"""The installed package is tested, with its compiled module and its programs."""

import json
import shutil
import signal
import subprocess
import sys
import textwrap
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


@pytest.fixture
def interrupted(tmp_path: Path) -> Callable[[str, str], str]:
    """Runs a script until it prints a line, sends Ctrl-C, and returns what the script wrote to standard error within half a minute."""

    def run(script: str, line: str) -> str:
        (tmp_path / "script.py").write_text(textwrap.dedent(script))
        command = [sys.executable, "script.py"]
        running = subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        # Two threads may write the line at once, so the first line may have it twice.
        assert running.stdout is not None and running.stdout.readline().startswith(line)
        running.send_signal(signal.SIGINT)
        try:
            return running.communicate(timeout=30)[1]
        finally:
            running.kill()

    return run
