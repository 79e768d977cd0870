# A correct plug-in that differs from the examples in everything. "sparse" says as little as allowed, with whole
# numbers, blanks and carriage returns. "rich" adds unknown keys, null for missing values, numbers with exponents, and
# raw columns in some answers and rows in others.
import json
import struct
import sys

mode = sys.argv[1]
is_rich = mode == "rich"
INFO = {"ok": True, "name": mode, "version": "0.0-α", "precision": "double", "features": [], "methods": [{"name": "m"}]}
if is_rich:
    INFO = {"nonsense": {"name": ["a", None, {"b": 1e300}]}, "methods": [
        {"summary": "über \\ \"quoted\"", "options": None, "symmetric": None, "leapfrog_stagger": 1, "order": 1.0,
         "symplectic": True, "name": "m", "colour": "red"}], "calls": ["run", "dance"], "columns": "f64le", "rigor": 1,
        "features": ["teleport", "contact:plane-sphere", "fixed-body"], "precision": "double", "version": "1",
        "name": mode, "ok": True, "padding": "x" * 100000}


def whole(x):
    return int(x) if not is_rich and x == int(x) else x


def say(answer, raw=b""):
    if is_rich:
        text = json.dumps({"zzz": None, "call": ask["call"], **answer, "more": [[], {}]})
    else:
        text = " \t" + json.dumps(answer, ensure_ascii=False).replace(",", " , ").replace(":", " :\t") + "  \r"
    sys.stdout.buffer.write(text.encode() + b"\n" + raw)
    sys.stdout.buffer.flush()


def columns(rows):
    return struct.pack("<%dd" % (13 * len(rows)), *[row[c] for c in range(13) for row in rows])


class World:
    def __init__(self, scene):
        self.g, self.time, self.rows, self.reads = scene["gravity"], 0, [], 0
        for b in scene["body"]:
            self.rows.append(b["position"] + b["orientation_wxyz"] + b["velocity"] + b["angular_velocity"])

    def step(self, dt):
        for row in self.rows:
            for k in range(3):
                row[7 + k] += dt * self.g[k]
                row[k] += dt * row[7 + k]
        self.time += dt

    def state(self):
        return {"time": whole(self.time), "bodies": [[whole(x) for x in row] for row in self.rows]}


worlds = {}
for line in sys.stdin.buffer:
    ask = json.loads(line)
    call, world = ask["call"], worlds.get(ask.get("world"))
    if call == "info":
        say(INFO)
    elif call == "load":
        worlds[ask["world"]] = World(ask["scene"])
        say({"ok": True, "settings": {"a": {"b": [1, None]}, "c": None}} if is_rich else {"ok": True})
    elif call == "step":
        world.step(ask["dt"])
        say({"ok": True, "time": -1, "bodies": "none of your business"} if is_rich else {"ok": True})
    elif call == "read":
        world.reads += 1
        if is_rich and world.reads % 2:
            say({"ok": True, "time": world.time, "world": ask["world"]}, columns(world.rows))
        else:
            say({"ok": True, **world.state()})
    elif call == "run":
        samples, raw = [], b""
        for n in range(1, ask["count"] + 1):
            world.step(ask["dt"])
            if n % ask["every"] == 0 or n == ask["count"]:
                samples.append({"time": world.time, "energy": None})
                raw += columns(world.rows)
        say({"samples": samples, "ok": True}, raw)
    elif call == "unload":
        del worlds[ask["world"]]
        say({"ok": True})
