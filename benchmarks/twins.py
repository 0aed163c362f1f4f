"""How far gradient profiles of the same statistics differ in what they lead to.

Usage: python benchmarks/twins.py STUDY OUT.parquet [--form FORM] [--cases N] [--profiles N]

Cases of a study are simulated again, each with other profiles of the same statistics: of the same mean
and standard deviation, or with ``--form profile`` of the same starting gradient, trend and middle too.
What differs between them no approximator can know that is told these: the noise floor.
"""

import argparse
from collections.abc import Iterator
from itertools import count, islice
from pathlib import Path

import numpy as np
import pandas as pd

import tpss
from tpss.sweep.columns import output_columns
from tpss.sweep.derive import scenario_with
from tpss.sweep.design import PROFILE, Design, design_of
from tpss.sweep.folder import read_manifest
from tpss.sweep.gradients import Array, gradient_profile, weights_of
from tpss.sweep.study import study_of_json

FIRST_PROFILE = 1_000_000
"""Profiles are drawn from numbers from here on; those of the study's cases are the cases' numbers."""


def twins(study: Path, form: str, cases: int, profiles: int) -> pd.DataFrame:
    """Figures of cases of a study with other gradient profiles, a row a case and profile."""
    design = design_of(study_of_json(read_manifest(study)["study"]))
    # By chance: every sixteenth point of a Sobol sequence would lie in one corner of the space.
    chosen = np.random.default_rng(0).choice(design.cases, cases, replace=False).tolist()
    pairs: list[tuple[int, int]] = []

    def scenarios() -> Iterator[tpss.Scenario]:
        for case in chosen:
            for number, scenario in islice(others(design, form, case, profiles), profiles):
                pairs.append((case, number))
                yield scenario

    rows = []
    for figures in tpss.simulate_many(scenarios()):
        case, number = pairs[len(rows)]
        rows.append({"case": case, "profile": number, **output_columns(figures)})
        if len(rows) % 100 == 0:
            print(f"{len(rows):,} of {cases * profiles:,} simulated", flush=True)
    return pd.DataFrame(rows)


def others(
    design: Design, form: str, case: int, profiles: int
) -> Iterator[tuple[int, tpss.Scenario]]:
    """Numbers of other profiles that a case may have, and its scenario with each."""
    values = design.values(case)
    for number in count(FIRST_PROFILE + case * profiles):
        other = scenario_with(design, {**values, PROFILE: number}, case)
        if form == "aggregated":
            yield number, other
        elif (same := matched(other, scenario_with(design, values, case), design)) is not None:
            yield number, same


def matched(other: tpss.Scenario, own: tpss.Scenario, design: Design) -> tpss.Scenario | None:
    """The scenario with its profile bent until all statistics are those of the case's own one.

    Of a line with stations at its ends, and a train that runs all of it.
    """
    edges_km, drawn = gradient_profile(other.line)
    permille = bent(drawn, gradient_profile(own.line)[1], edges_km, correlation_km(design))
    if permille is None:
        return None
    pieces = zip(edges_km[:-1].tolist(), permille.tolist(), strict=True)
    return other.with_({"line.gradients": [{"from_km": km, "permille": g} for km, g in pieces]})


def correlation_km(design: Design) -> float:
    """Way over which gradients of the study's profiles are correlated."""
    return design.study.file.gradients.correlation_km


def bent(drawn: Array, own: Array, edges_km: Array, range_km: float) -> Array | None:
    """A drawn profile with the weighted means of another one, and its standard deviation.

    The means are reached as kriging does: by the smallest change that the correlation of the gradients
    allows.  What is left free is stretched until the standard deviation is right; None if the means
    alone ask for more.
    """
    means = np.column_stack(weights_of(edges_km, 0.0, edges_km[-1], (0.0, edges_km[-1])))
    middle_km = (edges_km[:-1] + edges_km[1:]) / 2.0
    covariance = np.exp(-np.abs(middle_km[:, None] - middle_km) / range_km)
    gain = covariance @ means @ np.linalg.inv(means.T @ covariance @ means)
    given = gain @ (means.T @ own)
    free = drawn - gain @ (means.T @ drawn)
    share = means[:, 0]
    mean, square = share @ own, share @ own**2
    # share @ (given + stretch · free)² is that of the own profile; free adds nothing to the mean.
    a, b, c = share @ free**2, share @ (free * (given - mean)), share @ given**2 - square
    if b * b < a * c:
        return None
    return given + (np.sqrt(b * b - a * c) - b) / a * free


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("study", type=Path, help="folder that tpss sweep has written")
    parser.add_argument("out", type=Path, help="table to write (.parquet)")
    parser.add_argument("--form", choices=("aggregated", "profile"), default="aggregated")
    parser.add_argument("--cases", type=int, default=320)
    parser.add_argument("--profiles", type=int, default=4)
    given = parser.parse_args()
    twins(given.study, given.form, given.cases, given.profiles).to_parquet(given.out, index=False)
