"""Classes that are no engines, engines of scripts and modules, several at once, and two threads on one world."""
import os
import pathlib
import subprocess
import sys
import textwrap

import pytest
from free_bodies import FreeBodies, FreeWorld

import rigor

BOTH = pytest.mark.parametrize("in_process", [False, True], ids=["own-process", "in-process"])


class NoLoad(rigor.Engine):
    pass


class NoWorld(FreeBodies):
    def load(self, scene, settings):
        return None


class NoStep(FreeBodies):
    def load(self, scene, settings):
        return object()


class NeedsWrenches(FreeBodies):
    def load(self, scene, settings):
        world = FreeWorld(scene)
        world.step = lambda dt, wrenches: None
        return world


class TakesNoWrenches(FreeBodies):
    def load(self, scene, settings):
        world = FreeWorld(scene)
        world.step = lambda dt: None
        return world


class BadSettings(FreeBodies):
    def load(self, scene, settings):
        world = FreeWorld(scene)
        world.settings = 3
        return world


class BadName(FreeBodies):
    name = "two words"


class BadFeatures(FreeBodies):
    features = "wrench"


class BadMethods(FreeBodies):
    methods = [{"order": 1}]


class UnknownFeature(FreeBodies):
    features = ["wrench", "flying"]


class Taken(FreeBodies):
    name = "ode"


@BOTH
@pytest.mark.parametrize("engine, words", [
    (NoLoad, "has no method load"), (NoWorld, r"load\(\) returned None"), (NoStep, r"without a method step\(\)"), (BadName, "allowed: 1 to 64"),
    (NeedsWrenches, r"missing a required argument: 'wrenches'; write step\(self, dt, wrenches=None\)"),
    (TakesNoWrenches, r"as step\(dt, wrenches\): too many positional arguments"), (BadSettings, "are a int; they are a dict of texts"),
    (BadFeatures, "it is a list of texts"), (BadMethods, "each with a name"), (Taken, "ode"), (FreeBodies(), r"give FreeBodies, and not FreeBodies\(\)"),
    (int, "class of rigor.Engine"), (None, "class of rigor.Engine"),
])
def test_a_class_that_is_no_engine_is_refused(engine, words, in_process):
    with pytest.raises(rigor.RigorError, match=words) as caught:
        rigor.trace("ballistic/free-fall", engine=engine, dt="1/30", duration=1, in_process=in_process)
    assert "\n" not in str(caught.value)


def test_an_object_that_cannot_travel_is_named():
    import threading
    lock = threading.Lock()

    class Locked(FreeBodies):
        name = "locked"

        def load(self, scene, settings):
            with lock:
                return FreeWorld(scene)

    with pytest.raises(rigor.InputError, match="cannot be sent to another process"):
        rigor.trace("ballistic/free-fall", engine=Locked, dt="1/30")


def test_a_module_that_runs_when_it_is_imported_is_told_so(tmp_path):
    (tmp_path / "unguarded.py").write_text(textwrap.dedent("""
        import rigor
        from free_bodies import FreeBodies
        class Mine(FreeBodies):
            name = "mine"
        rigor.trace("ballistic/free-fall", engine=Mine, dt="1/30", duration=1)
    """))
    said = subprocess.run([sys.executable, "-c", "import unguarded"], capture_output=True, text=True, cwd=tmp_path, timeout=120,
                          env=dict(os.environ, PYTHONPATH=os.pathsep.join([os.environ["PYTHONPATH"], os.path.dirname(__file__), str(tmp_path)])))
    assert said.returncode == 1 and "put it below" in said.stderr, said.stderr


def test_a_script_needs_no_guard(tmp_path):
    (tmp_path / "script.py").write_text(textwrap.dedent("""
        import numpy as np, rigor
        class World:
            def __init__(self, scene): self.rows, self.g = scene.state(), scene.gravity
            def step(self, dt): self.rows[:, 7:10] += dt * self.g; self.rows[:, :3] += dt * self.rows[:, 7:10]
            def read(self): return self.rows
        class Mine(rigor.Engine):
            def load(self, scene, settings): return World(scene)
        for in_process in (False, True):
            print(len(rigor.trace("ballistic/free-fall", engine=Mine, dt="1/30", duration=1, in_process=in_process)))
    """))
    said = subprocess.run([sys.executable, "script.py"], capture_output=True, text=True, cwd=tmp_path, timeout=120)
    assert said.stdout == "31\n31\n", said.stderr


def test_the_server_takes_a_module_and_a_class():
    words = f"env PYTHONPATH={os.environ['PYTHONPATH']}:{pathlib.Path(__file__).parent} {sys.executable} -m rigor.serve free_bodies:FreeBodies"
    assert len(rigor.trace("ballistic/free-fall", engine="numpy", plugins=words, dt="1/30", duration=1)) == 31
    with pytest.raises(rigor.InputError):
        rigor.trace("ballistic/free-fall", engine="numpy", plugins=words.replace("FreeBodies", "Nothing"), dt="1/30")


def test_two_engines_in_process_run_side_by_side(fall):
    class One(FreeBodies):
        name = "one"

    class Two(FreeBodies):
        name = "two"

        def load(self, scene, settings):
            world = FreeWorld(scene)
            world.gravity = 2 * world.gravity
            return world

    results = rigor.gate(fall, engines=[One, Two], in_process=True, dt="1/50", progress=False)
    one, two = (float(cell.metric("position_error")) for cell in results.cells)
    assert one == pytest.approx(0.1, abs=1e-9) and two > 5  # g t dt / 2, and g t^2 / 2 more


def test_two_threads_on_one_world_are_an_error():
    """The library of an engine in process, called by two threads at a time, as no host of ours does."""
    import ctypes
    import threading

    from rigor.engines import Plugins

    class Slow(FreeBodies):
        name = "slow"

        def load(self, scene, settings):
            import time
            world = FreeWorld(scene)
            world.step = lambda dt, wrenches=None: time.sleep(0.5)
            return world

    plugins = Plugins(Slow, in_process=True)
    library = ctypes.CDLL(plugins.words()[1])

    class Text(ctypes.Structure):
        _fields_ = [("data", ctypes.c_char_p), ("room", ctypes.c_size_t)]

    pointer = ctypes.c_void_p
    info_t, load_t = ctypes.CFUNCTYPE(ctypes.c_int32, Text), ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_char_p, ctypes.c_char_p, ctypes.POINTER(pointer), Text)
    step_t = ctypes.CFUNCTYPE(ctypes.c_int32, pointer, ctypes.c_double, pointer, Text)

    class Table(ctypes.Structure):
        _fields_ = [("struct_size", ctypes.c_size_t), ("info", info_t), ("load", load_t), ("step", step_t)]

    library.rigor_engine_entry.restype = ctypes.POINTER(Table)
    table = library.rigor_engine_entry(1).contents
    assert not library.rigor_engine_entry(2)
    path = list(sys.path)
    buffers = [ctypes.create_string_buffer(65536) for _ in range(3)]
    texts = [Text(ctypes.cast(buffer, ctypes.c_char_p), 65536) for buffer in buffers]
    import json
    world = pointer()
    scene = json.dumps(rigor.load("ballistic/free-fall").scene.rows).encode()
    assert table.load(scene, b'{"method":"euler","track":"matched","options":{}}', ctypes.byref(world), texts[0]) == 0, buffers[0].value
    answers = [None, None]

    def call(k):
        answers[k] = table.step(world, 0.1, None, texts[k + 1])

    threads = [threading.Thread(target=call, args=(k,)) for k in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    sys.path[:] = path
    assert sorted(answers) == [0, 3]
    assert b"two threads call one world" in buffers[1 + answers.index(3)].value


def test_two_threads_of_a_server_are_an_error():
    import threading

    from rigor._guard import Fault, GuardedWorld, ServedWorld
    scene = rigor.load("ballistic/free-fall").scene
    inside, go = threading.Event(), threading.Event()

    class Waits(FreeWorld):
        def step(self, dt, wrenches=None):
            inside.set()
            go.wait(10)

    world = ServedWorld(GuardedWorld("Waits", Waits(scene), scene, {}, False))
    thread = threading.Thread(target=world.step, args=(0.1,))
    thread.start()
    inside.wait(10)
    with pytest.raises(Fault, match="two threads"):
        world.read()
    go.set()
    thread.join()
    assert world.read().shape == (1, 13)
