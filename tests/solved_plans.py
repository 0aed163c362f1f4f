"""Folders of plans that were solved from made-up outcomes, to report on."""

import itertools
from pathlib import Path
from typing import Any

from tpss.planning.answer import answer_of
from tpss.planning.cases import CaseList
from tpss.planning.solve import model_of
from tpss.planning.turning import all_turns
from tpss.planning.write import write_answer

from plan_outcomes import outcomes
from small_plans import PLAN, plan

HEADWAY = "traffic.eastbound.headway_min"


def solved(folder: Path, changes: dict[str, Any] | None = None) -> Path:
    """Folder of the small plan, changed by key paths with `/`."""
    listed = CaseList(plan(folder, changes))
    answer = answer_of(model_of(listed, outcomes(listed)))
    (folder / "out").mkdir()
    write_answer(folder / "out", answer, all_turns(answer))
    return folder / "out"


def station(number: int, others: list[str]) -> dict[str, Any]:
    """A station that stands alone, with a long name."""
    place = {"position_km": 2.0 * number + 1.0, "type": "Q48/Q49", "converters": 2}
    return {
        **PLAN["measures"]["Mid"],
        "add": {"supply.converter_stations": {"name": f"S{number}", **place}},
        "cost": 15.0 + number,
        "lead_time_years": 5,
        "excludes": others,
    }


def many() -> dict[str, Any]:
    """Ten configurations, four stages, 27 scenarios that part one stage after the other."""
    names = [f"Converter-station-{k}" for k in range(9)]
    stations = {
        f"measures/{name}": station(k, [other for other in names if other != name])
        for k, name in enumerate(names)
    }
    ways = list(itertools.product((20.0, 15.0, 10.0), (10.0, 7.5, 6.0), (6.0, 5.0, 4.0)))
    futures = {
        f"scenarios/growth-{k}": {"probability": 1.0 / len(ways), HEADWAY: [20.0, *way]}
        for k, way in enumerate(ways)
    }
    small = dict.fromkeys(("measures/Mid", "measures/AT", "scenarios/low", "scenarios/high"))
    stages = {"start": [2030, 2035, 2040, 2045], "end": 2080}
    return {**small, **stations, **futures, "stages": stages, "require/lowest_voltage_kv": 11.0}
