#!/usr/bin/env python3
"""DART from Python (Debian's python3-dartpy) as an engine for Rigor: free bodies, and the forces that Rigor computes.

    python3 dartpy_engine.py                   checks it, and compares it with DART's C++ adapter

`load` builds dartpy's world from the scene, `step` makes one step, `read` copies poses and velocities into an array.
"""
import dartpy
import numpy as np

import rigor


class DartWorld:
    """One world of dartpy. A skeleton for each body; its joint is free, or a weld if the body is fixed."""

    def __init__(self, scene):
        self.world = dartpy.simulation.World()
        self.world.setGravity(scene.gravity)
        self.parts = [self.part(body) for body in scene.bodies]

    def part(self, body):
        skeleton = dartpy.dynamics.Skeleton(body.name)
        pose = dartpy.math.Isometry3()
        pose.set_rotation(dartpy.math.Quaternion(*body.orientation).to_rotation_matrix())
        pose.set_translation(body.position)
        if body.fixed:
            joint, node = skeleton.createWeldJointAndBodyNodePair()
            joint.setTransformFromParentBodyNode(pose)
        else:
            joint, node = skeleton.createFreeJointAndBodyNodePair()
            # The frame of the body has its origin at the centre of mass.
            node.setInertia(dartpy.dynamics.Inertia(body.mass, np.zeros(3), body.inertia))
            joint.setTransform(pose)
            joint.setLinearVelocity(body.velocity)
            joint.setAngularVelocity(body.angular_velocity)
        node.setCollidable(False)
        self.world.addSkeleton(skeleton)
        return joint, node, body.fixed

    def step(self, dt, wrenches=None):
        self.world.setTimeStep(dt)
        if wrenches is not None:
            for (joint, node, fixed), wrench in zip(self.parts, wrenches):
                if not fixed:
                    # The coordinates of a free joint are in the frame of its body: torque first, then force.
                    back = node.getWorldTransform().rotation().T
                    joint.setForces(np.concatenate([back @ wrench[3:], back @ wrench[:3]]))
        self.world.step(True)  # and clears the forces

    def read(self):
        rows = np.empty((len(self.parts), 13))
        for row, (_, node, _) in zip(rows, self.parts):
            pose = node.getWorldTransform()
            q = pose.quaternion()
            row[:3] = np.ravel(pose.translation())
            row[3:7] = q.w(), q.x(), q.y(), q.z()
            row[7:10] = np.ravel(node.getLinearVelocity())
            row[10:] = np.ravel(node.getAngularVelocity())
        return rows

    def settings(self):
        """What is in force, read back."""
        return {"gravity": np.ravel(self.world.getGravity()).tolist()}


class DartPy(rigor.Engine):
    name = "dartpy"
    version = "6.12"
    features = ["wrench", "fixed-body"]
    # Semi-implicit: the velocities that it reports lag half a step behind its positions.
    methods = [{"name": "semi-implicit-euler", "summary": "DART's step in the coordinates of free joints", "order": 1, "leapfrog_stagger": 0.5}]

    def load(self, scene, settings):
        return DartWorld(scene)


if __name__ == "__main__":
    checks = rigor.conform(DartPy)
    print(checks)
    results = rigor.run("springs/fixed-spring", engines=[DartPy, "dart"], dt=["1/30", "1/240"])
    print(results)
    raise SystemExit(0 if checks else 1)
