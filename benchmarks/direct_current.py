"""Random lines of direct current with braking trains: how many are solved from a cold start.

    python benchmarks/direct_current.py --lines 3000 --seed 1

Each line is solved by the load flow, which knows nothing of it before.  A solution counts if the
equations of a slow twin hold there, and if all eigenvalues of the twin's Jacobian are positive.  Where
none is found, the twin looks for one: by Newton's method over all voltages, with a pseudo-transient.
"""

import argparse
import time
from collections import Counter
from collections.abc import Iterator
from typing import Any

import numpy as np

from tpss.powerflow.solve import solve

from direct_lines import Braking, Drawing, diode, direct_line

NOMINAL_V, U1_V, U2_V = 1500.0, 1755.0, 1800.0
OHM_PER_KM = 0.05
CLOSE_A = 1e-2
"""Largest current that a solution may leave unbalanced. [A]"""


def random_line(draw: np.random.Generator) -> tuple[list[Any], list[Braking | Drawing]]:
    """One to four diode stations on 4 to 20 km, and one to ten trains, half of them braking."""
    length = draw.uniform(4.0, 20.0)
    places = np.sort(draw.uniform(0.0, length, draw.integers(1, 5)))
    stations = [(float(km), diode(draw.uniform(1600.0, 1700.0), draw.uniform(0.03, 0.12)))
                for km in places]  # fmt: skip
    trains: list[Braking | Drawing] = []
    for km in np.sort(draw.uniform(0.0, length, draw.integers(1, 11))):
        if draw.random() < 0.5:
            trains.append(Braking(float(km), draw.uniform(2e5, 3e6), U1_V, U2_V, 1e5))
        else:
            trains.append(Drawing(float(km), draw.uniform(1e5, 1.5e6)))
    return stations, trains


class Twin:
    """The line as equations of real currents at its points, in their order."""

    def __init__(self, stations: list[Any], trains: list[Braking | Drawing]) -> None:
        self.points = sorted([(km, law) for km, law in stations] + [(t.km, t) for t in trains],
                             key=lambda each: each[0])  # fmt: skip
        kms = np.array([km for km, _ in self.points])
        pieces = 1.0 / (OHM_PER_KM * np.maximum(np.diff(kms), 1e-3))
        n = len(kms)
        self.conductance = np.zeros((n, n))
        for k, g in enumerate(pieces):
            self.conductance[k : k + 2, k : k + 2] += g * np.array([[1.0, -1.0], [-1.0, 1.0]])

    def drawn(self, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Currents that are drawn at the points, and their slopes."""
        current, slope = np.empty(len(u)), np.empty(len(u))
        for k, (_, what) in enumerate(self.points):
            current[k], slope[k] = _drawn(what, u[k])
        return current, slope

    def unbalanced(self, u: np.ndarray) -> np.ndarray:
        return self.conductance @ u + self.drawn(u)[0]

    def is_stable(self, u: np.ndarray) -> bool:
        jacobian = self.conductance + np.diag(self.drawn(u)[1])
        return bool(np.linalg.eigvalsh(jacobian).min() > 0.0)

    def solve(self, start_v: float) -> np.ndarray | None:
        """A stable solution in the band by a pseudo-transient from one voltage everywhere, or None."""
        u, tau = np.full(len(self.points), start_v), 1.0
        size = np.abs(self.unbalanced(u)).max()
        for _ in range(400):
            slope = self.drawn(u)[1]
            step = np.linalg.solve(
                self.conductance + np.diag(slope + 1.0 / tau), -self.unbalanced(u)
            )
            u = u + np.clip(step, -60.0, 60.0)
            now = np.abs(self.unbalanced(u)).max()
            tau *= min(2.0, max(0.3, size / now)) if now > 0.0 else 2.0
            size = now
            if now < 1e-6:
                inside = u.min() > 0.5 * NOMINAL_V and u.max() < 1.35 * NOMINAL_V
                return u if inside and self.is_stable(u) else None
            if not np.isfinite(now):
                return None
        return None


def _drawn(what: Any, u: float) -> tuple[float, float]:
    """Current that a station, negative, or a train draws, and its slope."""
    if isinstance(what, Drawing):
        return what.power_w / u, -what.power_w / u**2
    if isinstance(what, Braking):
        share = float(np.clip((what.none_v - u) / (what.none_v - what.whole_v), 0.0, 1.0))
        inside = what.whole_v < u < what.none_v
        slope = what.offered_w / (what.none_v - what.whole_v) if inside else 0.0
        current = (what.auxiliary_w - share * what.offered_w) / u
        return current, slope / u - current / u
    (_, u0), (i1, u1) = zip(what["current_a"][:2], what["voltage_v"][:2], strict=True)
    g = i1 / (u0 - u1)
    return (-(u0 - u) * g, g) if u < u0 else (0.0, 0.0)


def lines(count: int, seed: int) -> Iterator[tuple[list[Any], list[Braking | Drawing]]]:
    draw = np.random.default_rng(seed)
    for _ in range(count):
        yield random_line(draw)


def judge(stations: list[Any], trains: list[Braking | Drawing]) -> tuple[str, int]:
    """How the load flow ended, held against the twin, and its passes."""
    case = direct_line(NOMINAL_V, OHM_PER_KM, stations, trains)
    share, passes = solve(False, case.network, case.flow, case.loads)
    twin = Twin(stations, trains)
    if share < 1.0:
        starts = (twin.solve(v) for v in (1650.0, 1500.0, 1760.0, 1300.0, 1790.0))
        return ("missed" if any(each is not None for each in starts) else "no solution"), passes
    order = case.flow.standing.train
    of_train = dict(zip(order.tolist(), case.train_voltage.real, strict=True))
    station_v = case.flow.nodes[case.network.sources.node].voltage_v.real
    found = sorted(
        [(km, v) for (km, _), v in zip(stations, station_v, strict=True)]
        + [(train.km, of_train[k]) for k, train in enumerate(trains)]
    )
    u = np.array([v for _, v in found])
    holds = np.abs(twin.unbalanced(u)).max() < CLOSE_A
    blocked = all(v >= law["voltage_v"][0] for (_, law), v in zip(stations, station_v, strict=True))
    if not holds or not twin.is_stable(u):
        return "false", passes
    return ("solved, all blocked" if blocked else "solved"), passes


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--lines", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    ends: Counter[str] = Counter()
    passes, began = [], time.perf_counter()
    for k, line in enumerate(lines(given.lines, given.seed)):
        end, count = judge(*line)
        ends[end] += 1
        passes.append(count)
        if end in ("missed", "false"):
            print(f"line {k} of seed {given.seed}: {end}")
    print(
        dict(ends), f"passes: median {np.median(passes):.0f}, 99 % {np.percentile(passes, 99):.0f}"
    )
    print(f"{time.perf_counter() - began:.1f} s")


if __name__ == "__main__":
    main()
