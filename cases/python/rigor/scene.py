"""A scene as typed attributes and as arrays of numpy. It is what an engine's ``load`` gets, and what a case holds."""
from __future__ import annotations

import dataclasses
import functools
import typing

import numpy as np

Row = typing.Mapping[str, typing.Any]


def _frozen(values: typing.Any) -> np.ndarray:
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array


@dataclasses.dataclass(frozen=True, eq=False)
class Body:
    """A rigid body at t = 0. Arrays are float64 and cannot be written."""

    name: str
    """As in the case file; no two bodies have the same."""
    mass: float
    """kg; of no meaning for a fixed body."""
    inertia: np.ndarray
    """(3, 3), kg m², about the centre of mass, in the body's frame B."""
    position: np.ndarray
    """(3,), m: the centre of mass in the world frame W."""
    orientation: np.ndarray
    """(4,): the unit quaternion w, x, y, z from B to W."""
    velocity: np.ndarray
    """(3,), m/s, in W."""
    angular_velocity: np.ndarray
    """(3,), rad/s, in W."""
    fixed: bool
    """Whether the body stays where it is."""
    collides: bool
    """Whether the body touches others."""
    shapes: tuple[Row, ...]
    """Rows as in the case file: ``{"type": "box", "size": [...]}``, with ``position`` and ``orientation_wxyz`` in B."""


def _body(row: Row) -> Body:
    xx, yy, zz, xy, xz, yz = row["inertia"]
    shapes = row["shapes"] if "shapes" in row else [row["shape"]] if row.get("shape") else []
    return Body(name=row["name"], mass=float(row.get("mass", 0.0)), inertia=_frozen([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]),
                position=_frozen(row.get("position", [0, 0, 0])), orientation=_frozen(row.get("orientation_wxyz", [1, 0, 0, 0])),
                velocity=_frozen(row["velocity"]), angular_velocity=_frozen(row["angular_velocity"]), fixed=bool(row["fixed"]),
                collides=bool(row["collides"]), shapes=tuple(shapes))


class Scene:
    """Bodies and what acts on them. SI units, right-handed; W is the world frame, B a body's frame at its centre of mass."""

    def __init__(self, rows: Row):
        self.rows: Row = rows
        """The scene with the keys of the case file and each default written out (``scene.schema.json``)."""
        self.bodies: tuple[Body, ...] = tuple(_body(row) for row in rows["body"])
        """In the scene's order. Rows of ``read()`` have this order too."""
        self.gravity: np.ndarray = _frozen(rows["gravity"])
        """(3,), m/s², in W."""
        self.springs: tuple[Row, ...] = tuple(rows.get("spring", ()))
        """Rows with the keys of ``[[scene.spring]]``, SI units: springs and dampers between points of two bodies."""
        self.joints: tuple[Row, ...] = tuple(rows.get("joint", ()))
        """Rows of ``[[scene.joint]]``: ``type``, ``a``, ``b``, and what the type has, in SI units."""
        self.couplings: tuple[Row, ...] = tuple(rows.get("coupling", ()))
        """Rows of ``[[scene.coupling]]``: gears, racks and mimic joints."""
        self.motors: tuple[Row, ...] = tuple(rows.get("motor", ()))
        """Rows of ``[[scene.motor]]``: drives of hinges [N m] and sliders [N], by an effort or towards a speed."""
        self.contacts: tuple[Row, ...] = tuple(rows.get("contact", ()))
        """Rows of ``[[scene.contact]]``: restitution, friction and stiffness of a pair of bodies."""
        self.forces: tuple[Row, ...] = tuple(rows.get("force", ()))
        """Rows of ``[[scene.force]]``: forces [N] and torques [N m] on a body, over time."""
        self.contact_default: Row = rows["contact_default"]
        """``restitution`` and ``friction`` of each pair without a row in `contacts`; friction may be ``"infinite"``."""

    def __len__(self) -> int:
        return len(self.bodies)

    def __repr__(self) -> str:
        return f"<rigor.Scene of {len(self)} bodies, {len(self.joints)} joints, {len(self.springs)} springs>"

    def index(self, name: str) -> int:
        """The place of a body. KeyError for a name that no body has."""
        for place, body in enumerate(self.bodies):
            if body.name == name:
                return place
        raise KeyError(f"no body is called {name!r}; there is: {', '.join(body.name for body in self.bodies)}")

    @functools.cached_property
    def mass(self) -> np.ndarray:
        """(n,), kg."""
        return _frozen([body.mass for body in self.bodies])

    @functools.cached_property
    def inertia(self) -> np.ndarray:
        """(n, 3, 3), kg m², about the centre of mass, in B."""
        return _frozen([body.inertia for body in self.bodies])

    @functools.cached_property
    def fixed(self) -> np.ndarray:
        """(n,), bool."""
        fixed = np.array([body.fixed for body in self.bodies], dtype=bool)
        fixed.setflags(write=False)
        return fixed

    def state(self) -> np.ndarray:
        """(n, 13) at t = 0: px py pz [m], qw qx qy qz, vx vy vz [m/s], wx wy wz [rad/s], in W. A new array each time."""
        return np.array([[*b.position, *b.orientation, *b.velocity, *b.angular_velocity] for b in self.bodies])
