"""An engine of numpy for the tests: free bodies by semi-implicit Euler, all at once. Derived classes break it."""
import os
import sys
import textwrap

import numpy as np

import rigor


NEXT, LAST = [1, 2, 0], [2, 0, 1]


def cross(a, b):
    """The same as numpy's, in a fifth of its time on few rows."""
    return a[:, NEXT] * b[:, LAST] - a[:, LAST] * b[:, NEXT]


def matrices(q):
    """(n, 3, 3) of unit quaternions w, x, y, z."""
    p = 2 * q.T[:, None] * q.T
    (_, wx, wy, wz), (_, xx, xy, xz), (_, _, yy, yz), (_, _, _, zz) = p
    out = np.empty((3, 3, len(q)))
    out[0] = 1 - yy - zz, xy - wz, xz + wy
    out[1] = xy + wz, 1 - xx - zz, yz - wx
    out[2] = xz - wy, yz + wx, 1 - xx - yy
    return out.transpose(2, 0, 1)


def turned(q, v):
    """Turns by the rotation vectors v, in W."""
    angle = np.linalg.norm(v, axis=1)
    s = 0.5 * np.sinc(angle / (2 * np.pi))
    w, r = np.cos(angle / 2), s[:, None] * v
    out = np.concatenate([(w * q[:, 0] - (r * q[:, 1:]).sum(1))[:, None], w[:, None] * q[:, 1:] + q[:, :1] * r + cross(r, q[:, 1:])], axis=1)
    return out / np.linalg.norm(out, axis=1)[:, None]


class FreeWorld:
    def __init__(self, scene):
        self.rows = scene.state()
        self.moves = ~scene.fixed
        self.gravity, self.mass = scene.gravity, np.where(scene.fixed, 1.0, scene.mass)
        self.inertia = np.where(scene.fixed[:, None, None], np.eye(3), scene.inertia)
        self.inverse = np.linalg.inv(self.inertia)

    @staticmethod
    def in_world(tensor, r, v):
        return (r @ (tensor @ (r.transpose(0, 2, 1) @ v[:, :, None])))[:, :, 0]

    def step(self, dt, wrenches=None):
        x, q, v, w = (self.rows[:, a:b] for a, b in ((0, 3), (3, 7), (7, 10), (10, 13)))
        forces = np.zeros((len(x), 6)) if wrenches is None else wrenches
        m = self.moves[:, None]
        v += np.where(m, dt * (self.gravity + forces[:, :3] / self.mass[:, None]), 0)
        x += np.where(m, dt * v, 0)
        r = matrices(q)
        momentum = self.in_world(self.inertia, r, w) + dt * forces[:, 3:]
        middle = turned(q, dt / 2 * self.in_world(self.inverse, r, momentum))
        after = turned(q, dt * self.in_world(self.inverse, matrices(middle), momentum))
        q[:] = np.where(m, after, q)
        w[:] = np.where(m, self.in_world(self.inverse, matrices(q), momentum), w)

    def read(self):
        return self.rows


class FreeBodies(rigor.Engine):
    name = "numpy"
    features = ["wrench", "fixed-body"]
    methods = [{"name": "euler", "summary": "semi-implicit Euler", "order": 1, "leapfrog_stagger": 0.5}]

    def load(self, scene, settings):
        return FreeWorld(scene)


class Broken(FreeBodies):
    name = "broken"
    world_class = FreeWorld

    def load(self, scene, settings):
        return self.world_class(scene)


def broken(method, body):
    """A class whose world has another `step` or `read`; a step is the tenth, so that it fails on the way."""
    namespace = {"np": np, "os": os, "sys": sys, "FreeWorld": FreeWorld, "rigor": rigor}
    source = f"""
class Faulty(FreeWorld):
    def __init__(self, scene):
        super().__init__(scene)
        self.count = 0
    def step(self, dt, wrenches=None):
        self.count += 1
        if '{method}' == 'step' and self.count == 10:
{textwrap.indent(textwrap.dedent(body), ' ' * 12)}
        super().step(dt, wrenches)
    def read(self):
        if '{method}' == 'read' and self.count == 10:
{textwrap.indent(textwrap.dedent(body), ' ' * 12)}
        return self.rows
"""
    exec(source, namespace)
    return type("Broken", (Broken,), {"world_class": namespace["Faulty"], "__module__": "__main__"})
