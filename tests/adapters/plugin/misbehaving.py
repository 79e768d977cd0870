# A plug-in that does one thing wrong, at the third step or where its first argument says.
import json
import os
import sys
import time

mode = sys.argv[1]
INFO = {"ok": True, "name": "bad", "version": "1", "precision": "double", "features": ["fixed-body"],
        "methods": [{"name": "euler", "order": 1}]}


def say(x):
    print(x if isinstance(x, str) else json.dumps(x), flush=True)


def flood():
    while True:
        sys.stdout.write("x" * 65536)


def spin():
    while True:
        pass


def not_utf8():
    sys.stdout.buffer.write(b'{"ok":true,"x":"\xff\xfe\x1b[31m"}\n')
    sys.stdout.flush()


def die():
    sys.stderr.write("fatal: out of cheese\n")
    os._exit(7)


def twice():
    say({"ok": True})
    say({"ok": True})


IN_INFO = {
    "info-ends": lambda: sys.exit(3), "info-hangs": lambda: time.sleep(1000), "info-garbage": lambda: say("hello, \x1b[31mworld"),
    "info-precision": lambda: say({**INFO, "precision": "quad"}), "info-clash": lambda: say({**INFO, "name": "core"}),
    "info-methods": lambda: say({k: v for k, v in INFO.items() if k != "methods"}),
    "info-version": lambda: say({**INFO, "rigor": 2}), "info-name": lambda: say({**INFO, "name": "a b:c"}),
    "info-order": lambda: say({**INFO, "methods": [{"name": "euler", "order": "high"}]}),
    "info-refused": lambda: say({"ok": False, "status": "failed", "why": "no licence"}),
    "info-columns": lambda: say({**INFO, "columns": "f32be"}),
}
IN_LOAD = {
    "load-unsupported": lambda: say({"ok": False, "status": "unsupported", "why": "no such thing"}),
    "load-failed": lambda: say({"ok": False, "status": "failed", "why": "lost it"}),
}
IN_STEP = {
    "dies": die, "segfaults": lambda: os.kill(os.getpid(), 11), "hangs": lambda: time.sleep(1000), "spins": spin, "floods": flood,
    "gigabyte": lambda: [sys.stdout.write("x" * 65536) for _ in range(1 << 14)], "not-utf8": not_utf8,
    "text": lambda: say("Warning: \x1b[31mdt too large"), "twice": twice, "empty": lambda: say(""), "list": lambda: say("[1,2]"),
    "no-ok": lambda: say({"fine": True}), "other-world": lambda: say({"ok": True, "world": 77}),
    "other-call": lambda: say({"ok": True, "call": "read"}), "out-of-order": lambda: say({"ok": True, "call": "unload"}),
    "diverges": lambda: say({"ok": False, "status": "diverged", "why": "too fast", "time": 0.3, "body": 0}),
    "fails": lambda: say({"ok": False, "status": "failed", "why": "lost it"}),
    "sad": lambda: say({"ok": False, "status": "sad"}), "closes": lambda: (os.close(1), time.sleep(1000)),
    "memory": lambda: bytearray(5 << 30),
}
NAN = float("nan")
IN_READ = {
    "nan": lambda rows: [[NAN] + rows[0][1:]], "null": lambda rows: [[None] + rows[0][1:]],
    "string": lambda rows: [["0"] + rows[0][1:]], "few": lambda rows: rows[1:], "many": lambda rows: rows * 2,
    "short": lambda rows: [row[:12] for row in rows], "huge": lambda rows: [[10 ** 400] + rows[0][1:]], "no-rows": lambda rows: {},
}

steps, now, count = 0, 0.0, 0
for line in sys.stdin:
    ask = json.loads(line)
    call = ask["call"]
    if call == "info":
        IN_INFO.get(mode, lambda: say(INFO))()
        continue
    if call == "load":
        now, count = 0.0, len(ask["scene"]["body"])
        IN_LOAD.get(mode, lambda: say({"ok": True}))()
        continue
    if call == "step":
        steps, now = steps + 1, now + ask["dt"]
        (IN_STEP.get(mode) if steps == 3 and mode in IN_STEP else lambda: say({"ok": True}))()
        continue
    if call == "read":
        rows = [[0.0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0] for _ in range(count)]
        if steps >= 3:
            rows = IN_READ.get(mode, lambda rows: rows)(rows)
        late = ask and steps >= 3 and mode == "late"
        say({"ok": True, "time": now - (0.1 if late else 0), "bodies": rows})
        continue
    say({"ok": True})
