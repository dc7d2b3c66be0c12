"""The program: `lightwalk`, `python -m lightwalk`."""

import os
import sys


def main() -> None:
    """Becomes the program that the package holds."""
    program = os.path.join(os.path.dirname(os.path.abspath(__file__)), "bin", "lightwalk")
    os.execv(program, ["lightwalk", *sys.argv[1:]])


if __name__ == "__main__":
    main()
