"""Rigor measures how accurate rigid-body simulators are. This package runs it from Python.

    import rigor
    result = rigor.run("springs/fixed-spring", engines=["ode", "core:rk4"], dt="1/30")
    result.to_dataframe()
    rigor.trace("springs/fixed-spring", engine="ode", dt=1/240)      # a structured array of numpy
    rigor.conform(MyEngine)                                           # a class of rigor.Engine

All quantities are in SI units; an orientation is the unit quaternion (w, x, y, z) from the body to the world. All errors
are exceptions of ``RigorError`` with the sentence of the command line.
"""
from __future__ import annotations

import importlib
import typing

# Names are imported where they are first used, because numpy takes most of the time of an import.
_HOMES = {
    "errors": ("DivergedError", "EngineError", "InputError", "Interrupted", "RigorError", "RigorWarning", "UnsupportedError"),
    "case": ("Case", "load"),
    "engines": ("Engine", "World"),
    "motion": ("Closeness", "Trajectory", "close", "trace", "truth"),
    "results": ("Cell", "Metric", "Results"),
    "answers": ("Conformance", "Diagnosis", "Divergence", "Printed", "Repeats", "Tuned"),
    "fitted": ("FitError", "Fitted", "FittedValue"),
    "runs": ("Sweep", "command", "conform", "diagnose", "diverge", "fit", "gate", "repeat", "run", "sweep", "tune"),
    "scene": ("Body", "Scene"),
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}
__all__ = sorted(_HOME_OF)
__version__ = "@PROJECT_VERSION@"


def __getattr__(name: str) -> typing.Any:
    home = _HOME_OF.get(name)
    if home is None:
        raise AttributeError(f"module 'rigor' has no attribute {name!r}")
    value = getattr(importlib.import_module(f".{home}", __name__), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
