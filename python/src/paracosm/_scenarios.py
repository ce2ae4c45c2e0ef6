"""`scenario`: makes a scenario of a function."""

import hashlib
import inspect
import os
import sys
from collections.abc import Callable
from importlib import import_module
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
    name and the description; without them, the name of the function and the first line of its documentation count. In a file, the name begins
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
