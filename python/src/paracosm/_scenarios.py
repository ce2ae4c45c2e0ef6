"""`scenario`: makes a scenario of a function."""

import difflib
import functools
import hashlib
import inspect
import os
import sys
from collections.abc import Callable
from importlib import import_module
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import FrameType
from typing import Any, overload

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

    The function gets a `Scenario`, and is called at least once for each test, and also when a study is made. It depends on the test alone, and returns nothing. `name` and `about` are the
    name and the description; without them, the scenario has the name of the function, with hyphens for underscores, and the first line of its documentation. In a file, the name begins
    with the path of the file, so that a folder of a campaign says where its scenario stands.
    """
    place = _module_file(sys._getframe(1))
    if function is None:
        return lambda function: _made(function, name, about, place)
    return _made(function, name, about, place)


def _made(function: _Build, name: str | None, about: str | None, place: Path | None) -> Program:
    if not callable(function):
        raise Error(f"found {function!r}, expected a function that gets a scenario")
    described = _described(function)
    if name is not None and (":" in name or not name.isprintable()):
        raise Error(f"the name of the scenario is {name!r}, expected printable text without `:`, which stands between a file and a scenario")
    own = name or described.__name__.replace("_", "-")
    if about is None:
        about = (inspect.getdoc(described) or "").partition("\n")[0].rstrip(".") or "a scenario of Python"
    file = place or _file(described)
    if file is None:
        return Program(function, own, about)
    return Program(function, f"{_shown(file)}:{own}", about, _hash(file))


def _described(function: Any) -> Any:
    """Returns what has the name and the documentation of a function: the function in a partial one, or the class of an object that can be called."""
    while isinstance(function, functools.partial):
        function = function.func
    return function if hasattr(function, "__name__") else type(function)


def _file(described: Any) -> Path | None:
    """Returns the file of a function or of a class; `None` in a notebook or in an interpreter."""
    call = described.__call__ if inspect.isclass(described) else described
    return _python_file(getattr(getattr(inspect.unwrap(call), "__code__", None), "co_filename", ""))


def _module_file(frame: FrameType) -> Path | None:
    """Returns the file that a frame runs as a module or as a script: a decorator of another file may have made the function. Otherwise `None`."""
    return _python_file(frame.f_code.co_filename) if frame.f_code.co_name == "<module>" else None


def _python_file(name: str) -> Path | None:
    file = Path(name)
    return file.resolve() if file.suffix == ".py" and file.is_file() else None


def _shown(file: Path) -> str:
    """Returns the path of a file from the present folder, or the whole path of a file elsewhere."""
    folder = Path.cwd().resolve()
    return str(file.relative_to(folder)) if file.is_relative_to(folder) else os.fspath(file)


def _hash(file: str | os.PathLike[str]) -> str:
    return hashlib.blake2b(Path(file).read_bytes(), digest_size=16).hexdigest()


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
    own = [found for found in vars(module).values() if isinstance(found, Program) and found.name.rpartition(":")[0] == _shown(file)]
    programs: dict[str, Program] = {}
    for program in own:
        name = program.name.rpartition(":")[2]
        if programs.setdefault(name, program) is not program:
            raise Error(f"{_shown(file)} has two scenarios called `{name}`: give each its own name, `@scenario(name=\"..\")`")
    return programs
