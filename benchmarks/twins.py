"""How far gradient profiles of the same mean and standard deviation differ in what they lead to.

Usage: python benchmarks/twins.py STUDY OUT.parquet [--cases N] [--profiles N]

Cases of a study are simulated again, each with other profiles that have the same mean and standard
deviation.  What differs between them no approximator can know that is told these two: the noise floor.
"""

import argparse
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd

import tpss
from tpss.sweep.columns import output_columns
from tpss.sweep.derive import scenario_with
from tpss.sweep.design import PROFILE, design_of
from tpss.sweep.folder import read_manifest
from tpss.sweep.study import study_of_json

FIRST_PROFILE = 1_000_000
"""Profiles are drawn from numbers from here on; those of the study's cases are the cases' numbers."""


def twins(study: Path, cases: int, profiles: int) -> pd.DataFrame:
    """Figures of cases of a study with other gradient profiles, a row a case and profile."""
    design = design_of(study_of_json(read_manifest(study)["study"]))
    # By chance: every sixteenth point of a Sobol sequence would lie in one corner of the space.
    chosen = np.random.default_rng(0).choice(design.cases, cases, replace=False).tolist()
    pairs = [
        (case, FIRST_PROFILE + case * profiles + k) for case in chosen for k in range(profiles)
    ]

    def scenarios() -> Iterator[tpss.Scenario]:
        for case, profile in pairs:
            yield scenario_with(design, {**design.values(case), PROFILE: profile}, case)

    rows = []
    for (case, profile), figures in zip(pairs, tpss.simulate_many(scenarios()), strict=True):
        rows.append({"case": case, "profile": profile, **output_columns(figures)})
        if len(rows) % 100 == 0:
            print(f"{len(rows):,} of {len(pairs):,} simulated", flush=True)
    return pd.DataFrame(rows)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("study", type=Path, help="folder that tpss sweep has written")
    parser.add_argument("out", type=Path, help="table to write (.parquet)")
    parser.add_argument("--cases", type=int, default=320)
    parser.add_argument("--profiles", type=int, default=4)
    given = parser.parse_args()
    twins(given.study, given.cases, given.profiles).to_parquet(given.out, index=False)
