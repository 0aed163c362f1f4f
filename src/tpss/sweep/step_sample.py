"""What the time step costs the cases of a study, by a few of them."""

import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from tpss.accuracy.check import StepCheck
from tpss.api import build
from tpss.errors import TpssError
from tpss.many import key_figures
from tpss.sweep.check import spread
from tpss.sweep.derive import scenario_of
from tpss.sweep.design import Design

SAMPLE, SAMPLE_S = 5, 10.0
"""Cases of a study whose step is checked, and the time after which no other one is begun. [1], [s]"""

_IN_WORDS = {
    "trip_time_min": "trip times",
    "total_energy_mwh": "energies",
    "lowest_voltage_kv": "voltage drops",
    "peak_loading": "peak loadings",
}


@dataclass(frozen=True)
class Checked:
    """A case whose step was checked."""

    case: int
    step_min: float
    check: StepCheck


def sample_steps(design: Design) -> dict[str, Any]:
    """Largest changes at half the step in a sample of cases, of plain types only."""
    checked = list(_checked(design))
    made = [each for each in checked if each.check.not_made is None]
    beyond = [each for each in made if not each.check.within]
    would_do_min = [each.check.would_do_min for each in beyond]
    known_min = [step for step in would_do_min if step is not None]
    return {
        "cases": [each.case for each in made],
        "time_steps_min": sorted({each.step_min for each in made}),
        "largest_shares": _largest(made),
        "too_long": [each.case for each in beyond],
        "would_do_min": min(known_min) if known_min and len(known_min) == len(beyond) else None,
        "not_made": next((each.check.not_made for each in checked if each not in made), None),
    }


def sample_in_words(sample: Mapping[str, Any]) -> str:
    """A sentence on a sample."""
    count, too_long = len(sample["cases"]), len(sample["too_long"])
    if not count:
        return f"No step check: {sample['not_made'] or 'no case of the sample could be run'}"
    shares = sample["largest_shares"]
    moved = [
        f"{words} {100.0 * abs(shares[figure]):.1f} %"
        for figure, words in _IN_WORDS.items()
        if figure in shares
    ]
    steps_min = sample["time_steps_min"]
    steps = " to ".join(f"{step:g}" for step in dict.fromkeys((steps_min[0], steps_min[-1])))
    told = (
        f"At half the step of {steps} min, in {count} of the cases, figures move by up to: "
        f"{', '.join(moved) or 'none finished'}"
    )
    if not too_long:
        return told
    remedy = "no shorter one that was tried would do for all"
    if sample["would_do_min"] is not None:
        remedy = f"{sample['would_do_min']:g} min would do"
    return f"{told}; the step is too long for {too_long} of them, {remedy}"


def _checked(design: Design) -> Iterator[Checked]:
    started = time.perf_counter()
    for case in spread(design.cases, SAMPLE):
        if time.perf_counter() - started > SAMPLE_S:
            return
        try:
            prepared = build(scenario_of(design, case))
            check = prepared.check_step(key_figures(prepared))
        except TpssError:  # which the table says of the case
            continue
        yield Checked(case, prepared.start.model.options.step_s / 60.0, check)


def _largest(made: list[Checked]) -> dict[str, float]:
    """Largest change of each figure, over the cases."""
    largest: dict[str, float] = {}
    for change in (change for each in made for change in each.check.changes):
        if abs(change.share) >= abs(largest.get(change.figure, 0.0)):
            largest[change.figure] = change.share
    return largest
