#!/usr/bin/env python3
"""Writes BENCHMARKS.md: measures the working tree and an earlier commit in one run, and fills benches/page.md.

    benches/page.py --before COMMIT [--rounds N]

It takes more than half an hour on two cores, and the machine should do nothing else. Needs git, cargo, Linux, and Python 3.9.
Only committed states are measured, so that the page can name them.
"""

import argparse
import json
import os
import platform
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# Scenarios, with numbers of tests. The first row is the main job; the last row shows how campaigns scale.
CAMPAIGNS = [
    ("pedestrian-crossing", 10_000),
    ("follow-leader", 2_000),
    ("cut-in", 2_500),
    ("cut-out", 1_500),
    ("ncap-cpna", 2_000),
    ("grid-traffic", 30),
    ("t-loop", 50),
    ("pedestrian-crossing", 100_000),
]
SIZES = [10, 100, 1_000, 10_000, 100_000, 1_000_000]
BENCHES = ["speed", "coverage", "camera"]
# A work takes samples in a turn until this time in seconds has passed, and at least one sample.
MOST_SECONDS = 0.5
EXAMPLES = ["covering", "greedy", "adaptive"]
UNITS = {"ns": 1e-9, "µs": 1e-6, "ms": 1e-3, "s": 1.0}


def run(command, cwd=ROOT, **options):
    """Runs a command, and returns what it prints."""
    print("+", *command, file=sys.stderr)
    return subprocess.run(command, cwd=cwd, check=True, text=True, stdout=subprocess.PIPE, **options).stdout


class Tree:
    """A commit of the repository, with its programs."""

    def __init__(self, path, target):
        self.path, self.target = Path(path), Path(target)
        self.commit = run(["git", "rev-parse", "--short", "HEAD"], self.path).strip()
        self.cargo("build", "--release", "--locked", "--bins")

    def cargo(self, *arguments):
        return run(["cargo", *arguments], self.path, env={**os.environ, "CARGO_TARGET_DIR": str(self.target)})

    def has_bench(self, name):
        packages = json.loads(self.cargo("metadata", "--no-deps", "--format-version", "1", "--locked"))["packages"]
        root = next(package for package in packages if Path(package["manifest_path"]).parent == self.path.resolve())
        return any(target["name"] == name and "bench" in target["kind"] for target in root["targets"])

    def program(self, name):
        return str(self.target / "release" / name)


def cpu_seconds(pid):
    """The CPU time of a process so far."""
    fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def campaign(tree, scenario, tests):
    """Runs a campaign; returns the CPU seconds of its tests, the CPU seconds after them, and its memory in MB."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out"
        command = [tree.program("paracosm-fuzz"), scenario, "--strategy", "halton", "--budget", str(tests)]
        command += ["--jobs", "1", "--out", str(out), "-q"]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        log, lines, until_last, ended = out / "trials.jsonl", 0, None, 0
        read = 0
        while not ended:
            used = cpu_seconds(process.pid)
            if until_last is None and log.exists():
                with open(log, "rb") as file:
                    file.seek(read)
                    new = file.read()
                read, lines = read + len(new), lines + new.count(b"\n")
                until_last = used if lines >= tests else None
            ended, status, usage = os.wait4(process.pid, os.WNOHANG)
            time.sleep(0.01)
        if status != 0:
            sys.exit(f"a campaign ended with an error: {' '.join(command)}")
        if log.read_bytes().count(b"\n") != tests:
            sys.exit(f"a campaign did not run all its tests: {' '.join(command)}")
    total = usage.ru_utime + usage.ru_stime
    until_last = total if until_last is None else until_last
    return until_last, total - until_last, usage.ru_maxrss / 1024


def campaigns(trees, rounds):
    rows = []
    for scenario, tests in CAMPAIGNS:
        turns = [[campaign(tree, scenario, tests) for tree in trees] for _ in range(1 if tests > 50_000 else rounds)]
        (old_test, old_after, old_memory), (test, after, memory) = (
            [statistics.median(turn[i][figure] for turn in turns) for figure in range(3)] for i in range(2)
        )
        rows.append([f"`{scenario}`, {tests:,} tests", shown(old_test / tests), shown(test / tests), f"{tests / test:,.0f}",
                     f"{old_test / test:.2f}", shown(old_after), shown(after), f"{old_memory:.0f} MB", f"{memory:.0f} MB"])
    return table(["campaign", "test, before", "test, now", "tests per core-second", "ratio", "after, before", "after, now",
                  "memory, before", "memory, now"], rows)


def exact_up_to(tree, measure, dims):
    """The largest number of points for which the measure is exact within a second; a dash without such a measure."""
    largest = 0
    for points in SIZES:
        command = [tree.program("paracosm-cover"), "estimate", "--strategy", "halton", "--dims", str(dims)]
        command += ["--budget", str(points), "--measures", measure.replace("-", "_"), "--time-limit", "1", "--format", "json", "-q"]
        # Both commits read names with underscores; earlier commits read no others.
        begun = time.monotonic()
        estimate = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        if estimate.returncode != 0 and "no measure is called" in estimate.stderr:
            return "–"
        if estimate.returncode != 0:
            sys.exit(f"{' '.join(command)}: {estimate.stderr}")
        report = json.loads(estimate.stdout)["continuous"]
        # Beside the names of the parameters, the report has the measure alone: a number, or bounds.
        found = next((value for name, value in report.items() if name != "parameters"), None)
        if isinstance(found, dict):
            found = found["lower"] if found["lower"] == found["upper"] else None
        if found is None or time.monotonic() - begun > 1.0:
            break
        largest = points
    return f"{largest:,}"


def cliffs(trees):
    listed = json.loads(subprocess.run([trees[1].program("paracosm-fuzz"), "list", "measures", "--format", "json"],
                                       check=True, stdout=subprocess.PIPE).stdout)["measures"]
    rows = []
    # Measures of k parameters need a space with discrete parameters.
    for measure in (entry["name"] for entry in listed if not entry["name"].startswith("k-wise")):
        for dims in (1, 2, 3):
            rows.append([f"`{measure}`, d = {dims}", *(exact_up_to(tree, measure, dims) for tree in trees)])
    return table(["measure", "before", "now"], rows)


def divan(text):
    """The medians of a benchmark's output in seconds, for one item if the benchmark counts items."""
    medians, path, last = {}, [], None
    for line in text.splitlines():
        branch = re.match(r"^([│ ]*)[├╰]─ (.*)$", line)
        if branch:
            name = re.split(r"\s{2,}", branch[2])[0]
            path = [*path[: len(branch[1]) // 3], name]
            last = " ".join(path)
        times = re.findall(r"[\d.]+ (?:ns|µs|ms|s)\b", line)
        rates = re.findall(r"[\d.]+ [KMG]?item/s", line)
        if branch and len(times) >= 3:
            medians[last] = seconds(times[2])
        elif last in medians and len(rates) >= 3:
            del medians[last]
            medians[f"{last}, one item"] = 1 / rate(rates[2])
    return medians


def seconds(text):
    number, unit = text.split()
    return float(number) * UNITS[unit]


def rate(text):
    number, unit = text.split()
    return float(number) * {"item/s": 1.0, "Kitem/s": 1e3, "Mitem/s": 1e6, "Gitem/s": 1e9}[unit]


def shown(time):
    rounded = float(f"{time:.3g}")
    unit, size = next((u, s) for u, s in [("s", 1.0), ("ms", 1e-3), ("µs", 1e-6), ("ns", 1e-9)] if rounded >= s or u == "ns")
    number = float(f"{time / size:.3g}")
    return f"{number:,.0f} {unit}" if number >= 100 else f"{number:g} {unit}"


def benches(trees, rounds):
    rows = []
    for bench in BENCHES:
        with_bench = [tree.has_bench(bench) for tree in trees]
        turns = [[{}, {}] for _ in range(rounds)]
        # Nothing is compiled between two measurements.
        for tree in (tree for tree, has in zip(trees, with_bench) if has):
            tree.cargo("bench", "--locked", "--bench", bench, "--no-run")
        for turn, measured in enumerate(turns):
            # Each commit is the first one in half of the turns.
            for i in (0, 1) if turn % 2 == 0 else (1, 0):
                if with_bench[i]:
                    arguments = ["bench", "--locked", "--bench", bench, "--", "--max-time", str(MOST_SECONDS)]
                    measured[i] = divan(trees[i].cargo(*arguments))
        for name in turns[0][1]:
            if not all(name in turn[1] for turn in turns):
                sys.exit(f"the work `{name}` of the benchmark `{bench}` is missing in a turn")
            now = statistics.median(turn[1][name] for turn in turns)
            if not all(name in turn[0] for turn in turns):
                rows.append([f"`{bench}`: {name}", "", shown(now), "", ""])
                continue
            before = statistics.median(turn[0][name] for turn in turns)
            ratios = [turn[0][name] / turn[1][name] for turn in turns]
            rows.append([f"`{bench}`: {name}", shown(before), shown(now), f"{before / now:.2f}",
                         f"{min(ratios):.2f} to {max(ratios):.2f}"])
    return table(["work", "before", "now", "ratio", "ratios of the turns"], rows)


def example(tree, name):
    printed = tree.cargo("run", "--release", "--locked", "-q", "-p", "paracosm-generators", "--example", name).strip()
    return printed if printed.startswith("|") else f"```text\n{printed}\n```"


def table(heads, rows):
    lines = ["| " + " | ".join(cells) + " |" for cells in [heads, ["---"] * len(heads), *rows]]
    return "\n".join(lines)


def machine():
    info = Path("/proc/cpuinfo").read_text()
    model = re.search(r"model name\s*:\s*(.*)", info)
    memory = int(re.search(r"MemTotal:\s*(\d+)", Path("/proc/meminfo").read_text())[1]) / 2**20
    rust = run(["rustc", "--version"]).split()[1]
    return (f"The machine has {os.cpu_count()} cores ({model[1] if model else platform.machine()}), {memory:.0f} GiB of memory, "
            f"{platform.system()}, and Rust {rust}. The page was measured on {time.strftime('%Y-%m-%d', time.gmtime())}.")


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--before", required=True, metavar="COMMIT", help="the commit to compare with, such as the last release")
    arguments.add_argument("--rounds", type=int, default=3, help="the number of turns of each campaign and of each work of `cargo bench`")
    arguments = arguments.parse_args()
    if run(["git", "status", "--porcelain", "--untracked-files=no"]).strip():
        sys.exit("there are changes that are not committed: commit them first, so that the page can name the commit that it measured")
    scratch = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "page"
    earlier = scratch / "earlier"
    shutil.rmtree(earlier, ignore_errors=True)
    run(["git", "worktree", "prune"])
    run(["git", "worktree", "add", "--detach", "-f", str(earlier), arguments.before])
    try:
        trees = [Tree(earlier, scratch / "before"), Tree(ROOT, scratch / "now")]
        parts = {
            "machine": machine(),
            "before": f"`{trees[0].commit}`",
            "now": f"`{trees[1].commit}`",
            "rounds": str(arguments.rounds),
        }
        measured = {
            "campaigns": lambda: campaigns(trees, arguments.rounds),
            "cliffs": lambda: cliffs(trees),
            "benches": lambda: benches(trees, arguments.rounds),
            **{name: lambda name=name: example(trees[1], name) for name in EXAMPLES},
        }
        for part, measure in measured.items():
            # A later part may fail. The file keeps the finished parts, so that one can look for the reason.
            parts[part] = measure()
            (scratch / "parts.json").write_text(json.dumps(parts, indent=1))
    finally:
        run(["git", "worktree", "remove", "--force", str(earlier)])
    page = re.sub(r"\{\{(\w+)\}\}", lambda found: parts[found[1]], (ROOT / "benches/page.md").read_text())
    (ROOT / "BENCHMARKS.md").write_text(page)


if __name__ == "__main__":
    main()
