"""The audit passes sound runs, and finds what has been tampered with in their recordings."""

import copy
from typing import Any

import numpy as np
import pytest

from lines import double_track, scenario_of, with_posts
from tpss import Scenario, load_scenario
from tpss.audit.verdict import JUDGED, Audit, limits_of, usual_limits
from tpss.model import build_model
from tpss.model.traffic import build_services
from tpss.results.key_figures import frame_of, key_figures_of
from tpss.run.run import advance_to_end, outcome_of, run_of
from tpss.run.start import begin

from conftest import EXAMPLE_SCENARIOS, EXAMPLES
from scenarios import gradients, limits, short_line
from slow_audit import assert_agree
from slow_audit import audit as slow_audit

HALF_AN_HOUR = {"simulation.until": None, "simulation.duration_min": 30.0}
STEP, TRAIN, NODE, STATION = 3, 1, 1, 1


class Case:
    """A run that can be audited, and tampered with."""

    def __init__(self, scenario: Scenario, steps: int | None) -> None:
        model, layout = build_model(scenario)
        self.frame = frame_of(scenario, layout, model)
        self.node_level = np.where(layout.supply.at_line_level, layout.supply.node_level, np.nan)
        self.start = begin(model, build_services(scenario, model), steps)
        self.model = self.start.model
        self.run = run_of(self.start)
        self.status = advance_to_end(self.run, self.start)

    def audit(self) -> Audit:
        return key_figures_of(self.run, self.status, self.start, self.frame).audit

    def slow_audit(self) -> Audit:
        outcome = outcome_of(self.run, self.status, self.start.studied)
        return slow_audit(outcome, self.model, self.node_level)

    def forged(self, **changes: Any) -> "Case":
        """The case with other records in its recording."""
        case = copy.copy(self)
        case.run = copy.copy(self.run)
        case.run.recording = self.run.recording._replace(**changes)
        return case

    def audit_of_forgery(
        self, records: str, field: str, place: int, change: Any, step: int = STEP
    ) -> Audit:
        """Audit of a copy in which one recorded value is changed, which its slow twin sees too."""
        forged = np.copy(getattr(self.run.recording, records)).view(np.recarray)
        forged[field][step, place] = change(forged[field][step, place])
        case = self.forged(**{records: forged})
        assert_twins(case)
        return case.audit()


def assert_twins(case: Case) -> None:
    """Assert that the audit agrees with its slow twin, as far as rounding errors can."""
    assert_agree(case.audit(), case.slow_audit(), limits_of(case.model))


@pytest.fixture(scope="module")
def main_line():
    """Ten trains on the thesis's main line for 30 minutes."""
    return Case(load_scenario(EXAMPLES / "thesis_160km.toml", HALF_AN_HOUR), 60)


@pytest.fixture(scope="module")
def stepped_line():
    """The same with trains that move in steps."""
    changes = {**HALF_AN_HOUR, "simulation.braking": "whole-steps"}
    return Case(load_scenario(EXAMPLES / "thesis_160km.toml", changes), 60)


@pytest.fixture(scope="module")
def arrival():
    """A single train on a short line until it has arrived."""
    return Case(short_line(), None)


@pytest.mark.parametrize("name", ["main_line", "arrival"])
def test_a_sound_run_passes(request, name):
    checked = request.getfixturevalue(name).audit()
    assert checked.passed
    assert checked.failures == ()
    limits = limits_of(request.getfixturevalue(name).model)
    assert set(limits) == set(JUDGED)
    assert limits["power_mismatch_va"] == pytest.approx(0.01)
    for figure, limit in limits.items():
        assert 0.0 <= getattr(checked, figure) <= limit
    assert 0.5 * 16.5e3 <= checked.lowest_voltage_v <= checked.highest_voltage_v <= 1.2 * 16.5e3


@pytest.mark.parametrize("file", EXAMPLE_SCENARIOS, ids=lambda file: file.stem)
def test_the_audit_of_an_example_is_that_of_its_slow_twin(file):
    case = Case(load_scenario(file), None if "headway" not in file.stem else 120)
    assert_twins(case)


@pytest.mark.parametrize("driver", ["regulated", "aggressive"])
@pytest.mark.parametrize("braking", ["whole-steps", "within-step"])
@pytest.mark.parametrize("sampling", ["mean", "start"])
@pytest.mark.parametrize("step_min", [0.05, 0.5, 1.0])
def test_the_audit_of_every_driver_is_that_of_its_slow_twin(driver, braking, sampling, step_min):
    """Over hills and lower limits, with trains on the line at the start, one of them stopping."""
    hills = gradients((0.0, 0.0), (3.0, 8.0), (6.0, -12.0), (12.0, 0.0))
    changes = {
        "simulation.driver": driver,
        "simulation.braking": braking,
        "simulation.power_sampling": sampling,
        "simulation.time_step_min": step_min,
        "traffic.0.headway_min": 8.0,
        "traffic.0.already_running": True,
        "traffic.0.stops": [{"station": "Middle", "dwell_min": 1.0}],
        **hills,
        **limits((0.0, 60.0), (5.0, 90.0), (8.0, 45.0)),
    }
    assert_twins(Case(short_line(changes), int(30.0 / step_min)))


@pytest.mark.parametrize("step_min", [0.01, 0.05, 0.5, 1.0, 7.0])
def test_the_audit_of_continuous_motion_is_that_of_its_slow_twin(step_min):
    """As above, with departures and dwells that are no whole steps, until the studied train arrives."""
    hills = gradients((0.0, 0.0), (3.0, 8.0), (6.0, -12.0), (12.0, 0.0))
    changes = {
        "simulation.motion": "continuous",
        "simulation.braking": "within-step",
        "simulation.time_step_min": step_min,
        "traffic.0.headway_min": 8.3,
        "traffic.0.first_departure_min": 0.7,
        "traffic.0.already_running": True,
        "traffic.0.stops": [{"station": "Middle", "dwell_min": 0.7}],
        **hills,
        **limits((0.0, 60.0), (5.0, 90.0), (8.0, 45.0)),
    }
    case = Case(short_line(changes), None)
    assert_twins(case)
    assert case.audit().passed


@pytest.mark.parametrize(
    ("group", "field", "forge", "figure"),
    [
        ("nodes", "node_real", lambda x: np.nan, "power_mismatch_va"),
        ("trains", "tractive_force", lambda x: 1.01 * x, "force_balance"),
        ("trains", "speed", lambda x: x + 0.01, "motion_error_m"),
        ("trains", "pantograph_imag", lambda x: np.nan, "power_mismatch_va"),
    ],
)
def test_the_audit_sees_one_forged_value(group, field, forge, figure):
    case = Case(short_line({"simulation.duration_min": 5.0}), 100)
    failures = case.audit_of_forgery(group, field, 0, forge, step=40).failures
    assert any(failure.startswith(figure) for failure in failures), failures


@pytest.fixture(scope="module")
def coupled_tracks():
    """Four trains on two tracks that have an impedance in common, tied at posts and at both ends."""
    common = {"mutual_x_ohm_per_km": 0.05, "capacitance_nf_per_km": 10.0}
    tracks = with_posts(double_track("posts", mutual_r_ohm_per_km=0.02, **common), 12.0, 25.0)
    return Case(scenario_of(tracks), 200)


@pytest.mark.parametrize(
    ("records", "field"),
    [
        ("trains", "pantograph_real"),
        ("trains", "pantograph_imag"),
        ("trains", "route_position"),
        ("nodes", "node_imag"),
        ("trains", "reactive_power"),
    ],
)
def test_the_audit_of_coupled_tracks_sees_one_forged_value(coupled_tracks, records, field):
    assert coupled_tracks.audit().passed
    assert coupled_tracks.audit().power_mismatch_va < 0.005
    assert_twins(coupled_tracks)
    forged = coupled_tracks.audit_of_forgery(records, field, 1, lambda x: x + 0.5, step=100)
    assert any(failure.startswith("power_mismatch_va") for failure in forged.failures)


@pytest.mark.parametrize("catenary", ["BT", "AT"])
@pytest.mark.parametrize("line", [None, {"type": "132kV", "transformers": 1}])
def test_runs_pass_on_every_supply(catenary, line):
    changes = {"supply.catenary": catenary, "supply.high_voltage_line": line}
    assert Case(short_line(changes), 60).audit().passed


FORGERIES = [
    ("trains", "active_power", TRAIN, lambda p: p + 1.0, "power_mismatch_va"),
    ("trains", "reactive_power", TRAIN, lambda q: q + 1.0, "power_mismatch_va"),
    ("trains", "pantograph_real", TRAIN, lambda v: v + 0.01, "power_mismatch_va"),
    ("trains", "pantograph_imag", TRAIN, lambda v: v + 0.01, "power_mismatch_va"),
    ("trains", "route_position", TRAIN, lambda x: x + 1.0, "power_mismatch_va"),
    ("nodes", "node_real", NODE, lambda v: v + 0.01, "power_mismatch_va"),
    ("nodes", "node_imag", NODE, lambda v: v + 0.01, "power_mismatch_va"),
    ("stations", "station_active_power", STATION, lambda p: p + 1.0, "power_mismatch_va"),
    ("stations", "station_reactive_power", STATION, lambda q: q + 1.0, "power_mismatch_va"),
    ("stations", "station_active_power", STATION, lambda p: p + 1e3, "converter_residual"),
    ("stations", "station_reactive_power", STATION, lambda q: q + 1e3, "converter_residual"),
    ("stations", "active_converters", STATION, lambda n: n - 1.0, "converter_residual"),
    ("stations", "station_active_power", STATION, lambda p: 1.01 * p, "network_balance"),
    ("trains", "active_power", TRAIN, lambda p: 1.01 * p, "network_balance"),
    ("trains", "active_power", TRAIN, lambda p: 1.01 * p, "traction_balance"),
    ("trains", "resistance_power", TRAIN, lambda p: 1.01 * p, "traction_balance"),
    ("trains", "gradient_power", TRAIN, lambda p: p + 1e3, "traction_balance"),
    ("trains", "braking_power", TRAIN, lambda p: p + 1e3, "traction_balance"),
    ("trains", "traction_power", TRAIN, lambda p: 1.01 * p, "traction_balance"),
    ("trains", "running_resistance", TRAIN, lambda f: 1.01 * f, "force_balance"),
    ("trains", "gradient_force", TRAIN, lambda f: f + 1e3, "force_balance"),
    ("trains", "braking_force", TRAIN, lambda f: f + 1e3, "force_balance"),
    ("trains", "tractive_force", TRAIN, lambda f: f + 1e3, "force_balance"),
    ("trains", "route_position", TRAIN, lambda x: x - 1e3, "motion_error_m"),
    ("trains", "speed", TRAIN, lambda v: v + 0.01, "motion_error_m"),
]

STEPPED_FORGERIES = [
    ("trains", "running_resistance", TRAIN, lambda f: 1.01 * f, "traction_balance"),
    ("trains", "gradient_force", TRAIN, lambda f: f + 1e3, "traction_balance"),
    ("trains", "braking_force", TRAIN, lambda f: f + 1e3, "traction_balance"),
]


def test_forged_works_of_stepped_motion_exceed_their_limit(stepped_line):
    """There the audit finds work from forces, speeds and ways."""
    for records, field, place, change, figure in STEPPED_FORGERIES:
        checked = stepped_line.audit_of_forgery(records, field, place, change)
        assert getattr(checked, figure) > limits_of(stepped_line.model)[figure], field
        assert not checked.passed


@pytest.mark.parametrize(
    ("records", "field", "place", "change", "figure"),
    FORGERIES,
    ids=[f"{field} {figure}" for _, field, _, _, figure in FORGERIES],
)
def test_a_forged_value_exceeds_a_limit(main_line, records, field, place, change, figure):
    checked = main_line.audit_of_forgery(records, field, place, change)
    assert getattr(checked, figure) > limits_of(main_line.model)[figure]
    assert any(failure.startswith(f"{figure} is") for failure in checked.failures)
    assert not checked.passed


@pytest.fixture(scope="module")
def stops_within_steps():
    """A train 3499 m before its stop: three steps of a minute at 60 km/h; in the fourth it holds that
    for 20.1 s, and brakes."""
    within = {"simulation.braking": "within-step", "simulation.time_step_min": 1.0}
    placed = {"traffic.0.initial_trains": [{"position_km": 16.501, "speed_kmh": 60.0}]}
    return Case(short_line({**within, **placed}), 6)


def test_a_sound_run_that_brakes_within_steps_passes(stops_within_steps):
    held = stops_within_steps.run.recording.trains["holding_time"][STEP, 0]
    assert 0.0 < held < 60.0
    assert stops_within_steps.audit().passed


@pytest.mark.parametrize(
    ("field", "change", "figure"),
    [
        ("holding_time", lambda time_s: time_s + 1e-3, "motion_error_m"),
        ("speed", lambda v: v + 1e-3, "motion_error_m"),
        ("route_position", lambda x: x - 1e-3, "motion_error_m"),
        ("braking_force", lambda f: f + 1e3, "traction_balance"),
        ("running_resistance", lambda f: 1.01 * f, "traction_balance"),
        ("gradient_force", lambda f: f + 1e3, "traction_balance"),
        ("active_power", lambda p: 1.01 * p, "traction_balance"),
        ("tractive_force", lambda f: 1.01 * f, "force_balance"),
        ("braking_force", lambda f: f + 1e3, "force_balance"),
    ],
)
def test_a_forged_step_of_holding_and_braking_is_found(stops_within_steps, field, change, figure):
    checked = stops_within_steps.audit_of_forgery("trains", field, 0, change)
    assert any(failure.startswith(f"{figure} is") for failure in checked.failures)


def test_the_mismatch_is_the_power_that_was_added(main_line):
    """A train is billed 250 W more than its voltage and current ask for."""
    checked = main_line.audit_of_forgery("trains", "active_power", TRAIN, lambda p: p + 250.0)
    assert checked.power_mismatch_va == pytest.approx(250.0, abs=0.01)


def test_the_network_balance_is_the_share_that_was_added(main_line):
    """A hundredth more from one station in one of 60 steps."""
    power = main_line.run.recording.stations["station_active_power"][:60]
    added = 0.01 * power[STEP, STATION]
    share = added / (power.sum() + added)
    forged = ("stations", "station_active_power", STATION, lambda p: 1.01 * p)
    checked = main_line.audit_of_forgery(*forged)
    assert checked.network_balance == pytest.approx(share, rel=1e-6)


def test_losses_that_vanish_are_missed(main_line):
    losses = main_line.run.recording.network_losses.copy()
    losses[STEP] = 0.0
    checked = main_line.forged(network_losses=losses).audit()
    assert [failure.split(" is ")[0] for failure in checked.failures] == ["network_balance"]


def test_a_station_missed_by_more_than_a_millimetre_is_found(arrival):
    assert arrival.audit().stop_error_m < 1e-6
    clock = arrival.run.state.clock.copy()
    clock["stop_error_m"] = 0.002
    case = arrival.forged()
    case.run.state = case.run.state._replace(clock=clock)
    checked = case.audit()
    assert checked.failures == ("stop_error_m is 0.002, limit 0.001",)


def test_a_voltage_outside_the_plausible_range_is_found(main_line):
    """Without its real part, the phasor of a node that lags by some 20° has a third of its magnitude."""
    checked = main_line.audit_of_forgery("nodes", "node_real", NODE, lambda v: 0.0)
    imag_v = main_line.run.recording.nodes["node_imag"][STEP, NODE]
    assert checked.lowest_voltage_v == pytest.approx(abs(imag_v))
    assert "voltages leave the range of 8250 to 19800 V" in checked.failures


def test_billing_at_the_start_of_a_step_reports_its_gap_but_is_not_judged_by_it():
    """A train that speeds up is billed too little, a train that does not is billed right."""
    case = Case(short_line({"simulation.power_sampling": "start"}), None)
    checked = case.audit()
    assert checked.traction_balance > 1e-4
    assert checked.passed


def test_billing_at_the_start_is_judged_by_all_else():
    case = Case(short_line({"simulation.power_sampling": "start", **HALF_AN_HOUR}), 60)
    checked = case.audit_of_forgery("trains", "active_power", 0, lambda p: p + 1e6)
    assert {failure.split(" is ")[0] for failure in checked.failures} == {
        "power_mismatch_va",
        "network_balance",
    }


def test_a_run_without_work_of_the_motors_is_measured_by_what_gravity_does():
    """1470 t at 10 km/h down 10 per mille: the brakes take 140 kN · 2.8 m/s all the way, and the
    roundings of that are no fault."""
    gradients = [{"from_km": 0.0, "permille": -10.0}]
    limits = [{"from_km": 0.0, "speed_kmh": 10.0}]
    changes = {"line.gradients": gradients, "line.speed_limits": limits}
    case = Case(short_line({**changes, "simulation.time_step_min": 1.0}), 60)
    assert not (case.run.recording.trains["tractive_force"] > 0.0).any()
    assert case.audit().passed
    assert case.audit_of_forgery("trains", "braking_force", 0, lambda f: 1.1 * f).failures


def test_the_first_step_of_a_train_far_along_the_line_balances():
    """0.6 s from a stand at 69.12 km: 2 cm of way, which positions round to 1.5e-11 m, or 7e-10."""
    places = [{"name": "A", "position_km": 69.12}, {"name": "B", "position_km": 72.0}]
    changes = {
        "line.length_km": 288.0,
        "line.stations": places,
        "traffic.0.from": "A",
        "traffic.0.to": "B",
        "simulation.time_step_min": 0.01,
        "supply.converter_stations.1.position_km": 288.0,
    }
    checked = Case(short_line(changes), 1).audit()
    assert checked.traction_balance < 1e-12
    assert checked.passed


def test_an_idle_train_is_no_reason_for_a_finer_balance_than_the_solver_promises():
    """151.5 kW of auxiliaries: a mismatch of 1e-10 of 10 MVA in one step is 7e-9 of them."""
    changes = {"traffic.0.stops": [{"station": "Middle", "dwell_min": 30.0}]}
    placed = [{"position_km": 9.999, "speed_kmh": 0.0}]
    case = Case(short_line({**changes, "traffic.0.initial_trains": placed}), 60)
    power = case.run.recording.stations["station_active_power"][:60]
    power[30, 0] += 1e-3
    assert case.audit().passed
    power[30, 0] += 1e3
    assert not case.audit().passed


def test_limits_follow_the_rounding_over_impedances_of_microohms():
    """Transformers 1 m apart on the 132 kV line, |z| = 80 mΩ/km · 1 m / 64 = 1.25 µΩ:
    4 · 2.2e-16 · 16500² / 1.25e-6 = 0.19 VA, 193 times the solver's usual 1e-10 of 10 MVA."""
    high_voltage = {"type": "132kV", "transformers_km": [10.0, 10.001]}
    near = Case(short_line({"supply.high_voltage_line": high_voltage}), 60)
    far = Case(short_line({"supply.high_voltage_line.type": "132kV",
                           "supply.high_voltage_line.transformers_km": [9.0, 11.0]}), 60)  # fmt: skip
    usual = usual_limits(10e6)
    assert usual["power_mismatch_va"] == 10.0 * 1e-10 * 10e6
    assert limits_of(far.model) == usual
    assert near.audit().passed
    wider = limits_of(near.model)
    assert wider["power_mismatch_va"] == pytest.approx(1.93, rel=0.01)
    assert wider["converter_residual"] == pytest.approx(1.93e-7, rel=0.01)
    assert wider["traction_balance"] == usual["traction_balance"]


def test_the_figures_are_plain_values_by_name(arrival):
    figures = arrival.audit().as_dict()
    assert {
        *JUDGED,
        "lowest_voltage_v",
        "highest_voltage_v",
        "failures",
        "limits",
        "passed",
    } == set(figures)
    assert figures["passed"] is True
    assert figures["failures"] == []
