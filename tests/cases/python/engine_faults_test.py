"""Each way in which an engine can go wrong, in a process of its own and inside the cell's: one sentence, and never a verdict of it."""
import dataclasses
import os
import pathlib
import re
import time

import pytest
from conftest import FALL
from free_bodies import FreeBodies, broken

import rigor

BOTH = pytest.mark.parametrize("in_process", [False, True], ids=["own-process", "in-process"])


@dataclasses.dataclass
class Fault:
    method: str
    body: str
    status: str
    words: str


FREED = """
    import ctypes
    libc = ctypes.CDLL(None)
    libc.mmap.restype = ctypes.c_void_p
    at = libc.mmap(None, 4096, 3, 34, -1, 0)
    view = np.ctypeslib.as_array((ctypes.c_double * 26).from_address(at)).reshape(2, 13)
    libc.munmap(ctypes.c_void_p(at), 4096)
    return view
"""
MUTE = """
    class Mute(Exception):
        def __str__(self):
            return 1 / 0
    raise Mute
"""
ODD_EXIT = """
    class Odd:
        def __repr__(self):
            raise ValueError
    sys.exit(Odd())
"""
FAULTS = {
    "wrong shape": Fault("read", "return self.rows[:, :12]", "crashed", r"shape \(2, 12\); an array of shape \(2, 13\) is due"),
    "forgets a body": Fault("read", "return self.rows[:0]", "crashed", r"shape \(0, 13\)"),
    "transposed": Fault("read", "return self.rows.T", "crashed", r"shape \(13, 2\)"),
    "flat": Fault("read", "return self.rows.ravel()", "crashed", r"shape \(26,\)"),
    "None": Fault("read", "return None", "crashed", "returned None; an array of shape"),
    "text": Fault("read", "return 'state'", "crashed", "returned a str"),
    "complex": Fault("read", "return self.rows.astype(complex)", "crashed", "dtype complex128; float64 is due"),
    "truth values": Fault("read", "return self.rows > 0", "crashed", "dtype bool"),
    "objects": Fault("read", "return self.rows.astype(object)", "crashed", "dtype object"),
    "ragged": Fault("read", "return [[1, 2], [3]]", "crashed", "no array"),
    "masked": Fault("read", "return np.ma.masked_array(self.rows, mask=np.eye(2, 13))", "crashed", "masked numbers"),
    "a view into freed memory": Fault("read", FREED, "crashed", "killed by SIGSEGV"),
    "NaN": Fault("read", "rows = self.rows.copy(); rows[0, 2] = np.nan; return rows", "diverged", "is not finite"),
    "infinity": Fault("read", "rows = self.rows.copy(); rows[0, 8] = np.inf; return rows", "diverged", "is not finite"),
    "raises in read": Fault("read", "raise KeyError('lost')", "crashed", "KeyError: 'lost'"),
    "raises in step": Fault("step", "1 / 0", "crashed", "ZeroDivisionError: division by zero"),
    "raises two lines": Fault("step", "raise ValueError('one' + chr(10) + 'two')", "crashed", "ValueError: one.{1,4}two"),
    "raises without a text": Fault("step", MUTE, "crashed", "Mute: it has no text"),
    "recurses": Fault("step", "def again(): return again()\nagain()", "crashed", "RecursionError: "),
    "asks for all memory": Fault("step", "np.zeros(1 << 42)", "crashed", "MemoryError: "),
    "returns something from step": Fault("step", "return self.rows", "crashed", r"step\(\) returned a ndarray"),
    "exits": Fault("step", "sys.exit(3)", "crashed", r"called sys.exit\(3\)"),
    "exits well": Fault("step", "sys.exit()", "crashed", r"called sys.exit\(\)"),
    "exits oddly": Fault("step", ODD_EXIT, "crashed", r"called sys.exit\(it has no text\)"),
    "exits hard": Fault("step", "os._exit(0)", "crashed", r"exit(\(| code )0"),
    "kills itself": Fault("step", "os.kill(os.getpid(), 11)", "crashed", "SEGV"),
    "closes all files": Fault("step", "os.closerange(3, 1000)", "crashed", "Bad file descriptor|closed its"),
    "interrupts": Fault("step", "raise KeyboardInterrupt", "crashed", "KeyboardInterrupt"),
    "diverges": Fault("step", "raise rigor.DivergedError('too fast')", "diverged", "too fast"),
    "refuses a run that has begun": Fault("step", "raise rigor.UnsupportedError('no more')", "crashed invalid", "no more"),
}
# Each costs its whole limit of CPU time. The second holds Python's lock: no other thread of its process runs.
ENDLESS = {"hangs": Fault("step", "while True: pass", "timed-out", "limit of 8 s"),
           "holds the lock": Fault("step", "base = 9\nbase ** base ** base", "timed-out", "limit of 8 s")}


def cells_of(faults, in_process, timeout):
    """The cells of all faults, in one gate, which searches no largest step. A sound engine is between them."""
    case = rigor.Case.from_toml(FALL, name="fall")
    engines = [FreeBodies]
    for number, fault in enumerate(faults.values()):
        engines.append(broken(fault.method, fault.body))
        engines[-1].name = f"fault-{number}"
    results = rigor.gate(case, engines=engines, dt="1/50", in_process=in_process, timeout=timeout, progress=False)
    assert not results.passed
    cells = {cell.engine: cell for cell in results.cells}
    assert cells.pop("numpy").status == "pass"
    return {name: cells[f"fault-{number}"] for number, name in enumerate(faults)}


@pytest.fixture(scope="module", params=[False, True], ids=["own-process", "in-process"])
def faulty_cells(request):
    return cells_of(FAULTS, request.param, 60)


def check(cell, fault):
    assert cell.status in fault.status.split(), cell.reason
    assert re.search(fault.words, cell.reason), cell.reason
    assert "Traceback" not in cell.reason and "\n" not in cell.reason
    assert fault.status == "diverged" or not cell.metrics


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_costs_the_cell_and_has_one_sentence(faulty_cells, name):
    check(faulty_cells[name], FAULTS[name])


@BOTH
def test_an_engine_without_an_end_is_stopped(in_process):
    for name, cell in cells_of(ENDLESS, in_process, 8).items():
        check(cell, ENDLESS[name])


SOUND = {
    "forks": "os.fork()",
    "forks a copy that raises": "if os.fork() == 0: raise ValueError",
    "forks a copy that exits": "if os.fork() == 0: sys.exit(5)",
    "goes to another folder": "os.chdir('/')",
    "closes its streams": "sys.stdout.close(); sys.stderr.close()",
    # An engine's rounding is its own: Rigor's truth and metrics must not change with it.
    "rounds upwards": "import ctypes; ctypes.CDLL('libm.so.6').fesetround(0x800)",
}


def test_what_costs_nothing_gives_the_same_numbers_both_ways(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    case = rigor.Case.from_toml(FALL, name="fall")
    engines = []
    for number, body in enumerate(SOUND.values()):
        engines.append(broken("step", body))
        engines[-1].name = f"sound-{number}"
    own, inside = (rigor.gate(case, engines=[*engines, FreeBodies], dt="1/50", in_process=in_process, progress=False, out=f"out-{in_process}")
                   for in_process in (False, True))
    plain = own.cells[-1]
    for name, one, other in zip([*SOUND, "plain"], own.cells, inside.cells):
        assert one.status == other.status == "pass", f"{name}: {one.reason}{other.reason}"
        assert (one.trajectory().state() == other.trajectory().state()).all(), name
        for metric, value in one.metrics.items():
            is_time = metric == "cost" or "cpu" in metric
            assert is_time or value == other.metrics[metric] or value != value, f"{name}: {metric} is {value} and {float(other.metrics[metric])}"
        is_same = (one.trajectory().state() == plain.trajectory().state()).all()
        assert is_same == (name != "rounds upwards"), name


@BOTH
def test_a_copy_that_sleeps_ends_with_the_cell(in_process, tmp_path):
    note = tmp_path / "process"
    body = f"""
        import time
        if os.fork() == 0:
            with open({str(note)!r}, "w") as file:
                print(os.getpid(), file=file, flush=True)
            time.sleep(600)
        while not os.path.exists({str(note)!r}):
            time.sleep(0.01)
    """
    rigor.trace("ballistic/free-fall", engine=broken("step", body), dt="1/30", duration=1, in_process=in_process)
    process = pathlib.Path("/proc") / note.read_text().strip()
    for _ in range(200):
        if not process.exists() or "\nState:\tZ" in (process / "status").read_text():
            return
        time.sleep(0.05)
    os.kill(int(process.name), 9)
    raise AssertionError("the copy still runs")
