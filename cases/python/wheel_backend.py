"""Makes the wheel of the package: ``pip install cases/python``. These are the hooks of PEP 517, and they need nothing from PyPI.

They compile nothing: CMake installs the component ``wheel`` of the build that ``cases/setup release python`` has made, and this file
packs it. ``--config-settings build-dir=FOLDER`` takes another build.
"""
from __future__ import annotations

import base64
import hashlib
import pathlib
import re
import subprocess
import sys
import sysconfig
import tempfile
import typing
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
Settings = typing.Optional[typing.Mapping[str, typing.Any]]


class UnsupportedOperation(Exception):
    """A hook that this package has not."""


def _version() -> str:
    found = re.search(r"^project\(\w+ VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"), re.MULTILINE)
    if found is None:
        raise RuntimeError(f"{ROOT}/CMakeLists.txt states no version; build the wheel from a checkout of Rigor")
    return found[1]


def _built(settings: Settings) -> pathlib.Path:
    """The folder of a build for this Python."""
    folder = pathlib.Path((settings or {}).get("build-dir") or ROOT / "build" / "release").resolve()
    native = folder / "python" / "rigor" / f"_native{sysconfig.get_config_var('EXT_SUFFIX')}"
    if not native.is_file():
        raise RuntimeError(f"{native} is not there: '{folder}' is no build of the package for this Python; run cases/setup release python before")
    return folder


def _metadata() -> dict[str, bytes]:
    """The files of the folder .dist-info, but for WHEEL and RECORD."""
    text = (HERE / "METADATA.in").read_text(encoding="utf-8").replace("@PROJECT_VERSION@", _version())
    return {"METADATA": text.encode(), "entry_points.txt": (HERE / "entry_points.txt").read_bytes(), "LICENSE": (ROOT / "LICENSE").read_bytes()}


def _tag() -> str:
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{re.sub('[-.]', '_', sysconfig.get_platform())}"


def _packed(archive: zipfile.ZipFile, name: str, data: bytes, mode: int) -> str:
    """Adds a file, with the same date in each wheel. Returns its row of RECORD."""
    entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
    entry.external_attr, entry.compress_type = (0o100000 | mode) << 16, zipfile.ZIP_DEFLATED
    archive.writestr(entry, data)
    digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(data)}\n"


def prepare_metadata_for_build_wheel(metadata_directory: str, config_settings: Settings = None) -> str:
    """Writes what pip asks for before the build. Returns the folder's name."""
    folder = pathlib.Path(metadata_directory) / f"rigor-{_version()}.dist-info"
    folder.mkdir(parents=True)
    for name, data in _metadata().items():
        (folder / name).write_bytes(data)
    return folder.name


def build_wheel(wheel_directory: str, config_settings: Settings = None, metadata_directory: str | None = None) -> str:
    """Installs and packs. Returns the wheel's name."""
    build, info = _built(config_settings), f"rigor-{_version()}.dist-info"
    name = f"rigor-{_version()}-{_tag()}.whl"
    with tempfile.TemporaryDirectory(prefix="rigor-wheel-") as tree, zipfile.ZipFile(pathlib.Path(wheel_directory) / name, "w") as archive:
        subprocess.run(["cmake", "--install", str(build), "--component", "wheel", "--prefix", tree], check=True)
        record = ""
        for path in sorted(path for path in pathlib.Path(tree).rglob("*") if path.is_file()):
            record += _packed(archive, path.relative_to(tree).as_posix(), path.read_bytes(), path.stat().st_mode & 0o777)
        about = f"Wheel-Version: 1.0\nGenerator: rigor {_version()}\nRoot-Is-Purelib: false\nTag: {_tag()}\n"
        for file, data in {**_metadata(), "WHEEL": about.encode()}.items():
            record += _packed(archive, f"{info}/{file}", data, 0o644)
        _packed(archive, f"{info}/RECORD", f"{record}{info}/RECORD,,\n".encode(), 0o644)
    return name


def build_sdist(sdist_directory: str, config_settings: Settings = None) -> str:
    """There is no archive of sources: the wheel is built from a checkout of Rigor."""
    raise UnsupportedOperation("the wheel of rigor is built from a checkout of Rigor, and not from an archive of this folder")
