"""Compares searches on requirements of a benchmark: after how many tests does each find the first failure?

Usage: python compare.py PROGRAM OUT.csv [--seeds N] [--budget N] [--search NAME]... [--requirement NAME]... [--jobs N]

PROGRAM is `target/release/paracosm-experiments`. A run without a failure has an empty entry. Runs that OUT.csv has already, with the same budget, are not
made again: remove the file if a system or a requirement has changed. Slow searches run only if they are named.
"""

import argparse
import csv
import os
import time
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(threads, "1")

from problems import Ended, Requirement, Run, System, requirements
from searchers import SEARCHES, SLOW

COLUMNS = ["requirement", "search", "seed", "budget", "tests"]


def made(program: Path, requirement: Requirement, search: str, seed: int, budget: int) -> tuple[str, str, int, int | None, float]:
    """The number of tests to the first failure of one run, or `None`; and the seconds that the run took."""
    begun = time.monotonic()
    system = System(program, requirement)
    run = Run(system, budget)
    try:
        SEARCHES[search](requirement, run, seed)
    except Ended:
        pass
    finally:
        system.close()
    return requirement.name, search, seed, run.tests if run.found else None, time.monotonic() - begun


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("program", type=Path)
    arguments.add_argument("out", type=Path)
    arguments.add_argument("--seeds", type=int, default=30)
    arguments.add_argument("--budget", type=int, default=300)
    arguments.add_argument("--search", action="append", choices=list(SEARCHES))
    arguments.add_argument("--requirement", action="append", choices=[one.name for one in requirements()])
    arguments.add_argument("--jobs", type=int, default=os.cpu_count())
    given = arguments.parse_args()
    known = set()
    if given.out.exists():
        known = {(row["requirement"], row["search"], int(row["seed"])) for row in rows(given.out) if row["budget"] == str(given.budget)}
    else:
        given.out.write_text(",".join(COLUMNS) + "\n")
    chosen = [one for one in requirements() if not given.requirement or one.name in given.requirement]
    runs = [
        (one, search, seed)
        for search in given.search or [name for name in SEARCHES if name not in SLOW]
        for one in chosen
        for seed in range(given.seeds)
        if (one.name, search, seed) not in known
    ]
    spent: dict[str, float] = {}
    with ProcessPoolExecutor(given.jobs) as pool, given.out.open("a") as out:
        futures = [pool.submit(made, given.program, *run, given.budget) for run in runs]
        for count, future in enumerate(as_completed(futures), 1):
            name, search, seed, tests, seconds = future.result()
            out.write(f"{name},{search},{seed},{given.budget},{'' if tests is None else tests}\n")
            out.flush()
            spent[search] = spent.get(search, 0.0) + seconds
            if count % 100 == 0 or count == len(runs):
                print(f"{count} of {len(runs)} runs; seconds by search: {({key: round(value, 1) for key, value in spent.items()})}", flush=True)
    sort(given.out)


def rows(path: Path) -> list[dict[str, str]]:
    """The runs of a file, without a last line that a crash has cut short."""
    lines = path.read_text().splitlines(keepends=True)
    whole = lines if not lines or lines[-1].endswith("\n") else lines[:-1]
    if len(whole) < len(lines):
        path.write_text("".join(whole))
    return list(csv.DictReader(whole))


def sort(path: Path) -> None:
    """Puts the runs into the order of requirements, searches and seeds."""
    order = {one.name: place for place, one in enumerate(requirements())}
    names = list(SEARCHES)
    runs = sorted(rows(path), key=lambda row: (order[row["requirement"]], names.index(row["search"]), int(row["seed"])))
    lines = [",".join(COLUMNS)] + [",".join(row[column] for column in COLUMNS) for row in runs]
    path.with_suffix(".new").write_text("\n".join(lines) + "\n")
    path.with_suffix(".new").replace(path)


if __name__ == "__main__":
    main()
