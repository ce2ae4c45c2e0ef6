"""Parcels: studies that travel to other processes and other machines, with the files that they name.

A parcel has the hashes of the study and of the files. A process that lacks one of them says so, and gets it once. It keeps files in a folder of its cache, which stays there. The files have the same relative
paths there as on the machine of the sender, so that the names of the study lead to them.
"""

import hashlib
import io
import os
import pickle
import platform
import shlex
import site
import sys
import sysconfig
import tempfile
import threading
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from importlib import import_module
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType
from typing import Any

from . import _core
from ._core import Error, Program, Study
from .driver import Driver

__all__ = ["Packed", "Parcel", "packed", "placed", "unpacked"]


@dataclass(frozen=True)
class File:
    """A file that a study names."""

    path: str
    hash: str
    can_run: bool
    """Whether the file may be run."""


@dataclass(frozen=True)
class Parcel:
    """What travels with each part of a campaign. The pickle of the study and the files travel only to processes that lack them."""

    version: str
    """The version of the package that packed it."""
    study: str
    """The hash of the pickle of the study."""
    root: str
    """The folder of the sender that has all the files."""
    folder: str
    """The present folder of the sender, from the root."""
    files: tuple[File, ...]
    """The files, by their paths from the root."""
    absolute: tuple[File, ...]
    """The files that the study names by their whole paths."""
    key: str
    """The hash of all of this."""


@dataclass(frozen=True)
class Packed:
    """A parcel with the pickle of its study."""

    parcel: Parcel
    pickled: bytes

    def contents(self, wanted: list[str]) -> dict[str, bytes]:
        """Returns the pickle and the contents of files, by their hashes."""
        found = {self.parcel.study: self.pickled} if self.parcel.study in wanted else {}
        for file in self.parcel.files:
            if file.hash in wanted:
                found[file.hash] = _read(Path(self.parcel.root) / file.path)
                if _hash_of(found[file.hash]) != file.hash:
                    raise Error(f"the file {file.path} has changed since the campaign began")
        return found


def packed(study: Study, pickler: str | None = None) -> Packed:
    """Packs a study. `pickler` is the module that pickles functions by value; without it, cloudpickle does if it is there, and else they are pickled by name.

    Raises `Error` if a part of the study cannot be pickled.
    """
    if pickler is None:
        pickler = "cloudpickle" if find_spec("cloudpickle") else None
    bare = _core.without_sampling(study)
    here = Path.cwd().resolve()
    named = [Path(file) for file in _named(bare)]
    relative = {file: Path(os.path.normpath(here / file)) for file in named if not file.is_absolute()}
    for file, plain in relative.items():
        if os.path.realpath(here / file) != os.path.realpath(plain):
            raise Error(f"the file {file} cannot travel, because its path leads out of a link: name the file without `..`")
    root = Path(os.path.commonpath([here, *(file.parent for file in relative.values())]))
    files = {file.relative_to(root).as_posix(): file for file in relative.values()}
    absolute = {os.fspath(file): file for file in named if file.is_absolute()}
    pickled = _pickled(bare, pickler)
    folder = here.relative_to(root).as_posix()
    parcel = Parcel(_version(), _hash_of(pickled), os.fspath(root), folder, _described(files), _described(absolute), key="")
    return Packed(replace(parcel, key=_hash_of(repr(parcel).encode())), pickled)


def _described(files: Mapping[str, Path]) -> tuple[File, ...]:
    return tuple(File(path, _hash(file), os.access(file, os.X_OK)) for path, file in sorted(files.items()))


def placed(parcel: Parcel, given: Mapping[str, bytes]) -> tuple[Path, list[str]]:
    """Returns the folder in which the study's names lead to its files, and the hashes of the files that this machine lacks. `given` has contents of files."""
    machine = platform.node()
    if parcel.version != _version():
        raise Error(f"{machine} has paracosm {_version()}, and the campaign has paracosm {parcel.version}: install the same version on all machines")
    for file in parcel.absolute:
        there = Path(file.path).is_file()
        if not there or _hash(Path(file.path)) != file.hash:
            found = f"{machine} has another file {file.path}" if there else f"{machine} has no file {file.path}"
            raise Error(f"{found}: give its path from the present folder, so that the file travels")
    root = Path(parcel.root)
    missing = _lacking(root, parcel)
    if missing:
        root = _cache() / parcel.key
        for file in parcel.files:
            if file.hash in given:
                _put(root / file.path, given[file.hash], file.can_run)
        missing = _lacking(root, parcel)
        if not missing:
            # The names of files above the present folder begin with `..`.
            (root / parcel.folder).mkdir(parents=True, exist_ok=True)
    folder = root / parcel.folder
    # A study that names no file runs in any folder.
    return folder if parcel.files or folder.is_dir() else Path.cwd(), missing


def unpacked(pickled: bytes) -> Study:
    """Returns the study of a pickle. The present folder has to be the folder that `placed` returns."""
    try:
        study, why = pickle.loads(pickled)
    except ModuleNotFoundError as missing:
        raise Error(f"{platform.node()} has no module {missing.name}, which the study needs: install it there") from None
    try:
        made = pickle.loads(study)
    except ModuleNotFoundError as missing:
        also = f", or mend why it cannot travel: {why}" if why else ""
        raise Error(f"{platform.node()} has no module {missing.name}, which the study needs: install it there{also}") from None
    assert isinstance(made, Study)
    return made


def _version() -> str:
    return version("paracosm")


def _named(study: Study) -> Iterator[str | os.PathLike[str]]:
    """Yields the paths of the files that a study names."""
    yield from _core.scenario_files(study)
    choices = study.choices
    driver = choices.get("driver")
    program, *arguments = shlex.split(choices.get("driver_command") or "") or [""]
    # Each machine has its own programs, such as Python.
    own = [] if os.path.isabs(program) else [program]
    models = (choices.get("models") or {}).values()
    texts: list[Any] = [choices.get("requirements"), driver, study.scenario, study.scenario.rpartition(":")[0], *models, *own, *arguments]
    # A name of the catalogue or a word of a command need not be a file.
    yield from (text for text in texts if isinstance(text, (str, os.PathLike)) and os.path.isfile(text))
    if isinstance(driver, Driver):
        files = [driver.files] if isinstance(driver.files, (str, os.PathLike)) else driver.files
        for file in files:
            if not isinstance(file, (str, os.PathLike)) or not os.path.isfile(file):
                raise Error(f"files of the driver: found {file!r}, expected the path of a file")
            yield file


def _pickled(study: Study, pickler: str | None) -> bytes:
    """Pickles the pickle of a study, and why a part of it travels by name only."""
    if pickler is None:
        try:
            return pickle.dumps((pickle.dumps(study), ""))
        except Exception as error:
            raise _cannot_travel(error) from None
    first: Exception | None = None
    # A module of the user, or the scenario itself, may hold things that cannot be pickled. The other machines may have the module.
    for modules, programs in [(True, True), (False, True), (False, False)]:
        try:
            pickled = _by_value(study, import_module(pickler), modules, programs)
        except Exception as error:
            first = first or error
        else:
            return pickle.dumps((pickled, f"{type(first).__name__}: {first}" if first else ""))
    assert first is not None
    raise _cannot_travel(first)


def _cannot_travel(error: Exception) -> Error:
    return Error(f"the study cannot be sent to other processes: {type(error).__name__}: {error}")


def _by_value(study: Study, cloudpickle: Any, modules: bool, programs: bool) -> bytes:
    """Pickles a study with the functions and classes that it needs: with the code of modules that are not installed, and of scenarios, or with their names."""

    class Pickler(cloudpickle.CloudPickler):  # type: ignore[misc]
        def reducer_override(self, obj: Any) -> Any:
            if isinstance(obj, Program) and (programs or obj.function.__module__ == "__main__"):
                return Program, (obj.function, obj.name, obj.about, obj.hash)
            return super().reducer_override(obj)

    with _packing:
        known = cloudpickle.list_registry_pickle_by_value()
        own = [module for module in list(sys.modules.values()) if _is_own(module) and module.__name__ not in known] if modules else []
        for module in own:
            cloudpickle.register_pickle_by_value(module)
        try:
            pickled = io.BytesIO()
            Pickler(pickled).dump(study)
            return pickled.getvalue()
        finally:
            for module in own:
                cloudpickle.unregister_pickle_by_value(module)


# The list of the modules that travel by value belongs to the whole process.
_packing = threading.Lock()


def _is_own(module: ModuleType) -> bool:
    """Returns whether a module is a file of the user, which other machines need not have."""
    # Some modules look their attributes up when they are asked for.
    file = vars(module).get("__file__")
    if not isinstance(file, str) or module.__name__ == "__main__" or module.__name__.partition(".")[0] == "paracosm":
        return False
    return not any(Path(file).is_relative_to(folder) for folder in _INSTALLED)


_INSTALLED = [*(sysconfig.get_path(name) for name in ("stdlib", "platstdlib", "purelib", "platlib")), *site.getsitepackages(), site.getusersitepackages()]


def _read(file: Path) -> bytes:
    try:
        return file.read_bytes()
    except OSError as error:
        raise Error(f"cannot read {file}: {error.strerror}") from None


def _hash_of(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def _hash(file: Path) -> str:
    return _hash_of(_read(file))


def _lacking(root: Path, parcel: Parcel) -> list[str]:
    return [file.hash for file in parcel.files if not (root / file.path).is_file() or _hash(root / file.path) != file.hash]


def _cache() -> Path:
    cache = os.environ.get("XDG_CACHE_HOME")
    return (Path(cache) if cache else Path.home() / ".cache") / "paracosm" / "parcels"


def _put(file: Path, data: bytes, can_run: bool) -> None:
    """Writes a file completely or not at all: other processes may write the same file."""
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=file.parent, delete=False) as written:
            written.write(data)
        os.chmod(written.name, 0o700 if can_run else 0o600)
        os.replace(written.name, file)
    except OSError as error:
        with suppress(OSError, UnboundLocalError):
            os.remove(written.name)
        raise Error(f"cannot write {file} on {platform.node()}: {error.strerror}; the variable XDG_CACHE_HOME names another folder for such files") from None
