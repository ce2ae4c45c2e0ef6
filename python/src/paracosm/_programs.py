"""The programs `paracosm-fuzz` and `paracosm-cover`, which the package puts on the path."""

import shutil
import signal
import sys
from collections.abc import Callable
from pathlib import Path

from . import _core


def fuzz() -> int:
    """Runs `paracosm-fuzz` with the arguments of this process."""
    return _run(_core.fuzz)


def cover() -> int:
    """Runs `paracosm-cover` with the arguments of this process."""
    return _run(_core.cover)


def _run(program: Callable[[list[str]], int]) -> int:
    # The program ends its work on Ctrl-C by itself. Python would only note the signal.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    called = Path(sys.argv[0])
    found = shutil.which(called.name)
    # Commands that the program prints begin as the user can type them again.
    is_on_path = found is not None and Path(found).resolve() == called.resolve()
    status = program([called.name if is_on_path else str(called), *sys.argv[1:]])
    sys.stdout.flush()
    return status
