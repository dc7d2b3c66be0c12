#!/usr/bin/python3
"""On a processor that lacks what the program was built for it says so in one sentence, and ends with 1; on the oldest one of
its level it runs. The processors are QEMU's.

  old_processors_test.py PROGRAM LEVEL

Exit 0: so it is, 1: not so, 77: QEMU is not here, or cannot be the processor of LEVEL (skipped)."""
import shutil
import subprocess
import sys

SKIP = 77
# For each level: processors that lack something of it, and one that has just that. QEMU has no AVX-512.
PROCESSORS = {"x86-64-v2": (["core2duo"], "Nehalem"), "x86-64-v3": (["core2duo", "Nehalem", "SandyBridge"], "Haswell"),
              "x86-64-v4": (["core2duo", "Nehalem", "Haswell"], None)}


def run(qemu, processor, program):
    done = subprocess.run([qemu, "-cpu", processor, program, "--version"], capture_output=True, text=True, timeout=100)
    # QEMU's own remarks on what it leaves out of a processor.
    errors = [line for line in done.stderr.splitlines() if not line.startswith("qemu-x86_64: warning:")]
    return done.returncode, done.stdout, errors


def main(program, level):
    qemu = shutil.which("qemu-x86_64")
    if qemu is None or level not in PROCESSORS:
        print("skipped:", "no qemu-x86_64 here" if qemu is None else f"QEMU has no processor that is just {level}")
        return SKIP
    refused, accepted = PROCESSORS[level]
    good = True
    for processor in refused:
        status, out, errors = run(qemu, processor, program)
        said = len(errors) == 1 and "processor lacks" in errors[0] and level in errors[0]
        print(processor, status, out, *errors)
        good = good and status == 1 and out == "" and said
    if accepted:
        status, out, errors = run(qemu, accepted, program)
        print(accepted, status, out, *errors)
        good = good and status == 0 and out.startswith("Lightwalk") and not errors
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
