"""Cases in lanes end as they end alone: in every figure to 1e-12, with the same audit."""

from itertools import count, islice

import pytest

import tpss
from tpss import many

from alike import differences
from scenarios import gradients, short_line

AGREE = 1e-12
OVERLOAD = {"trains.freight.mass_t": 4000.0, **gradients((0.0, 0.0), (5.0, 30.0))}
"""A train that stalls."""

MASSES = [short_line({"trains.freight.mass_t": 900.0 + 50.0 * k, "traffic.0.headway_min": 7.0 + k})
          for k in range(7)]  # fmt: skip
STOPS = {"traffic.0.stops": [{"station": "Middle", "dwell_min": 1.0}]}
LIMITS = {"line.speed_limits": [{"from_km": 0.0, "speed_kmh": 60.0},
                                {"from_km": 12.0, "speed_kmh": 40.0}]}  # fmt: skip
CONTROL = {"supply.converter_stations.0.control": "loading", "traffic.0.headway_min": 4.0,
           "traffic.0.already_running": True}  # fmt: skip
DOWN = {"traffic.0.from": "East", "traffic.0.to": "West", **STOPS}


def assert_alike(scenarios: list[tpss.Scenario]) -> list[str]:
    """Assert that cases come out the same in lanes and alone; return which way they went."""
    alone = list(tpss.simulate_many(scenarios, lanes=False))
    together = list(tpss.simulate_many(scenarios, lanes=True))
    assert [each.way for each in alone] == ["alone"] * len(alone)
    for found, expected in zip(together, alone, strict=True):
        assert differences(found, expected, AGREE) == []
        assert found.audit.passed == expected.audit.passed
        assert found.audit.limits == expected.audit.limits
    return [each.way for each in together]


@pytest.mark.parametrize("changes", [{}, STOPS, LIMITS, CONTROL, DOWN],
                         ids=["plain", "stops", "limits", "control", "down"])  # fmt: skip
def test_cases_of_one_structure_run_in_lanes(changes):
    cases = [each.with_(changes) for each in MASSES[:5]]
    assert assert_alike(cases) == ["lanes"] * 5


def test_a_run_that_takes_longer_than_foreseen_has_room_in_lanes():
    """At 15 km/h behind a short stretch of 60 km/h, with trains that depart until the end."""
    slow = {"line.speed_limits": [{"from_km": 0.0, "speed_kmh": 60.0},
                                  {"from_km": 1.0, "speed_kmh": 15.0}]}  # fmt: skip
    cases = [each.with_({**slow, "simulation.time_step_min": 0.1}) for each in MASSES[:4]]
    assert assert_alike(cases) == ["lanes"] * 4


def test_whoever_stalls_leaves_and_runs_alone():
    ways = assert_alike([*MASSES[:4], short_line(OVERLOAD)])
    assert ways == ["lanes"] * 4 + ["alone"]


def test_few_or_different_cases_run_alone_and_order_is_kept():
    other = short_line({"simulation.time_step_min": 0.1})
    ways = assert_alike([MASSES[0], other, *MASSES[1:5], other])
    assert ways == ["lanes", "alone", *["lanes"] * 4, "alone"]
    assert assert_alike(MASSES[:3]) == ["alone"] * 3


def test_scenarios_are_taken_as_lanes_need_them():
    """Of an endless supply no more is taken than gives each thread two batches, twice."""
    taken = count()
    endless = (MASSES[0] for _ in taken)
    found = list(islice(tpss.simulate_many(endless, 1, lanes=True), 3))
    assert [each.way for each in found] == ["lanes"] * 3
    assert next(taken) <= 2 * 16 + 1


def test_lanes_are_compiled_where_they_are_worth_it(monkeypatch):
    """By default after so many steps, if they are not compiled."""
    monkeypatch.setattr(many, "are_compiled", lambda: False)
    assert {each.way for each in tpss.simulate_many(MASSES[:5], 1)} == {"alone"}
    monkeypatch.setattr(many, "STEPS_ALONE", 1)
    ways = [each.way for each in tpss.simulate_many([*MASSES, *MASSES], 1)]
    assert ways[:2] == ["alone"] * 2
    assert "lanes" in ways
