"""The progress of a campaign: a line in a terminal, or a line of a notebook's cell that changes."""

import sys
import time
from importlib import import_module
from typing import Any, TextIO

# The least seconds between two changes of the line.
_PAUSE = 0.1
_WIDTH = 30


class Line:
    """A line that says how many tests are done. It is gone once the campaign has ended."""

    def __init__(self, stream: TextIO | None = None, display: Any = None) -> None:
        self.stream = stream
        self.display = display
        self.handle: Any = None
        self.begun = self.shown = time.monotonic()

    def __call__(self, done: int, budget: int) -> None:
        now = time.monotonic()
        if now - self.shown < _PAUSE:
            return
        self.shown = now
        self._show(self.text(done, budget, now - self.begun))

    def text(self, done: int, budget: int, seconds: float) -> str:
        """Returns the line after some seconds."""
        full = _WIDTH * done // max(budget, 1)
        left = f", {seconds * (budget - done) / done:.0f} s remaining" if done else ""
        return f"[{'#' * full}{'.' * (_WIDTH - full)}] {done}/{budget}, {seconds:.0f} s elapsed{left}"

    def end(self) -> None:
        """Removes the line."""
        self._show("")

    def _show(self, text: str) -> None:
        if self.stream is not None:
            try:
                self.stream.write(f"\r{text}\x1b[K")
                self.stream.flush()
            except (OSError, ValueError):
                # A terminal that has gone away ends no campaign.
                self.stream = None
        elif self.handle is not None:
            self.handle.update({"text/plain": text}, raw=True)
        elif text and self.display is not None:
            self.handle = self.display({"text/plain": text}, raw=True, display_id=True)


def usual() -> Line | None:
    """Returns the progress for this place: a terminal or a notebook. Elsewhere, such as in a pipe, there is none."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    if shell is not None and hasattr(shell, "kernel"):
        return Line(display=import_module("IPython.display").display)
    try:
        is_terminal = sys.stderr is not None and sys.stderr.isatty()
    except (AttributeError, ValueError):
        # It is closed, or something else stands in its place.
        return None
    return Line(sys.stderr) if is_terminal else None
