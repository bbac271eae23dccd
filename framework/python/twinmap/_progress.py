"""How a run tells how far it is."""
import sys
from typing import Callable, Optional, Union

from ._twinmap import Progress

ProgressChoice = Union[bool, None, Callable[[Progress], None]]


class _ProgressLine:
    """A line on stderr that is written again and again; in notebooks too."""

    def __init__(self) -> None:
        self._stage = ""

    def __call__(self, progress: Progress) -> None:
        if self._stage and progress.stage != self._stage:
            self.close()
        self._stage = progress.stage
        failed = f", {progress.failed} failed" if progress.failed else ""
        sys.stderr.write(f"\r{progress.stage}: {progress.done} of {progress.total}{failed}")
        sys.stderr.flush()

    def close(self) -> None:
        if self._stage:
            sys.stderr.write("\n")
        self._stage = ""


class ProgressReport:
    """What `progress=` asks for: nothing, a line on stderr, or a function of the caller's."""

    def __init__(self, choice: ProgressChoice) -> None:
        self._line = _ProgressLine() if choice is True else None
        self.callback: Optional[Callable[[Progress], None]] = self._line or (choice if callable(choice) else None)
        if choice and self.callback is None:
            raise TypeError("progress: must be True, False or a function")

    def __enter__(self) -> Optional[Callable[[Progress], None]]:
        return self.callback

    def __exit__(self, *_: object) -> None:
        if self._line:
            self._line.close()
