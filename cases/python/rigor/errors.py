"""The exceptions of the package. Their texts are the sentences of the command line."""
from __future__ import annotations


class RigorError(Exception):
    """The base of all exceptions of this package."""


class InputError(RigorError, ValueError):
    """Bad usage or bad input. The text says what was found and what is allowed.

    ``path`` is the place of the value, as ``scene.body[0].mass`` for a case from a dict, or ``file:line:column``; None if
    the input is no file and no dict.
    """

    def __init__(self, text: str, path: str | None = None):
        super().__init__(text)
        self.path: str | None = path
        """The place of the value; None if the input is no file and no dict."""


class UnsupportedError(RigorError):
    """The engine lacks what the scene needs. An engine raises it in ``load``; the cell is then ``unsupported``."""


class DivergedError(RigorError):
    """An engine raises it in ``step`` or ``read`` if its motion blew up. The cell is then ``diverged``."""


class EngineError(RigorError):
    """An engine or Rigor itself failed: the engine raised, crashed, hung or gave an invalid answer."""


class Interrupted(KeyboardInterrupt):
    """Ctrl-C. Finished cells are kept in the folder ``out``: the same call with ``out=…, resume=True`` continues."""

    def __init__(self, text: str, out: str | None = None):
        super().__init__(text)
        self.out: str | None = out
        """The folder with the finished cells; None for a call that keeps none."""


class RigorWarning(UserWarning):
    """What the program says on stderr about a result, as that a run blew up."""
