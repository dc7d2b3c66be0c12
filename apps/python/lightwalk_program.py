"""The program `lightwalk`, beside the package: to import that would take longer than to start the program."""

import importlib.util
import os
import sys


def main() -> None:
    """Becomes the program that the package holds."""
    found = importlib.util.find_spec("lightwalk")
    if found is None or found.origin is None:
        sys.exit("lightwalk: the Python package lightwalk is not installed")
    os.execv(os.path.join(os.path.dirname(found.origin), "bin", "lightwalk"), ["lightwalk", *sys.argv[1:]])
