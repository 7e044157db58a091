# SPDX-License-Identifier: BSD-3-Clause
"""python3 -m slabhull: the program `slabhull`, with its arguments, output and exit codes."""
import os
import sys

from .program import find_program


def main():
    program = find_program()
    sys.stdout.flush()
    os.execv(program, [program, *sys.argv[1:]])


if __name__ == "__main__":
    main()
