#!/usr/bin/env python3
"""Measures the reach of the package: times of an import, a long trace, a step of an engine in process, and memory.

  PYTHONPATH=build/release/python bench/python_reach.py
"""
import os
import resource
import statistics
import subprocess
import sys
import time

import numpy as np

import rigor
from rigor.program import program


def seconds(work, repeats):
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        work()
        times.append(time.perf_counter() - begin)
    return min(times), statistics.median(times)


def importing():
    own = seconds(lambda: subprocess.run([sys.executable, "-c", "import rigor"], check=True), 15)
    bare = seconds(lambda: subprocess.run([sys.executable, "-c", "pass"], check=True), 15)
    print(f"import rigor: {1000 * own[0]:.0f} ms with the interpreter's start of {1000 * bare[0]:.0f} ms (least of 15; median {1000 * own[1]:.0f} ms)")


def falling(bodies):
    """So many bodies fall side by side."""
    return rigor.Case.from_dict({"title": "many", "run": {"duration": 1, "dt": ["1/100"]}, "scene": {
        "gravity": [0, 0, -9.8], "body": [{"name": f"b{i}", "mass": 1, "inertia": [1, 1, 1], "position": [3 * i, 0, 0]} for i in range(bodies)]}})


def long_trace():
    """Ten bodies at 100,001 instants: a run keeps at most about a million instants."""
    import tempfile
    case = falling(10)
    with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
        file.write(case.to_toml())
        file.flush()
        words = ["trace", file.name, "--engine", "core:rk4", "--dt", "1e-5", "--duration", "1"]

        def bare():
            with open(os.memfd_create("bare"), "wb") as target:
                subprocess.run([program(), *words, "--format", "npy"], stdout=target, check=True)

        # In turns, because the machine's own pace changes.
        times = [(seconds(lambda: rigor.trace(file.name, engine="core:rk4", dt="1e-5", duration=1), 1)[0], seconds(bare, 1)[0]) for _ in range(7)]
        rows = len(rigor.trace(file.name, engine="core:rk4", dt="1e-5", duration=1))
    own, run = (min(row[k] for row in times) for k in range(2))
    print(f"a trace of {rows} rows: {1000 * own:.0f} ms; the program alone {1000 * run:.0f} ms; beyond it {1000 * (own - run):.0f} ms (least of 7)")


class Still(rigor.Engine):
    name = "still"
    features = ["fixed-body"]
    in_process = True

    def load(self, scene, settings):
        return StillWorld(scene)


class StillWorld:
    """Numpy's own work is all that a step does: a thousand bodies fall."""

    def __init__(self, scene):
        self.rows, self.gravity = np.asfortranarray(scene.state()), scene.gravity
        self.x, self.v = self.rows[:, 0:3], self.rows[:, 7:10]

    def step(self, dt):
        self.v += dt * self.gravity
        self.x += dt * self.v

    def read(self):
        return self.rows


def in_process_step(bodies=1000, steps=20000):
    """The library as the program calls it, and the same world called from Python."""
    import ctypes
    import json

    from rigor.engines import Plugins
    case = falling(bodies)
    library = ctypes.PyDLL(Plugins(Still, in_process=True).words()[1])  # keeps Python's lock, as a host's thread does

    class Text(ctypes.Structure):
        _fields_ = [("data", ctypes.c_char_p), ("room", ctypes.c_size_t)]

    pointer = ctypes.c_void_p
    kinds = {"info": [Text], "load": [ctypes.c_char_p, ctypes.c_char_p, ctypes.POINTER(pointer), Text], "step": [pointer, ctypes.c_double, pointer, Text],
             "read": [pointer, ctypes.POINTER(ctypes.c_double), pointer, Text]}

    class Table(ctypes.Structure):
        _fields_ = [("struct_size", ctypes.c_size_t), *((name, ctypes.PYFUNCTYPE(ctypes.c_int32, *arguments)) for name, arguments in kinds.items())]

    library.rigor_engine_entry.restype = ctypes.POINTER(Table)
    table = library.rigor_engine_entry(1).contents
    buffer = ctypes.create_string_buffer(65536)
    text, world = Text(ctypes.cast(buffer, ctypes.c_char_p), 65536), pointer()
    scene = json.dumps(case.scene.rows).encode()
    path = list(sys.path)
    assert table.load(scene, b'{"method":"default","track":"matched","options":{}}', ctypes.byref(world), text) == 0, buffer.value
    sys.path[:] = path
    alone = StillWorld(case.scene)

    def host():
        for _ in range(steps):
            table.step(world, 0.001, None, text)

    def numpy_only():
        for _ in range(steps):
            alone.step(0.001)

    columns = np.empty((13, bodies))
    addresses = (pointer * 13)(*(columns[c].ctypes.data for c in range(13)))
    now = ctypes.c_double()

    def reads():
        for _ in range(steps):
            table.read(world, ctypes.byref(now), ctypes.cast(addresses, pointer), text)

    own, bare, read = seconds(host, 5), seconds(numpy_only, 5), seconds(reads, 3)
    print(f"a step of {bodies} bodies in process: {1e6 * own[0] / steps:.2f} us; numpy alone {1e6 * bare[0] / steps:.2f} us; over it "
          f"{1e6 * (own[0] - bare[0]) / steps:.2f} us, with the call of ctypes; a read {1e6 * read[0] / steps:.2f} us (least of 5)")


def memory(runs=1000):
    def resident():
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * resource.getpagesize() / 2**20

    marks = []
    for n in range(1, runs + 1):
        rigor.run("ballistic/free-fall", engines="core:rk4", dt="1/30", duration=0.1, progress=False, series=False)
        if n in (runs // 10, runs // 2, runs):
            marks.append((n, resident(), len(os.listdir("/proc/self/fd"))))
    print("memory: " + "; ".join(f"after {n} runs {size:.1f} MiB, {files} files open" for n, size, files in marks))


if __name__ == "__main__":
    importing()
    long_trace()
    in_process_step()
    memory(int(sys.argv[1]) if len(sys.argv) > 1 else 1000)
