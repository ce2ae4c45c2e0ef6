"""Runs parts of a campaign in a process that an executor has started."""

import os
import threading
import time
from collections import OrderedDict
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from ._core import Station
from ._parcels import Parcel, placed, unpacked

__all__ = ["Ran", "run_part"]

# A process rarely serves more than one campaign at a time.
_MOST_STATIONS = 4


@dataclass(frozen=True)
class Ran:
    """The result of a part of a campaign."""

    missing: list[str] = field(default_factory=list)
    """The hashes of what the process lacks. If it lacks anything, no test ran."""
    lines: list[str] = field(default_factory=list)
    """The trials, as lines of the log."""
    recovered: str = ""
    """The errors that did not repeat, as JSON."""
    seconds: float = 0.0
    """How long the tests took."""


def run_part(parcel: Parcel, first: int, tests: list[str], given: Mapping[str, bytes]) -> Ran:
    """Runs tests of a study, of which the first has the index `first`."""
    folder, missing = _folder(parcel, given)
    with _lock:
        station = _stations.get(parcel.key)
    if station is None and parcel.study not in given:
        missing = [*missing, parcel.study]
    if missing:
        return Ran(missing)
    with _standing.within(folder):
        station = station or _station(parcel, given)
        begun = time.perf_counter()
        lines, recovered = station.run(first, tests)
        return Ran([], lines, recovered, time.perf_counter() - begun)


_lock = threading.Lock()
_folders: dict[str, Path] = {}
_stations: OrderedDict[str, Station] = OrderedDict()


def _folder(parcel: Parcel, given: Mapping[str, bytes]) -> tuple[Path, list[str]]:
    """Returns the folder for the tests. The folder of the cache may have been removed meanwhile."""
    with _lock:
        known = _folders.get(parcel.key)
        if known is not None and known.is_dir() and all((known / os.path.relpath(file.path, parcel.folder)).is_file() for file in parcel.files):
            return known, []
        folder, missing = placed(parcel, given)
        if not missing:
            _folders[parcel.key] = folder
        return folder, missing


def _station(parcel: Parcel, given: Mapping[str, bytes]) -> Station:
    """Returns the station of a parcel, which keeps its drivers from one part to the next."""
    with _lock:
        if parcel.key not in _stations:
            _stations[parcel.key] = Station(unpacked(given[parcel.study]))
        _stations.move_to_end(parcel.key)
        while len(_stations) > _MOST_STATIONS:
            _stations.popitem(last=False)
        return _stations[parcel.key]


class _Standing:
    """The present folder of the process. Parts in the same folder run at the same time, and others wait."""

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._folder: Path | None = None
        self._parts = 0

    @contextmanager
    def within(self, folder: Path) -> Iterator[None]:
        with self._changed:
            self._changed.wait_for(lambda: self._parts == 0 or self._folder == folder)
            if self._parts == 0:
                self._before = Path.cwd()
                if self._before != folder:
                    os.chdir(folder)
            self._folder = folder
            self._parts += 1
        try:
            yield
        finally:
            with self._changed:
                self._parts -= 1
                if self._parts == 0:
                    if self._before != folder:
                        os.chdir(self._before)
                    self._changed.notify_all()


_standing = _Standing()
