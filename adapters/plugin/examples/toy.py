#!/usr/bin/env python3
"""The smallest engine for Rigor, to copy: free bodies by semi-implicit Euler, in Python's standard library alone.

    rigor conform --plugin "python3 toy.py"

v1 = v0 + dt (g + F / m),  x1 = x0 + dt v1;  L1 = L0 + dt T in the world frame, w = I^-1 L at the middle of the turn,
q1 = exp(dt w) q0. Springs, dampers and timed forces come as wrenches, worked out by Rigor ("wrench").
"""
import json
import math
import sys

answers = sys.stdout
sys.stdout = sys.stderr  # other output must not mix with the answers

INFO = {"ok": True, "name": "toy-py", "version": "1", "precision": "double", "features": ["wrench", "fixed-body"],
        "methods": [{"name": "euler", "summary": "semi-implicit Euler, angular momentum kept in the world frame",
                     "order": 1, "leapfrog_stagger": 0.5}], "calls": ["run", "save", "restore"]}


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def times(p, q):  # quaternions, w first
    v = cross(p[1:], q[1:])
    return [p[0] * q[0] - sum(a * b for a, b in zip(p[1:], q[1:]))] + [p[0] * q[i + 1] + q[0] * p[i + 1] + v[i] for i in range(3)]


def turn(q, v):
    return times(times(q, [0.0] + v), [q[0], -q[1], -q[2], -q[3]])[1:]


def exp(v):  # the rotation by |v| about v
    angle = math.sqrt(sum(x * x for x in v))
    s = math.sin(angle / 2) / angle if angle > 1e-8 else 0.5 - angle * angle / 48
    return [math.cos(angle / 2)] + [s * x for x in v]


def matrix(i):  # xx, yy, zz, xy, xz, yz
    return [[i[0], i[3], i[4]], [i[3], i[1], i[5]], [i[4], i[5], i[2]]]


def apply(m, v):
    return [sum(a * b for a, b in zip(row, v)) for row in m]


def inverse(m):
    c = [cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])]
    det = sum(a * b for a, b in zip(m[0], c[0]))
    return [[c[j][i] / det for j in range(3)] for i in range(3)]


class Body:
    def __init__(self, row):
        self.moves = not row["fixed"]
        self.mass, self.inertia = row["mass"], matrix(row["inertia"])
        self.inverse = inverse(self.inertia) if self.moves else None
        self.x, self.q = row.get("position", [0.0] * 3), row.get("orientation_wxyz", [1.0, 0.0, 0.0, 0.0])
        self.v, self.w = row["velocity"], row["angular_velocity"]

    def in_world(self, m, q, v):  # R m R^T v
        back = [q[0], -q[1], -q[2], -q[3]]
        return turn(q, apply(m, turn(back, v)))

    def step(self, dt, gravity, wrench):
        force, torque = wrench[:3], wrench[3:]
        self.v = [v + dt * (g + f / self.mass) for v, g, f in zip(self.v, gravity, force)]
        self.x = [x + dt * v for x, v in zip(self.x, self.v)]
        momentum = [m + dt * t for m, t in zip(self.in_world(self.inertia, self.q, self.w), torque)]
        w = self.in_world(self.inverse, self.q, momentum)
        middle = times(exp([dt / 2 * a for a in w]), self.q)
        w = self.in_world(self.inverse, middle, momentum)
        q = times(exp([dt * a for a in w]), self.q)
        size = math.sqrt(sum(a * a for a in q))
        self.q = [a / size for a in q]
        self.w = self.in_world(self.inverse, self.q, momentum)


class World:
    def __init__(self, scene):
        self.gravity, self.bodies, self.time = scene["gravity"], [Body(row) for row in scene["body"]], 0.0

    def step(self, dt, wrenches=None):
        for i, body in enumerate(self.bodies):
            if body.moves:
                body.step(dt, self.gravity, wrenches[i] if wrenches else [0.0] * 6)
        self.time += dt

    def save(self):  # all that the next steps depend on
        return json.dumps([self.time, [[body.x, body.q, body.v, body.w] for body in self.bodies]])

    def restore(self, snapshot):
        self.time, states = json.loads(snapshot)
        for body, state in zip(self.bodies, states):
            body.x, body.q, body.v, body.w = state

    def state(self):
        rows = [body.x + body.q + body.v + body.w for body in self.bodies]
        for i, row in enumerate(rows):
            if not all(math.isfinite(x) for x in row):
                return {"ok": False, "status": "diverged", "why": "a number is not finite", "time": self.time, "body": i}
        return {"ok": True, "time": self.time, "bodies": rows}


def run(world, dt, count, every):
    samples = []
    for n in range(1, count + 1):
        world.step(dt)
        if n % every == 0 or n == count:
            samples.append(world.state())
            if not samples[-1]["ok"]:
                return samples[-1]
    return {"ok": True, "samples": samples}


def answer(worlds, ask):
    call = ask["call"]
    if call == "info":
        return INFO
    if call == "load":
        worlds[ask["world"]] = World(ask["scene"])
        return {"ok": True, "settings": {"gyroscopic": "on, by the angular momentum"}}
    world = worlds[ask["world"]]
    if call == "step":
        world.step(ask["dt"], ask.get("wrenches"))
    elif call == "read":
        return world.state()
    elif call == "run":
        return run(world, ask["dt"], ask["count"], ask["every"])
    elif call == "save":
        return {"ok": True, "snapshot": world.save()}
    elif call == "restore":
        world.restore(ask["snapshot"])
    elif call == "unload":
        del worlds[ask["world"]]
    else:
        return {"ok": False, "status": "unsupported", "why": "no call " + call}
    return {"ok": True}


open_worlds = {}
for line in sys.stdin:
    try:
        reply = answer(open_worlds, json.loads(line))
    except Exception as error:  # one answer for each request in any case
        reply = {"ok": False, "status": "failed", "why": repr(error)}
    print(json.dumps(reply, allow_nan=False), file=answers, flush=True)
