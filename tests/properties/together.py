"""Random like cases, in lanes and alone: each has to come out the same both ways."""

from random import Random
from typing import Any

from hypothesis import strategies as st

from tpss import Scenario, ScenarioError, simulate_many
from tpss.api import build
from tpss.errors import TooLargeError
from tpss.lanes.known import not_covered

from .judge import is_long, patience
from alike import differences

Document = dict[str, Any]

CASES = 6
"""Fewer than there are lanes: two of these are filled up."""

AGREE = 1e-8
"""Difference of two figures that counts as none, relative or in their unit: of stations that hardly
feed anything, or each other over metres of line, energies are what the load flow's tolerance leaves."""

NOT_COMPARED = (
    "way", "audit", "mean_passes", "most_passes", "lowest_voltage.train", "lowest_voltage.time_min",
    "lowest_voltage.position_km", "lowest_voltage.line",
)  # fmt: skip
"""Figures that are not compared: roundings of the audit; how often Newton's method passed over the
network, once more where a rounding lifts a mismatch over the tolerance; and where and when a voltage is
lowest, of two that are equal but for a rounding."""

OF_THE_LINE = ("length_km", "gradients", "speed_limits", "stations", "begins_at_km")
OF_THE_SUPPLY = ("frequency_hz", "catenary", "converter_stations", "high_voltage_line")
"""What lanes cover of a line and a supply."""


def like_cases(sound: st.SearchStrategy[Document]) -> st.SearchStrategy[Document]:
    """Sound scenarios with one service whose trains move in steps: most are covered by lanes."""
    return sound.filter(lambda document: "line" in document).map(_reduced)


def _reduced(document: Document) -> Document:
    draw = Random(repr(document))
    name, train = next(iter(document["trains"].items()))
    dropped = (
        "regeneration", "storage", "motor_rating", "current_limitation", "efficiency_over_load",
    )  # fmt: skip
    service = {**document["traffic"][0], "train": name, "headway_min": draw.uniform(2.0, 15.0)}
    service.pop("departures_min", None)
    step_min = draw.choice([0.02, 0.05, 0.1])
    simulation = {"motion": "stepped", "braking": "whole-steps", "time_step_min": step_min}
    if draw.random() < 0.8:  # else until the first train arrives, mostly too soon to be worth lanes
        simulation["duration_min"] = step_min * draw.randint(300, 800)
    return {
        "format": 1,
        "name": "random",
        "simulation": simulation,
        "line": {key: document["line"][key] for key in OF_THE_LINE if key in document["line"]},
        "supply": {
            key: document["supply"][key] for key in OF_THE_SUPPLY if key in document["supply"]
        },
        "trains": {name: {key: train[key] for key in train if key not in dropped}},
        "traffic": [service],
    }


def judge_together(document: Document) -> str:
    """Run cases of other masses and headways both ways; return how many went in lanes, or why none."""
    with patience(document):
        try:
            first = Scenario.from_document(document, "random")
            if is_long(first):
                return "checked, too long to run"
            (train,) = first.trains
            mass_t, headway_min = first.trains[train].mass_t, first.traffic[0].headway_min
            cases = [
                first.with_({
                    f"trains.{train}.mass_t": mass_t * (1.0 + 0.02 * k),
                    "traffic.0.headway_min": headway_min * (1.0 + 0.03 * k),
                })
                for k in range(CASES)
            ]  # fmt: skip
            if reasons := not_covered(build(first)):
                return f"not covered: {reasons[0]}"
            alone = list(simulate_many(cases, 1, lanes=False))
        except ScenarioError:
            return "a finding"
        except TooLargeError:
            return "refused: too large"
        together = list(simulate_many(cases, 1, lanes=True))
        for found, expected in zip(together, alone, strict=True):
            off = differences(found, expected, AGREE, NOT_COMPARED, unit=1.0)
            assert not off, off
            assert found.audit.passed == expected.audit.passed
        return f"{sum(each.way == 'lanes' for each in together)} of {CASES} in lanes"
