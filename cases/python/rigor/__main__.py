"""``python3 -m rigor …`` is the command line of the program."""
import os
import sys

from .errors import RigorError
from .program import program

try:
    _path = program()
except RigorError as error:
    sys.exit(f"rigor: {error}")
os.execv(_path, [_path, *sys.argv[1:]])
