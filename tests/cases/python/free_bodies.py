"""An engine of numpy for the tests: free bodies by semi-implicit Euler, all at once. Derived classes break it."""
import numpy as np

import rigor


def cross(a, b):
    return np.cross(a, b)


def matrices(q):
    """(n, 3, 3) of unit quaternions w, x, y, z."""
    w, x, y, z = q.T
    return np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), 2 * (x * y + w * z), 1 - 2 * (x * x + z * z),
                     2 * (y * z - w * x), 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], axis=1).reshape(-1, 3, 3)


def turned(q, v):
    """Turns by the rotation vectors v, in W."""
    angle = np.linalg.norm(v, axis=1)
    s = 0.5 * np.sinc(angle / (2 * np.pi))
    w, r = np.cos(angle / 2), s[:, None] * v
    out = np.concatenate([(w * q[:, 0] - (r * q[:, 1:]).sum(1))[:, None], w[:, None] * q[:, 1:] + q[:, :1] * r + np.cross(r, q[:, 1:])], axis=1)
    return out / np.linalg.norm(out, axis=1)[:, None]


class FreeWorld:
    def __init__(self, scene):
        self.rows = scene.state()
        self.moves = ~scene.fixed
        self.gravity, self.mass = scene.gravity, np.where(scene.fixed, 1.0, scene.mass)
        self.inertia = np.where(scene.fixed[:, None, None], np.eye(3), scene.inertia)
        self.inverse = np.linalg.inv(self.inertia)

    def in_world(self, tensor, q, v):
        r = matrices(q)
        return np.einsum("nij,njk,nlk,nl->ni", r, tensor, r, v)

    def step(self, dt, wrenches=None):
        x, q, v, w = (self.rows[:, a:b] for a, b in ((0, 3), (3, 7), (7, 10), (10, 13)))
        forces = np.zeros((len(x), 6)) if wrenches is None else wrenches
        m = self.moves[:, None]
        v += np.where(m, dt * (self.gravity + forces[:, :3] / self.mass[:, None]), 0)
        x += np.where(m, dt * v, 0)
        momentum = self.in_world(self.inertia, q, w) + dt * forces[:, 3:]
        middle = turned(q, dt / 2 * self.in_world(self.inverse, q, momentum))
        after = turned(q, dt * self.in_world(self.inverse, middle, momentum))
        q[:] = np.where(m, after, q)
        w[:] = np.where(m, self.in_world(self.inverse, q, momentum), w)

    def read(self):
        return self.rows


class FreeBodies(rigor.Engine):
    name = "numpy"
    features = ["wrench", "fixed-body"]
    methods = [{"name": "euler", "summary": "semi-implicit Euler", "order": 1, "leapfrog_stagger": 0.5}]

    def load(self, scene, settings):
        return FreeWorld(scene)
