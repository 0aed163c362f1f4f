"""Trains that move continuously: closed forms at any step, and what long steps cost."""

import math
from typing import Any

import numpy as np
import pytest

import tpss

from properties.rules import keep_the_rules
from scenarios import gradients, short_line

STEPS_MIN = [0.01, 0.05, 0.07, 0.5, 1.0, 10.0]


def line(
    stations_km: list[float],
    limits: list[tuple[float, float]],
    train: dict[str, Any],
    dwells_min: list[float] | None = None,
    **others: Any,
) -> dict[str, Any]:
    """A line with one train, which stops at every station; stiff unless `others` say otherwise."""
    names = [f"H{n}" for n in range(len(stations_km))]
    dwells_min = dwells_min or [0.35] * (len(names) - 2)
    document = {
        "format": 1,
        "name": "line",
        "simulation": {"time_step_min": 0.1},
        "line": {
            "length_km": stations_km[-1],
            "gradients": [{"from_km": 0.0, "permille": 0.0}],
            "speed_limits": [{"from_km": km, "speed_kmh": kmh} for km, kmh in limits],
            "stations": [
                {"name": name, "position_km": km}
                for name, km in zip(names, stations_km, strict=True)
            ],
        },
        "supply": {
            "catenary": {"r_ohm_per_km": 0.001, "x_ohm_per_km": 0.0},
            "converter_stations": [
                {"name": "S", "position_km": 0.0, "converters": 1, "type": STIFF_STATION}
            ],
        },
        "trains": {"t": {**UNIT, **train}},
        "traffic": [
            {
                "name": "s",
                "train": "t",
                "from": names[0],
                "to": names[-1],
                "departures_min": [0.0],
                "stops": [
                    {"station": name, "dwell_min": dwell}
                    for name, dwell in zip(names[1:-1], dwells_min, strict=True)
                ],
            }
        ],
    }
    for path, value in others.items():
        part, key = path.split("__")
        document[part][key] = value
    return document


STIFF_STATION = {
    "rating_mva": 100.0,
    "no_load_voltage_kv": 16.5,
    "droop_kv_per_mvar": 0.0,
    "generator_reactance_pu": 0.0,
    "generator_base_mva": 10.0,
    "motor_reactance_pu": 0.0,
    "motor_base_mva": 10.0,
    "base_voltage_kv": 16.5,
}

UNIT = {
    "mass_t": 100.0,
    "adhesive_mass_t": 100.0,
    "resistance_a_n": 0.0,
    "resistance_b_n_s_per_m": 0.0,
    "resistance_c_n_s2_per_m2": 0.0,
    "max_speed_kmh": 200.0,
    "max_retardation_m_s2": 1.0,
    "auxiliary_power_kw": 0.0,
    "power_factor": 1.0,
    "efficiency": 1.0,
    "tractive_effort": {"max_force_kn": 100.0, "max_power_kw": 1e5},
}
"""100 t without resistance, 1 m/s² with all of its force, which no power limits, and with its brakes."""

TRAM = line(
    [0.45 * n for n in range(11)],
    [(0.0, 60.0)],
    {
        "mass_t": 42.0, "adhesive_mass_t": 28.0, "resistance_a_n": 600.0,
        "resistance_b_n_s_per_m": 10.0, "resistance_c_n_s2_per_m2": 4.0, "max_speed_kmh": 80.0,
        "max_retardation_m_s2": 1.2, "auxiliary_power_kw": 30.0, "efficiency": 0.85,
        "motor_inertia_kg": 4000.0, "max_acceleration_m_s2": 1.1,
        "tractive_effort": {"max_force_kn": 60.0, "max_power_kw": 480.0},
    },
)  # fmt: skip
"""Ten stops of 450 m."""

SUBURBAN = line(
    [1.8 * n for n in range(8)],
    [(0.0, 120.0)],
    {
        "mass_t": 160.0, "adhesive_mass_t": 100.0, "resistance_a_n": 2000.0,
        "resistance_b_n_s_per_m": 30.0, "resistance_c_n_s2_per_m2": 8.0, "max_speed_kmh": 140.0,
        "max_retardation_m_s2": 0.9, "auxiliary_power_kw": 80.0, "efficiency": 0.87,
        "max_acceleration_m_s2": 1.0,
        "tractive_effort": {"max_force_kn": 160.0, "max_power_kw": 2400.0},
    },
    dwells_min=[0.5] * 6,
)  # fmt: skip
"""Six stops of 1.8 km, 120 km/h."""

RAILCAR = line(
    [0.0, 8.0],
    [(0.0, 160.0)],
    {
        "mass_t": 50.0, "adhesive_mass_t": 50.0, "resistance_a_n": 750.0,
        "resistance_b_n_s_per_m": 10.0, "resistance_c_n_s2_per_m2": 30.0,
        "max_retardation_m_s2": 0.6, "max_acceleration_m_s2": 1.2,
        "tractive_effort": {"max_force_kn": 57.0, "max_power_kw": 930.0},
    },
)  # fmt: skip
"""930 kW, 50 t: on level track it balances at 111.7 km/h."""

WEAK = line(
    [0.0, 33.0],
    [(0.0, 160.0)],
    {
        "mass_t": 160.0, "adhesive_mass_t": 160.0, "resistance_a_n": 3000.0,
        "resistance_c_n_s2_per_m2": 9.0, "max_speed_kmh": 160.0, "max_retardation_m_s2": 0.6,
        "tractive_effort": {"max_force_kn": 200.0, "max_power_kw": 4000.0},
    },
    supply__catenary={"r_ohm_per_km": 0.21, "x_ohm_per_km": 0.2},
)  # fmt: skip
"""4 MW at the end of 33 km of a line of 0.21 + j 0.2 Ω/km, fed from its start."""


def run(document: dict[str, Any], step_min: float, **changes: Any) -> tpss.Result:
    """Result at a step, after a look at the rules of every run."""
    settings = {"simulation.time_step_min": step_min}
    settings |= {key.replace("__", "."): value for key, value in changes.items()}
    result = tpss.simulate(tpss.Scenario.from_document(document, "line").with_(settings))
    keep_the_rules(result)
    return result


@pytest.mark.parametrize("step_min", STEPS_MIN)
def test_a_train_of_constant_force_keeps_to_its_closed_form(step_min):
    """10 km at 72 km/h = 20 m/s, 1 m/s² up and down: 20 s each over 200 m, and 9.6 km at 20 m/s.

    In all 20 + 480 + 20 = 520 s.  Its motors do the work m v²/2 = 100 t · 400 / 2 = 20 MJ.
    """
    result = run(line([0.0, 10.0], [(0.0, 72.0)], {}), step_min)
    assert result.summary["trip_time_min"] == pytest.approx(520.0 / 60.0, rel=1e-12)
    drawn_mwh = result.trips.energy_mwh.sum()
    assert drawn_mwh == pytest.approx(20.0 / 3600.0, rel=1e-9)


@pytest.mark.parametrize("step_min", STEPS_MIN)
def test_limits_are_met_at_their_places_within_a_step(step_min):
    """72 km/h, from 2 km 36 km/h, from 5 km 72 km/h, to the stop at 10 km; 1 m/s² throughout.

    0 to 20 m/s: 20 s, 200 m; 20 to 10 m/s before 2 km: 10 s, 150 m; 1.65 km at 20 m/s: 82.5 s; 3 km at
    10 m/s: 300 s; 10 to 20 m/s: 10 s, 150 m; 20 to 0: 20 s, 200 m; 4.65 km at 20 m/s: 232.5 s; 675 s.
    """
    limits = [(0.0, 72.0), (2.0, 36.0), (5.0, 72.0)]
    result = run(line([0.0, 10.0], limits, {}), step_min)
    assert result.summary["trip_time_min"] == pytest.approx(675.0 / 60.0, rel=1e-9)


BANDS = {"from_speed_kmh": [0.0, 72.0, 144.0], "retardation_m_s2": [1.0, 0.5, 0.25]}


@pytest.mark.parametrize("step_min", STEPS_MIN)
def test_a_train_brakes_as_hard_as_it_may_at_its_speed(step_min):
    """From 180 km/h = 50 m/s to 0: (50² - 40²)/0.5 + (40² - 20²)/1 + 20²/2 = 1800 + 1200 + 200 m.

    That takes 10/0.25 + 20/0.5 + 20/1 = 100 s.  At 1 m/s² it starts in 50 s over 1250 m.  Of 20 km are
    left 15,550 m at 50 m/s, 311 s: 461 s in all.
    """
    fast = {"max_speed_kmh": 180.0, "max_retardation_m_s2": BANDS}
    result = run(line([0.0, 20.0], [(0.0, 180.0)], fast), step_min)
    assert result.summary["trip_time_min"] == pytest.approx(461.0 / 60.0, rel=1e-12)


@pytest.mark.parametrize("step_min", STEPS_MIN)
def test_a_lower_limit_is_met_across_bands_of_retardation(step_min):
    """Down to 90 km/h = 25 m/s at 10 km: (50² - 40²)/0.5 + (40² - 25²)/1 = 1800 + 975 m, in 40 + 30 s.

    Before it 1250 m in 50 s, and 5975 m at 50 m/s in 119.5 s.  From it 10 km at 25 m/s, but for the last
    (25² - 20²)/1 + 20²/2 = 225 + 200 m, in 10 + 20 s: 383 s more.  In all 652.5 s.
    """
    fast = {"max_speed_kmh": 180.0, "max_retardation_m_s2": BANDS}
    result = run(line([0.0, 20.0], [(0.0, 180.0), (10.0, 90.0)], fast), step_min)
    assert result.summary["trip_time_min"] == pytest.approx(652.5 / 60.0, rel=1e-12)


@pytest.mark.parametrize("edges", [[0.0], [0.0, 30.0], [0.0, 30.0, 60.0, 61.0]])
def test_bands_of_one_retardation_are_none(edges):
    """A suburban line, accelerating, holding and braking across the edges, ends as without them."""
    bands = {"from_speed_kmh": edges, "retardation_m_s2": [0.8] * len(edges)}
    plain = run(SUBURBAN, 0.01, trains__t__max_retardation_m_s2=0.8)
    banded = run(SUBURBAN, 0.01, trains__t__max_retardation_m_s2=bands)
    trip = pytest.approx(plain.summary["trip_time_min"], rel=1e-5)
    assert banded.summary["trip_time_min"] == trip
    energy = pytest.approx(plain.trips.energy_mwh.sum(), rel=1e-4)
    assert banded.trips.energy_mwh.sum() == energy


def test_stepped_motion_refuses_bands_of_retardation():
    document = line([0.0, 10.0], [(0.0, 72.0)], {"max_retardation_m_s2": BANDS})
    for choice in ({"motion": "stepped"}, {"braking": "whole-steps"}):
        document["simulation"] = {"time_step_min": 0.1, **choice}
        with pytest.raises(tpss.ScenarioError, match=f"{next(iter(choice))}.*not know") as caught:
            tpss.Scenario.from_document(document, "line")
        (finding,) = caught.value.findings
        assert finding.key == "trains.t.max_retardation_m_s2"


@pytest.mark.parametrize("step_min", [0.01, 0.07, 0.5, 1.0, 7.3])
def test_departures_dwells_and_arrivals_are_to_the_second(step_min):
    """Departure after 7.3 min, 5 km in 270 s (20 m/s, 1 m/s²), 0.7 min at the stop, 5 km again."""
    document = line([0.0, 5.0, 10.0], [(0.0, 72.0)], {}, dwells_min=[0.7])
    document["traffic"][0]["departures_min"] = [7.3]
    result = run(document, step_min)
    begin_min, leg_min = 7.3, 270.0 / 60.0
    stops = result.stops.set_index("station")
    assert stops.departure_min["H0"] == pytest.approx(begin_min)
    assert stops.arrival_min["H1"] == pytest.approx(begin_min + leg_min)
    assert stops.departure_min["H1"] == pytest.approx(begin_min + leg_min + 0.7)
    assert stops.arrival_min["H2"] == pytest.approx(begin_min + 2.0 * leg_min + 0.7)
    assert result.summary["trip_time_min"] == pytest.approx(2.0 * leg_min + 0.7)
    end_min = float(result.dataset.time[-1]) / 60.0
    assert end_min == pytest.approx(begin_min + 2.0 * leg_min + 0.7, abs=1e-3)


@pytest.mark.parametrize("step_min", [0.05, 0.1, 0.5, 1.0])
@pytest.mark.parametrize(
    "effort",
    [
        {"max_force_kn": 200.0, "max_power_kw": 4000.0},
        {"max_force_kn": 200.0, "max_power_kw": 4000.0, "limit_speed_kmh": 110.0},
        {
            "speed_kmh": [0.0, *np.arange(72.0, 164.0, 4.0).tolist()],
            "force_kn": [200.0, *(4000.0 * 3.6 / np.arange(72.0, 164.0, 4.0)).tolist()],
        },
    ],
    ids=["limits", "pull-out", "table"],
)
def test_no_train_has_more_power_than_its_machine(effort, step_min):
    """4 MW, of a table 4 MW at its points and some per mille more between them."""
    result = run(WEAK, step_min, trains__t__tractive_effort=effort)
    highest_w = float(result.dataset.motor_power.max())
    assert highest_w <= (4e6 if "max_power_kw" in effort else 4.03e6) * (1.0 + 2e-6)
    assert float(result.dataset.active_power.max()) <= highest_w * (1.0 + 1e-12)
    force_n, speed = result.dataset.tractive_force, result.dataset.speed
    assert float(force_n.max()) <= 200e3 * (1.0 + 1e-9)
    assert float(speed.max()) * 3.6 <= 160.0 + 1e-9


@pytest.mark.parametrize("step_min", [0.1, 0.5])
def test_a_limit_of_the_line_current_holds_at_any_step(step_min):
    """150 A, from 14.25 kV down to nothing at 12 kV: never more than 16.5 kV · 150 A = 2.475 MW."""
    limit = {"max_current_a": 150.0, "un_kv": 15.0, "knee_factor": 0.95, "umin2_kv": 12.0}
    result = run(WEAK, step_min, trains__t__current_limitation=limit)
    data = result.dataset
    apparent_va = np.hypot(data.active_power, data.reactive_power)
    current_a = (apparent_va / data.pantograph_voltage).to_numpy()
    assert np.nanmax(current_a) <= 150.0 * (1.0 + 1e-6)
    assert result.summary["limited"]["current_limited"] > 0


ACCURACY = [
    ("tram", TRAM, 0.1, 0.01, 0.02),
    ("tram", TRAM, 0.5, 0.01, 0.02),
    ("suburban unit", SUBURBAN, 0.5, 0.02, 0.04),
    ("railcar", RAILCAR, 1.0, 0.003, 0.003),
]


@pytest.mark.parametrize(
    ("_", "document", "step_min", "of_time", "of_energy"),
    ACCURACY,
    ids=[f"{name} at {step} min" for name, _, step, _, _ in ACCURACY],
)
def test_long_steps_are_accurate(_, document, step_min, of_time, of_energy):
    """Against steps of 0.002 min."""
    long, fine = run(document, step_min), run(document, 0.002)
    assert long.status == fine.status == "finished"
    trip = pytest.approx(fine.summary["trip_time_min"], rel=of_time)
    assert long.summary["trip_time_min"] == trip
    energy = pytest.approx(fine.trips.energy_mwh.sum(), rel=of_energy)
    assert long.trips.energy_mwh.sum() == energy


def test_a_railcar_on_level_track_keeps_below_its_balancing_speed():
    """A + B v + C v² = P / v at 31.03 m/s = 111.7 km/h; 8 km take 5.05 min and 0.0629 MWh."""
    v = np.roots([30.0, 10.0, 750.0, -930e3])
    balance = float(v[np.isreal(v)].real[0])
    assert balance * 3.6 == pytest.approx(111.7, abs=0.05)
    result = run(RAILCAR, 1.0)
    assert float(result.dataset.speed.max()) <= balance
    assert result.summary["trip_time_min"] == pytest.approx(5.05, abs=0.005)
    assert result.trips.energy_mwh.sum() == pytest.approx(0.0629, abs=5e-5)


def test_the_lowest_voltage_of_a_weak_line_is_found_at_half_a_minute():
    """Within 1 % of that at steps of 0.002 min."""
    long, fine = run(WEAK, 0.5), run(WEAK, 0.002)
    lowest = [result.summary["lowest_voltage"]["voltage_kv"] for result in (long, fine)]
    assert lowest[0] == pytest.approx(lowest[1], rel=0.01)


def test_the_thesis_s_line_needs_no_short_steps():
    """Table 3-3 at 1 min within 0.3 % of its energy at 0.01 min, its trip within 0.01 %."""
    examples = tpss.load_scenario("examples/thesis_3_3.toml")
    long, fine = (
        tpss.simulate(examples.with_({"simulation.time_step_min": step})).summary
        for step in (1.0, 0.01)
    )
    assert long["total_energy_mwh"] == pytest.approx(fine["total_energy_mwh"], rel=0.003)
    assert long["trip_time_min"] == pytest.approx(fine["trip_time_min"], rel=1e-4)


def test_a_step_of_one_phase_and_a_passage_agree():
    """At 3 s, steps of changing force are one phase each; a hair longer, they are passages of two."""
    one, several = run(WEAK, 0.05), run(WEAK, 0.05 * (1.0 + 1e-6))
    for figure in ("trip_time_min", "total_energy_mwh"):
        assert one.summary[figure] == pytest.approx(several.summary[figure], rel=2e-4)


@pytest.mark.parametrize("document", [TRAM, SUBURBAN, RAILCAR])
def test_a_passage_that_stays_at_any_voltage_is_that_of_each_voltage(document):
    """A machine of full force from 2 V on has it at all voltages of a run, but each is tried anew.

    So the run is that of the machine of full force at any voltage, whose passages are found once.
    """
    followed = {"full_voltage_kv": 0.002, "zero_voltage_kv": 0.001}
    effort = document["trains"]["t"]["tractive_effort"] | followed
    once = run(document, 0.25)
    anew = run(document, 0.25, trains__t__tractive_effort=effort)
    assert (once.dataset.train_state == anew.dataset.train_state).all()
    for name in ("speed", "route_position", "active_power", "reactive_power", "node_voltage"):
        np.testing.assert_array_equal(once.dataset[name], anew.dataset[name], err_msg=name)


def test_a_train_that_cannot_climb_stalls_where_it_comes_to_stand():
    """100 t on 100 ‰ need 98.1 kN of its 50 kN: it comes to stand, whatever the step."""
    document = line([0.0, 5.0], [(0.0, 72.0)], {"tractive_effort": EFFORT_OF_50_KN})
    hill = [{"from_km": 0.0, "permille": 0.0}, {"from_km": 1.0, "permille": 100.0}]
    for step_min in (0.01, 0.1, 1.0):
        result = run(document, step_min, line__gradients=hill)
        assert result.status == "stalled"
        assert "its machine and adhesion give 50.0 kN" in result.summary["problem"]


EFFORT_OF_50_KN = {"max_force_kn": 50.0, "max_power_kw": 1e5}


def test_trains_of_a_headway_run_already_wherever_steps_begin():
    """Headways of 8.3 min at steps of 1 min: at the start, the n-th is n headways under way."""
    document = line([0.0, 10.0, 20.0], [(0.0, 72.0)], {}, dwells_min=[0.7])
    entry = document["traffic"][0]
    del entry["departures_min"]
    entry |= {"headway_min": 8.3, "already_running": True}
    result = run(document, 1.0, simulation__until=None, simulation__duration_min=5.0)
    initial = result.dataset.position.to_numpy()[0, :2]
    # 498 s: 200 m in 20 s, the rest at 20 m/s: 9,760 m; 996 s: 520 s to the stop, 42 s there, 200 m, ...
    assert initial == pytest.approx([200.0 + 478.0 * 20.0, 10e3 + 200.0 + (996 - 582) * 20.0])


def test_continuous_motion_refuses_choices_of_stepped_motion():
    document = line([0.0, 5.0], [(0.0, 72.0)], {})
    document["simulation"] |= {"motion": "continuous", "driver": "aggressive"}
    with pytest.raises(tpss.ScenarioError) as refused:
        tpss.Scenario.from_document(document, "line")
    finding = refused.value.findings[0]
    assert 'driver = "aggressive"' in finding.problem
    assert "stepped" in finding.remedy


@pytest.mark.parametrize(
    ("choice", "motion"),
    [
        ({}, "continuous"),
        ({"braking": "within-step"}, "continuous"),
        ({"braking": "whole-steps"}, "stepped"),
        ({"power_sampling": "start"}, "stepped"),
        ({"gradient_sampling": "start"}, "stepped"),
        ({"driver": "aggressive"}, "stepped"),
        ({"motion": "stepped"}, "stepped"),
    ],
)
def test_motion_left_out_follows_from_the_other_choices(choice, motion):
    document = line([0.0, 5.0], [(0.0, 72.0)], {})
    document["simulation"] |= choice
    scenario = tpss.Scenario.from_document(document, "line")
    assert scenario.simulation.how_trains_move == motion
    assert math.isfinite(tpss.simulate(scenario).summary["total_energy_mwh"])


def test_a_train_that_leaves_its_stop_within_a_step_and_cannot_start_stalls_in_it():
    """On 60 per mille behind Middle, where the rails pass on 257 kN of the 865 kN that 1470 t take."""
    steep = gradients((0.0, 0.0), (9.9999, 60.0))
    stop = [{"station": "Middle", "dwell_min": 1.0}]
    moves = {"simulation.motion": "continuous", "simulation.braking": "within-step"}
    changes = {**steep, **moves, "traffic.0.stops": stop, "simulation.time_step_min": 1.0}
    result = tpss.simulate(short_line(changes))
    assert result.status == "stalled"
    assert "cannot start at 10.00 km" in result.summary["problem"]
    assert result.audit["passed"], result.audit["failures"]
    (arrival_min,) = result.stops.arrival_min[result.stops.station == "Middle"]
    assert float(result.dataset.time[-1]) / 60.0 <= arrival_min + 1.0
