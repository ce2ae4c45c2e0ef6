"""`scenario`: makes a scenario of a function."""

import difflib
import hashlib
import inspect
import os
import sys
from collections.abc import Callable
from importlib import import_module
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from typing import overload

from ._core import Error, Program, Scenario

_Build = Callable[[Scenario], None]


@overload
def scenario(function: _Build, /) -> Program: ...


@overload
def scenario(*, name: str | None = None, about: str | None = None) -> Callable[[_Build], Program]: ...


def scenario(
    function: _Build | None = None, /, *, name: str | None = None, about: str | None = None
) -> Program | Callable[[_Build], Program]:
    """Makes a scenario of a function that builds a world: write `@scenario` above it.

    The function gets a `Scenario`, and is called once for each test. It depends on the test alone, and returns nothing. `name` and `about` are the
    name and the description; without them, the scenario has the name of the function, with hyphens for underscores, and the first line of its documentation. In a file, the name begins
    with the path of the file, so that a folder of a campaign says where its scenario stands.
    """
    if function is None:
        return lambda function: _made(function, name, about)
    return _made(function, name, about)


def _made(function: _Build, name: str | None, about: str | None) -> Program:
    if not callable(function):
        raise Error(f"found {function!r}, expected a function that gets a scenario")
    own = name or getattr(function, "__name__", "scenario").replace("_", "-")
    if about is None:
        about = (inspect.getdoc(function) or "").partition("\n")[0].rstrip(".") or "a scenario of Python"
    file = _file(function)
    if file is None:
        return Program(function, own, about)
    return Program(function, f"{_shown(file)}:{own}", about, _hash(file))


def _file(function: _Build) -> Path | None:
    """Returns the file of a function; `None` in a notebook or in an interpreter."""
    code = getattr(inspect.unwrap(function), "__code__", None)
    file = Path(getattr(code, "co_filename", ""))
    return file.resolve() if file.suffix == ".py" and file.is_file() else None


def _shown(file: Path) -> str:
    """Returns the path of a file from the present folder, or the whole path of a file elsewhere."""
    folder = Path.cwd().resolve()
    return str(file.relative_to(folder)) if file.is_relative_to(folder) else os.fspath(file)


def _hash(file: Path) -> str:
    return hashlib.blake2b(file.read_bytes(), digest_size=16).hexdigest()


def _found(module: str, name: str) -> Program:
    """Returns the scenario of a pickle."""
    found: object = sys.modules[module] if module in sys.modules else import_module(module)
    for part in name.split("."):
        found = getattr(found, part, None)
    if not isinstance(found, Program):
        raise Error(f"the module {module} has no scenario `{name}`: define it at the level of the module")
    return found


# The files that were run to find their scenarios, with their hashes at that time.
_READ: dict[tuple[Path, str], dict[str, Program]] = {}


def _read(path: str, part: str | None) -> Program:
    """Returns the scenario of a file, for the programs: runs the file unless it was run before."""
    file = Path(path).resolve()
    if not file.is_file():
        raise Error(f"found no file {path}")
    key = (file, _hash(file))
    if key not in _READ:
        _READ[key] = _programs_of(file)
    programs = _READ[key]
    if not programs:
        raise Error(f"{path} has no scenario: write `@paracosm.scenario` above a function of the file")
    if part is None and len(programs) == 1:
        return next(iter(programs.values()))
    names = ", ".join(programs)
    if part is None:
        raise Error(f"{path} has {len(programs)} scenarios: {names}; write {path}:{next(iter(programs))}")
    wanted = part.replace("_", "-")
    if wanted not in programs:
        near = difflib.get_close_matches(wanted, programs, n=1)
        meant = f" (did you mean `{near[0]}`?)" if near else ""
        raise Error(f"{path} has no scenario `{part}`{meant}; the file has {names}")
    return programs[wanted]


def _programs_of(file: Path) -> dict[str, Program]:
    """Runs a file as a module, and returns the scenarios that it defines."""
    name = f"paracosm_scenarios_{_hash(file)}"
    spec = spec_from_file_location(name, file)
    if spec is None or spec.loader is None:
        raise Error(f"Python cannot load {file}")
    module = module_from_spec(spec)
    # As in a script, the file can import its neighbours.
    folder = os.fspath(file.parent)
    if folder not in sys.path:
        sys.path.insert(0, folder)
    sys.modules[name] = module
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[name]
        raise
    programs = [found for found in vars(module).values() if isinstance(found, Program) and _file(found.function) == file]
    return {program.name.rpartition(":")[2]: program for program in programs}
