# SPDX-License-Identifier: BSD-3-Clause
"""``python -m derive [--check]``: write csrc/generated/, or prove that it is up to date."""

import argparse
import pathlib
import sys
import time

from derive import bodies, elements, emit, wheel_rail

HERE = pathlib.Path(__file__).resolve().parent
TARGET = HERE.parent / "csrc" / "generated"


def kernels():
    """Every kernel, in the order of their numbers in C."""
    return [
        bodies.rigid_body(),
        bodies.wheelset(axleboxes=False),
        bodies.wheelset(axleboxes=True),
        elements.bushing(),
        elements.line(),
        elements.axis(),
        wheel_rail.wheel_rail(),
    ]


def generated_files():
    """File name -> text of everything in csrc/generated/."""
    digest = emit.digest_of(sorted(HERE.glob("*.py")))
    derived = kernels()
    files = {f"{k.tape.name}.h": emit.kernel_file(k, digest) for k in derived}
    files["kernels.h"] = emit.descriptor_file(derived, digest)
    return files


def write(files):
    """Write the files and remove what no longer belongs there."""
    TARGET.mkdir(parents=True, exist_ok=True)
    for stale in set(p.name for p in TARGET.iterdir()) - set(files):
        (TARGET / stale).unlink()
    for name, text in files.items():
        (TARGET / name).write_text(text, encoding="ascii", newline="\n")


def differences(files):
    """Names whose committed bytes differ from ``files``, are missing, or are left over."""
    present = {p.name: p.read_bytes() for p in TARGET.iterdir()} if TARGET.exists() else {}
    fresh = {name: text.encode("ascii") for name, text in files.items()}
    return sorted(n for n in present.keys() | fresh.keys() if present.get(n) != fresh.get(n))


def main(arguments=None):
    """Command line; returns the exit status."""
    parser = argparse.ArgumentParser(prog="python -m derive", description=__doc__)
    parser.add_argument("--check", action="store_true", help="compare with csrc/generated/, write nothing")
    options = parser.parse_args(arguments)
    start = time.process_time()
    files = generated_files()
    lines = sum(text.count("\n") for text in files.values())
    print(f"derived {len(files) - 1} kernels, {lines} lines of C, {time.process_time() - start:.1f} s CPU")
    if not options.check:
        write(files)
        print(f"wrote {TARGET.relative_to(HERE.parent)}")
        return 0
    wrong = differences(files)
    for name in wrong:
        print(f"csrc/generated/{name} differs from a fresh derivation: run `python -m derive` and commit")
    if not wrong:
        print("csrc/generated is reproduced byte for byte")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
