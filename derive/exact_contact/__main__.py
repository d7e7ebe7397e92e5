# SPDX-License-Identifier: BSD-3-Clause
"""``python -m derive.exact_contact``: solve the sample contacts, fit and write the table of the law "exact"."""

import argparse
import sys
import time
from pathlib import Path

import numpy as np

from derive.exact_contact import samples, table


def main(arguments=None):
    """Command line; returns the exit status."""
    parser = argparse.ArgumentParser(prog="python -m derive.exact_contact", description=__doc__)
    parser.add_argument("--samples", type=Path, default=Path("build/exact_contact"), help="folder of solved samples: those there are not solved again")
    parser.add_argument("--output", type=Path, default=table.FILE, help="file to write (default: the shipped table)")
    options = parser.parse_args(arguments)
    options.samples.mkdir(parents=True, exist_ok=True)
    start = time.process_time()
    forces = [_solved(options.samples, ratio) for ratio in _progress(samples.ratios(), "solve")]
    print(f"solved {sum(map(len, forces))} contacts: {time.process_time() - start:.0f} s CPU")
    start = time.process_time()
    table.write(table.fitted(_progress(forces, "fit")), options.output)
    print(f"fitted: {time.process_time() - start:.0f} s CPU; wrote {options.output} ({options.output.stat().st_size / 1e3:.0f} kB)")
    return 0


def _progress(of, word):
    from tqdm import tqdm

    return tqdm(of, word, unit="a/b", file=sys.stderr)


def _solved(folder, ratio):
    """Forces of one a/b, from the folder where they match these samples."""
    path, (points, _) = folder / f"{ratio:.4f}.npz", samples.points(ratio)
    if path.exists():
        with np.load(path) as kept:
            if np.array_equal(kept["points"], points):
                return kept["forces"]
    found = samples.solved(ratio)
    np.savez(path, points=points, forces=found)
    return found


if __name__ == "__main__":
    sys.exit(main())
