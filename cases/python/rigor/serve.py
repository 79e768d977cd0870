"""Serves an engine as a process plug-in: ``python3 -m rigor.serve my_module:MyEngine``, one JSON object a line.

``rigor run springs --plugin "python3 -m rigor.serve my_module:MyEngine"`` is what ``rigor.run(…, plugins=[MyEngine])`` does.
"""
from __future__ import annotations

import json
import os
import sys
import typing

import numpy as np

from ._guard import ServedWorld, failure
from ._host import Host
from .engines import specification_of_words
from .errors import DivergedError


class Server:
    """Answers requests. Columns of numbers follow the line of their answer."""

    def __init__(self, host: Host):
        self.host = host
        self.worlds: dict[int, ServedWorld] = {}

    def answer(self, ask: typing.Mapping[str, typing.Any]) -> tuple[dict[str, typing.Any], list[np.ndarray]]:
        call = ask["call"]
        if call == "info":
            info = json.loads(self.host.info())
            info["columns"] = "f64le"
            info["calls"] = ["run", *(["contacts"] if self.host.engine.reports_contacts else [])]
            return {"ok": True, **info}, []
        if call == "load":
            guarded = self.host.load_rows(ask["scene"], ask["settings"])
            self.worlds[ask["world"]] = ServedWorld(guarded)
            return {"ok": True, "settings": json.loads(guarded.settings)}, []
        world = self.worlds[ask["world"]]
        if call == "step":
            wrenches = ask.get("wrenches")
            world.step(ask["dt"], None if wrenches is None else np.array(wrenches, dtype=np.float64))
        elif call == "read":
            return {"ok": True, "time": world.time}, [world.read()]
        elif call == "run":
            return self._run(world, ask["dt"], ask["count"], ask["every"])
        elif call == "contacts":
            keys = ("point", "normal", "gap", "force")
            rows = [(a, b, n[:3], n[3:6], n[6], n[7:]) for a, b, *n in world.guarded.contacts()]
            return {"ok": True, "contacts": [{"a": a, "b": b, **dict(zip(keys, rest))} for a, b, *rest in rows]}, []
        elif call == "unload":
            del self.worlds[ask["world"]]
        else:
            return {"ok": False, "status": "unsupported", "why": f"no call {call}"}, []
        return {"ok": True}, []

    @staticmethod
    def _run(world: ServedWorld, dt: float, count: int, every: int) -> tuple[dict[str, typing.Any], list[np.ndarray]]:
        samples: list[dict[str, float]] = []
        states: list[np.ndarray] = []
        for n in range(1, count + 1):
            world.step(dt)
            if n % every == 0 or n == count:
                states.append(world.read())
                samples.append({"time": world.time})
        return {"ok": True, "samples": samples}, states

    def reply(self, line: bytes) -> bytes:
        columns: list[np.ndarray] = []
        ask: dict[str, typing.Any] = {}
        try:
            ask = json.loads(line)
            answer, columns = self.answer(ask)
        except BaseException as error:  # one answer for each request in any case, also for sys.exit
            status, why = failure(error)
            answer = {"ok": False, "status": status, "why": why}
            if isinstance(error, DivergedError) and ask.get("world") in self.worlds:
                answer["time"] = self.worlds[ask["world"]].time
                if hasattr(error, "body"):
                    answer["body"] = error.body
        return json.dumps(answer, allow_nan=False).encode() + b"\n" + b"".join(state.T.tobytes() for state in columns)


def main(words: list[str]) -> int:
    # What the engine prints must not mix with the answers.
    answers = os.fdopen(os.dup(1), "wb", buffering=0)
    os.dup2(2, 1)
    try:
        server = Server(Host(specification_of_words(words)))
    except BaseException as error:
        print(f"{' '.join(words)}: {failure(error)[1]}", file=sys.stderr)
        return 2
    process = os.getpid()
    requests = os.fdopen(os.dup(0), "rb")
    for line in requests:
        reply = server.reply(line)
        if os.getpid() != process:
            os._exit(70)
        at = memoryview(reply)
        while at:
            at = at[answers.write(at) or 0:]
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
