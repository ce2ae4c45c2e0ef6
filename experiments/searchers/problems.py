"""The requirements of the benchmark, each as a function from a point of the unit cube to a robustness.

A requirement's system runs in a process of its own, which answers each test with a line of JSON.
"""

import json
import subprocess
import tomllib
from dataclasses import dataclass
from pathlib import Path

SYSTEMS = Path(__file__).parents[1] / "systems"


class Ended(Exception):
    """A search has found a failure, or has no tests left."""


@dataclass(frozen=True)
class Requirement:
    """A requirement of the benchmark."""

    name: str
    system: str
    space: str
    formula: str

    @property
    def space_file(self) -> Path:
        """The file with the inputs of the tests."""
        return SYSTEMS / self.space

    def inputs(self) -> list[tuple[str, float, float, int]]:
        """The name, the ends and the number of pieces of each input."""
        parameters = tomllib.loads(self.space_file.read_text())["parameter"]
        return [(p["name"], *p["interval"], p.get("signal", {}).get("pieces", 1)) for p in parameters]

    def dims(self) -> int:
        """The number of coordinates of a test."""
        return sum(pieces for _, _, _, pieces in self.inputs())


def requirements() -> list[Requirement]:
    """All requirements, in the order of the file."""
    return [Requirement(**entry) for entry in tomllib.loads((SYSTEMS / "requirements.toml").read_text())["requirement"]]


class System:
    """A running system that answers with the robustness of a requirement."""

    def __init__(self, program: Path, requirement: Requirement) -> None:
        self.inputs = requirement.inputs()
        command = [program, "system", requirement.system, "--spec", requirement.formula]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def robustness(self, point: list[float]) -> float:
        """The robustness at a point of the unit cube."""
        test, at = {}, 0
        for name, low, high, pieces in self.inputs:
            test[name] = [low + (high - low) * x for x in point[at : at + pieces]]
            at += pieces
        self.process.stdin.write(json.dumps({"index": 0, "test": test}) + "\n")
        self.process.stdin.flush()
        answer = json.loads(self.process.stdout.readline())
        if "error" in answer:
            raise RuntimeError(answer["error"])
        return answer["robustness"]["spec"]

    def close(self) -> None:
        self.process.stdin.close()
        self.process.wait()


class Run:
    """The tests of a search: counts them, and ends the search."""

    def __init__(self, system: System, budget: int) -> None:
        self.system = system
        self.budget = budget
        self.tests = 0
        self.found = False

    def __call__(self, point) -> float:
        """The robustness at a point of the unit cube. Raises `Ended` after a failure, and when there are no tests left."""
        if self.tests == self.budget:
            raise Ended
        self.tests += 1
        robustness = self.system.robustness([min(max(float(x), 0.0), 1.0) for x in point])
        if robustness < 0.0:
            self.found = True
            raise Ended
        return robustness
