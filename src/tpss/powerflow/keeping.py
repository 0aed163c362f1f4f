"""What a load flow has written, kept to be brought back."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from tpss.powerflow.network import Flow, Loads


def keep_all(flow: Flow, loads: Loads) -> list[np.ndarray]:
    """Copies of all that a load flow writes."""
    return [part.copy() for part in _parts((flow, loads.trains))]


def bring_back(kept: list[np.ndarray], flow: Flow, loads: Loads) -> None:
    """Write what was kept into its places."""
    for part, before in zip(_parts((flow, loads.trains)), kept, strict=True):
        part[...] = before


def _parts(of: Any) -> Iterator[np.ndarray]:
    """All arrays of nested tuples, in their order."""
    if isinstance(of, np.ndarray):
        yield of
    elif isinstance(of, tuple):
        for part in of:
            yield from _parts(part)
