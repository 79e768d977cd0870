"""Writes a dict as a case file, and remembers where each value stands, so that messages can name its path."""
from __future__ import annotations

import math
import re
import typing

from .errors import InputError

_BARE = re.compile(r"[A-Za-z0-9_-]+")
_ESCAPES = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\t": "\\t", "\r": "\\r", "\b": "\\b", "\f": "\\f"}
_LEAST, _MOST = -(2**63), 2**63 - 1  # TOML's integers


def _quoted(text: str) -> str:
    return '"' + "".join(_ESCAPES.get(c, c if c >= " " and c != "\x7f" else f"\\u{ord(c):04x}") for c in text) + '"'


def _plain(value: typing.Any, path: str) -> typing.Any:
    """Numbers and arrays of numpy, tuples and paths as plain values. An array of rows becomes lists."""
    if hasattr(value, "tolist") and hasattr(value, "dtype"):
        if value.dtype.kind not in "biufUS":
            raise InputError(f"{path}: an array of dtype {value.dtype} is no value of a case; allowed: numbers, truth values, texts", path)
        value = value.tolist()
    return list(value) if isinstance(value, tuple) else value


class Writer:
    """The text of a case, and the paths of its values by line and column."""

    def __init__(self, root: typing.Mapping[str, typing.Any]):
        self._lines: list[str] = []
        self._places: dict[int, list[tuple[int, str]]] = {}  # line -> (column, path), from 1
        self._now = ""
        self._table(root, "", ())
        self._end()
        self.text = "\n".join(self._lines) + "\n"

    def path_at(self, line: int, column: int) -> str | None:
        """The path of the value that begins at this place or before it on its line."""
        found = None
        for start, path in self._places.get(line, []):
            if start <= column or found is None:
                found = path
        return found

    def _end(self) -> None:
        if self._now:
            self._lines.append(self._now)
        self._now = ""

    def _mark(self, path: str) -> None:
        self._places.setdefault(len(self._lines) + 1, []).append((len(self._now.encode()) + 1, path))

    def _key(self, key: typing.Any, path: str) -> str:
        if not isinstance(key, str):
            raise InputError(f"{path or 'case'}: the key {key!r} is a {type(key).__name__}; allowed: a text", path or None)
        return key if _BARE.fullmatch(key) else _quoted(key)

    def _table(self, table: typing.Mapping[str, typing.Any], path: str, names: tuple[str, ...]) -> None:
        later: list[tuple[str, str, typing.Any]] = []
        for key, value in table.items():
            name, at = self._key(key, path), f"{path}.{key}" if path else str(key)
            value = _plain(value, at)
            is_rows = isinstance(value, list) and value and all(isinstance(row, dict) for row in value)
            if value is None:
                continue  # as if the key were absent
            if len(names) < 1 and (isinstance(value, dict) or is_rows) or len(names) == 1 and is_rows:
                later.append((name, at, value))
                continue
            self._mark(at)
            self._now += f"{name} = "
            self._value(value, at)
            self._end()
        for name, at, value in later:
            header = ".".join((*names, name))
            if isinstance(value, dict):
                self._header(f"[{header}]", at)
                self._table(value, at, (*names, name))
            else:
                for number, row in enumerate(value):
                    self._header(f"[[{header}]]", f"{at}[{number}]")
                    self._table(row, f"{at}[{number}]", (*names, name, ""))

    def _header(self, text: str, path: str) -> None:
        self._mark(path)
        self._now = text
        self._end()

    def _value(self, value: typing.Any, path: str) -> None:
        value = _plain(value, path)
        self._mark(path)
        if isinstance(value, bool):
            self._now += "true" if value else "false"
        elif isinstance(value, int):
            if not _LEAST <= value <= _MOST:
                raise InputError(f"{path}: {value} is too large for an integer; write it as a float", path)
            self._now += str(value)
        elif isinstance(value, float):
            self._now += repr(value) if math.isfinite(value) else str(value)  # inf and nan are TOML; the reader refuses them
        elif isinstance(value, str):
            self._now += _quoted(value)
        elif isinstance(value, list):
            self._items("[", "]", [(f"{path}[{i}]", "", item) for i, item in enumerate(value)])
        elif isinstance(value, dict):
            items = [(f"{path}.{key}", f"{self._key(key, path)} = ", item) for key, item in value.items() if item is not None]
            self._items("{", "}", items)
        else:
            raise InputError(f"{path}: a {type(value).__name__} is no value of a case; allowed: numbers, truth values, texts, lists, dicts", path)

    def _items(self, begin: str, end: str, items: list[tuple[str, str, typing.Any]]) -> None:
        self._now += begin
        for number, (path, name, item) in enumerate(items):
            self._now += ", " if number else ""
            if name:
                self._mark(path)
            self._now += name
            self._value(item, path)
        self._now += end
