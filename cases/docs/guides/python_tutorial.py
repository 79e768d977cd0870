# %% [markdown]
# # Rigor from Python
#
# It answers four questions. Which engine and step suit a robot's arm? Why do two engines part? Which friction fits a
# recording? How exact is an engine of one's own? Open this file in VS Code or Jupyter and run it cell
# by cell, or run it as a script. It writes two files into the current folder.

# %%
import pathlib

import numpy as np
import pandas as pd

import rigor

# %% [markdown]
# ## An arm from a URDF file
#
# The file is a robot of two links. `Case.from_urdf` imports it. What a scene cannot say is an error unless `lossy=True`
# accepts it; `losses` then names it.

# %%
pathlib.Path("arm.urdf").write_text("""<robot name="arm">
  <link name="base"/>
  <link name="upper"><inertial><origin xyz="0 0 -0.25"/><mass value="2"/>
    <inertia ixx="0.042" iyy="0.042" izz="0.003" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="fore"><inertial><origin xyz="0 0 -0.2"/><mass value="1"/>
    <inertia ixx="0.0135" iyy="0.0135" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="shoulder" type="continuous"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/><origin rpy="0 1.2 0"/></joint>
  <joint name="elbow" type="continuous"><parent link="upper"/><child link="fore"/><axis xyz="0 1 0"/><origin xyz="0 0 -0.5"/></joint>
</robot>
""")
arm = rigor.Case.from_urdf("arm.urdf")
print(arm.scene, arm.dt)

# %% [markdown]
# `run` simulates each engine with each step, and compares it with the truth. In a notebook the last line of a cell shows
# the table of verdicts. `to_dataframe` has a row a cell; `attrs["units"]` has the units.

# %%
results = rigor.run(arm, engines=["ode", "bullet", "core:rk4"], dt=["1/30", "1/240", "1/1000"], duration=2)
table = results.to_dataframe().pivot(index="engine", columns="dt", values="position_error")
print(table[["1/30", "1/240", "1/1000"]])
results

# %% [markdown]
# The cheapest cell within 1 cm is the answer. `tune` searches all steps and options of one engine instead.

# %%
within = [cell for cell in results.cells if cell.metric("position_error") <= 0.01]
best = min(within, key=lambda cell: cell.metric("cost"))
print(f"the arm: {best.engine} at dt = {best.dt} s, {1000 * best.metric('position_error'):.2g} mm")

# %% [markdown]
# ## Why two engines part
#
# `diverge` runs both with one step. It says when and where they part by 1 mm for each metre of the scene or by 1 mrad, and
# which of them is nearer the truth. It compares their steps, part of the physics by part, and tries which setting closes
# the gap. All numbers are in its attributes and in `json`.

# %%
parting = rigor.diverge(arm, engines=["ode", "core:rk4"], dt="1/240", duration=2)
print(parting)
print(f"they part at t = {parting.time:.3f} s, first at '{parting.body}'; nearer the truth: {parting.nearer}; cause: {parting.cause}")

# %% [markdown]
# ODE uses semi-implicit Euler. The core with that method moves as ODE does, and the difference of the steps falls with dt.
# So the two part by their schemes, and neither has gravity wrong. The order confirms it: the error falls with dt by the
# power that the scheme has.

# %%
for engine in ("ode", "core:rk4"):
    coarse, fine = (results.cell("arm", engine, dt).metric("position_error") for dt in ("1/240", "1/1000"))
    order = np.log(coarse / fine) / np.log(1000 / 240)
    print(f"{engine}: {1000 * coarse:.3g} mm at t = {coarse.worst_time:.2f} s, '{coarse.worst_body}'; the error falls as dt^{order:.1f}")

# %% [markdown]
# `trace` gives the runs themselves, as structured arrays. Runs with one step have the same rows, so their distance is one line.

# %%
ode, rk4 = (rigor.trace(arm, engine=engine, dt="1/240", duration=2) for engine in ("ode", "core:rk4"))
distance = np.linalg.norm(ode.position - rk4.position, axis=2)
for time in (0.5, 1, 2):
    print(f"t = {time:3} s: {1000 * distance[np.searchsorted(ode.times, time - 1e-9)].max():.3g} mm apart")

# %% [markdown]
# ## Fit friction to a recording
#
# A box slides on a floor until it rests. A recording of it is a CSV file with the columns of `trace`, and a column that
# divides it into trials. This one is made here: the true motion of nine throws with a friction of 0.3, with noise of 1 mm.

# %%
slide = {
    "title": "A box that slides to rest",
    "scene": {
        "gravity": [0, 0, -9.81],
        "body": [
            {"name": "box", "mass": 1, "shape": {"type": "box", "size": [0.2, 0.2, 0.1]}, "position": [0, 0, 0.05], "velocity": [2, 0, 0]},
            {"name": "floor", "shape": {"type": "plane", "normal": [0, 0, 1], "offset": 0}},
        ],
        "contact_default": {"friction": 0.3, "restitution": 0},
    },
    "run": {"duration": 0.9, "dt": ["1/1000"]},
    "truth": {"kind": "events"},
}
true = rigor.Case.from_dict(slide, name="slide", folder=".")  # where the recording will be found
noise = np.random.default_rng(1)
throws = []
for trial in range(9):
    throw = true.replace(**{"scene.body.box.velocity": [noise.uniform(1, 2.5), 0, 0]})
    seen = rigor.truth(throw, times=np.arange(0, 0.95, 0.05)).body("box").to_dataframe()
    seen[["px", "py", "pz"]] += noise.normal(0, 0.001, (len(seen), 3))
    throws.append(seen.assign(trial=f"throw {trial + 1}"))
pd.concat(throws)[["trial", "time", "body", "px", "py", "pz", "vx", "vy", "vz"]].to_csv("throws.csv", index=False)

# %% [markdown]
# The recording is now the truth of a case. `fit` searches the friction with which an engine follows it best. A third of the
# throws takes no part: `held_out` says how well the fitted value predicts them. The interval comes from the differences between
# the throws. The answer is true if the data tell each value and none is an end of its range.

# %%
recorded = true.replace(truth={"kind": "recording", "file": "throws.csv", "group": "trial", "position_noise": 0.001, "orientation_noise": 0.01})
fitted = rigor.fit(recorded, engine="ode", vary={"scene.contact_default.friction": (0.05, 0.9)}, hold_out=1 / 3)
print(fitted)
friction = fitted["scene.contact_default.friction"]
print(f"friction: {friction:.3f}, 95 %: {friction.interval[0]:.3f} to {friction.interval[1]:.3f}; the recording was made with 0.3")
print(f"held out: {1000 * fitted.held_out.position:.2g} mm; the value is {'good' if fitted else 'not sure'}")

# %% [markdown]
# ## An engine of your own
#
# A class with `load`; its world has `step` and `read`. `read` returns a row for each body: position, orientation
# (w, x, y, z), velocity and angular velocity, all in the world frame. The engine says what it can do in `features`; a scene
# that needs more is `unsupported` and never approximated.

# %%


class Falling:
    def __init__(self, scene):
        self.rows, self.gravity, self.moves = scene.state(), scene.gravity, ~scene.fixed
        self.inertia = [body.inertia for body in scene.bodies]

    def step(self, dt):
        self.rows[self.moves, 7:10] += dt * self.gravity
        self.rows[self.moves, 0:3] += dt * self.rows[self.moves, 7:10]

    def read(self):
        return self.rows


class First(rigor.Engine):
    name = "first"
    features = ["fixed-body"]
    methods = [{"name": "semi-implicit-euler", "order": 1, "leapfrog_stagger": 0.5}]

    def load(self, scene, settings):
        return Falling(scene)


checks = rigor.conform(First)
print(f"first: {'conforms' if checks else 'does not conform: ' + ', '.join(check['name'] for check in checks.broken())}")
print(checks)

# %% [markdown]
# `conform` says what came and what is due: this engine does not turn its bodies. The next one does. It keeps the angular
# momentum L = R I Rᵀ ω and turns by ω for dt.

# %%


def matrix(q):
    w, (x, y, z) = q[0], q[1:]
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + 2 * w * cross + 2 * cross @ cross


def turned(q, rotation):
    angle = np.linalg.norm(rotation)
    w, v = np.cos(angle / 2), 0.5 * np.sinc(angle / (2 * np.pi)) * rotation
    out = np.array([w * q[0] - v @ q[1:], *(w * q[1:] + q[0] * v + np.cross(v, q[1:]))])
    return out / np.linalg.norm(out)


class Turning(Falling):
    def step(self, dt):
        super().step(dt)
        for row, inertia, moves in zip(self.rows, self.inertia, self.moves):
            if not moves:
                continue
            r = matrix(row[3:7])
            momentum = r @ inertia @ r.T @ row[10:13]
            row[3:7] = turned(row[3:7], dt * row[10:13])
            r = matrix(row[3:7])
            row[10:13] = r @ np.linalg.solve(inertia, r.T @ momentum)


class Second(First):
    name = "second"

    def load(self, scene, settings):
        return Turning(scene)


checks = rigor.conform(Second)
print(f"second: {'conforms' if checks else 'does not conform: ' + ', '.join(check['name'] for check in checks.broken())}")

# %% [markdown]
# It is a column like any other. A case that needs more than it declares would be `unsupported`.

# %%
verdict = rigor.run(["ballistic/free-fall", "tops/dzhanibekov-box"], engines=[Second, "ode", "core:rk4"], dt="1/240", duration=2)
print(verdict.to_dataframe()[["case", "engine", "status", "verdict", "position_error", "orientation_error"]].to_string(index=False))
verdict
