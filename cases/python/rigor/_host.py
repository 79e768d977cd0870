"""Loads the class of an engine and answers for it: in a cell's process for engine_host.cpp, or in one of its own (serve.py)."""
from __future__ import annotations

import base64
import importlib
import json
import os
import typing

from ._guard import Fault, GuardedWorld
from .engines import Engine, described
from .scene import Scene


def class_of(specification: typing.Mapping[str, typing.Any]) -> type[Engine]:
    """The class that a specification names, or holds by value."""
    if "by_value" in specification:
        import pickle
        found = pickle.loads(base64.b64decode(specification["by_value"]))
    else:
        found = importlib.import_module(specification["module"])
        for name in specification["class"].split("."):
            found = getattr(found, name)
    return found


class Host:
    """One engine. Texts are the JSON of the plug-ins' protocol."""

    def __init__(self, specification: typing.Mapping[str, typing.Any]):
        # A module that runs cases while it is imported would start this process again and again (program.py).
        os.environ["RIGOR_IN_ENGINE"] = "1"
        try:
            cls = class_of(specification)
        finally:
            del os.environ["RIGOR_IN_ENGINE"]
        self.engine = cls()
        self.who = type(self.engine).__name__

    def info(self) -> str:
        return json.dumps({"ok": True, **described(self.engine)})

    def load(self, scene: str, settings: str) -> GuardedWorld:
        return self.load_rows(json.loads(scene), json.loads(settings))

    def load_rows(self, rows: typing.Mapping[str, typing.Any], settings: typing.Mapping[str, typing.Any]) -> GuardedWorld:
        scene = Scene(rows)
        world = self.engine.load(scene, settings)
        if world is None:
            raise Fault(f"{self.who}.load() returned None; it returns a world with step(dt) and read()")
        return GuardedWorld(self.who, world, scene, settings, self.engine.reports_contacts, "wrench" in self.engine.features)
