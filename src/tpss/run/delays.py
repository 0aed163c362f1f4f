"""Delays of departures: some of the trains of a service, each by its own time."""

import hashlib
import math
from typing import NamedTuple

BITS = 53
"""Of a digest that make a number: as many as a number holds."""


class Delays(NamedTuple):
    """A share of the trains departs later than scheduled, by exponentially distributed times."""

    mean_s: float
    """Mean delay of those trains. [s]"""
    share: float
    """Their share of all. [1]"""
    seed: int

    def of(self, train: str) -> float:
        """Delay of a train. [s]

        A digest of seed and name draws it, so that other trains do not change it: an evenly distributed
        number u from 0 to 1, which delays the train if it is below the share s, by -m ln(1 - u/s).
        """
        digest = hashlib.sha256(f"{self.seed} {train}".encode()).digest()
        drawn = (int.from_bytes(digest[:8], "big") >> (64 - BITS)) / 2.0**BITS
        return -self.mean_s * math.log1p(-drawn / self.share) if drawn < self.share else 0.0
