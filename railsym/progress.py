# SPDX-License-Identifier: BSD-3-Clause
"""Progress of long work on the terminal."""


def followed(items, total: int, what: str, show: bool):
    """Iterate over items, with a progress bar on the error stream when asked for."""
    if not show:
        return items
    from tqdm import tqdm
    return tqdm(items, total=total, desc=what, unit="case")
