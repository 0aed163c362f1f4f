"""Figures by their names: each shows what the result holds, and says if the run ended early."""

from dataclasses import replace

import numpy as np
import pytest

import tpss
from tpss.errors import ResultError
from tpss.report.contact_line import line_voltage
from tpss.report.drawings.effort import machine_limit
from tpss.report.drawings.energy import used_by_trains
from tpss.report.figures import FIGURES, draw, effort, energy_flow, time_distance, voltage_envelope
from tpss.report.figures.catalogue import applies
from tpss.report.trains import NothingToDrawError

from conftest import EXAMPLES
from scenarios import run, short_line, stops

LOSSES = {"supply.converter_stations.*.type": "Q48/Q49 with losses (estimate)"}
RATED = {
    "r_ohm_per_km": 0.21,
    "x_ohm_per_km": 0.2,
    "rating": {"continuous_a": 467.0, "time_constant_min": 4.7},
}
MOTOR = {"continuous_a": 1250.0, "short_time_a": 2080.0, "short_time_min": 6.0}
STORE = {"kind": "battery", "capacity_kwh": 50.0, "power_kw": 500.0, "efficiency": 0.9,
         "line_power_cap_kw": 2_000.0}  # fmt: skip
STORING = {
    "simulation.motion": None,
    "simulation.braking": None,
    "simulation.duration_min": 3.0,
    "trains.freight.storage": STORE,
}
HILLY = {
    **LOSSES,
    "supply.catenary": RATED,
    "line.gradients": [{"from_km": 0.0, "permille": 2.0}, {"from_km": 5.0, "permille": -1.0}],
    "traffic.0.headway_min": 10.0,
}
NOBODY = {"traffic.0.first_departure_min": 9.0, "simulation.duration_min": 3.0}


@pytest.fixture(scope="module")
def hilly():
    return run(HILLY)


@pytest.fixture(scope="module")
def storing():
    return run(STORING)


def title(figure):
    return figure.get_suptitle()


OF_CONVERTERS = [name for name in FIGURES if name not in ("unbalance", "rails")]
"""Figures of a line that converter stations feed."""

PHASES = {
    "supply.converter_stations": [],
    "supply.transformer_stations": [
        {"name": "A$_{$", "position_km": 0.0, "no_load_voltage_kv": 16.0, "grid_kv": 132.0,
         "grid_short_circuit_mva": 800.0, "phases": "RS",
         "transformer": {"rated_mva": 10.0, "short_circuit_percent": 8.0}}],
}  # fmt: skip


def test_the_unbalance_is_drawn_with_its_means_and_the_currents_of_the_phases():
    """Two phases carry one current; means begin after 10 min."""
    result = run({**PHASES, "simulation.duration_min": 12.0})
    figure = draw("unbalance", result)
    share, mean, *currents = [axes.lines[-1].get_ydata() for axes in figure.axes[:5]]
    peaks = [np.nanmax(each) for each in currents]
    assert peaks[0] == pytest.approx(peaks[1])
    assert peaks[2] == pytest.approx(0.0, abs=1e-9)
    assert np.nanmax(share) == pytest.approx(result.standards.unbalance.peak_percent[0])
    found = result.standards.unbalance.mean_10_min_percent[0]
    assert np.nanmax(mean) == pytest.approx(found, rel=1e-6)
    assert not applies("unbalance", run({"simulation.duration_min": 3.0}))


@pytest.mark.parametrize("name", OF_CONVERTERS)
def test_every_figure_is_drawn_with_the_scenario_s_name_above_it(hilly, storing, name):
    assert title(draw(name, storing if name == "storage" else hilly)).startswith("short-line")


def test_paths_are_coloured_by_the_voltage_of_their_step(hilly):
    paths = time_distance(hilly).axes[0].collections[0]
    data = hilly.dataset
    stays = np.isfinite(data.position[:-1]).to_numpy() & np.isfinite(data.position[1:]).to_numpy()
    train, step = np.nonzero(stays.T)
    volts = data.pantograph_voltage.to_numpy()[step, train]
    np.testing.assert_array_equal(paths.get_array(), volts / 1e3)
    segment = paths.get_segments()[0]
    first = data.isel(time=slice(0, 2), train=0)
    np.testing.assert_allclose(segment[:, 0], first.time / 60.0)
    np.testing.assert_allclose(segment[:, 1], first.position / 1e3)


def test_the_envelope_is_that_of_the_contact_line_between_the_limits(hilly):
    (panel,) = voltage_envelope(hilly).axes
    curves = {line.get_label(): line.get_ydata() for line in panel.lines}
    voltage = line_voltage(hilly.dataset)
    for name in ("lowest", "mean", "highest"):
        np.testing.assert_array_equal(curves[name], getattr(voltage, f"{name}_kv"))
    drawn = {line.get_ydata()[0] for line in panel.lines if len(line.get_ydata()) == 2}
    assert {11.0, 12.0, 15.0, 17.25, 18.0} <= drawn
    assert {text.get_text() for text in panel.texts} >= {"$U_{min1}$ 12", "West", "East"}


def test_energy_that_trains_draw_is_what_becomes_of_it(hilly):
    """The parts add up by their definition; resistance and climb are asserted by themselves."""
    used, data = used_by_trains(hilly), hilly.dataset
    assert sum(used.values()) == pytest.approx(hilly.trips.energy_mwh.sum(), rel=1e-9)
    way_m = 3.0 * (data.speed.to_numpy()[:-1] + data.speed.to_numpy()[1:]) / 2.0
    running = np.nansum(data.running_resistance.to_numpy()[:-1] * way_m) / 3.6e9
    assert used["running resistance"] == pytest.approx(running)
    assert used["brakes"] > 0.0
    # Those on the line at the end: M v²/2 with M = 1470 t.
    last = np.nansum(data.speed.to_numpy()[-1] ** 2) * 1.47e6 / 2.0 / 3.6e9
    assert used["kinetic energy"] == pytest.approx(last, rel=1e-6)


def test_the_bars_of_the_energy_have_one_length(hilly):
    (panel,) = energy_flow(hilly).axes
    ends = {}
    for bar in panel.patches:
        ends[round(bar.get_y(), 3)] = bar.get_x() + bar.get_width()
    assert len(ends) == 3
    total = hilly.summary["total_energy_mwh"]
    for end in ends.values():  # parts below 0.05 % each are left out
        assert end == pytest.approx(total, rel=5e-3)


def braking_within_steps(permille, step_min):
    """Three stops on 20 km of one gradient."""
    return {
        "line.gradients": [{"from_km": 0.0, "permille": permille}],
        **stops((5.0, 1.0), (10.0, 1.0), (15.0, 1.0)),
        "simulation.braking": "within-step",
        "simulation.time_step_min": step_min,
    }


@pytest.mark.parametrize("permille", [0.0, 8.0, -8.0])
def test_trains_that_hold_and_brake_in_a_step_keep_no_kinetic_energy_at_their_destination(permille):
    """What motors give, resistances, climb and brakes take, in steps of a minute too."""
    used = used_by_trains(run(braking_within_steps(permille, 1.0)))
    assert used["kinetic energy"] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("permille", [0.0, 8.0])
def test_energy_of_long_steps_that_hold_and_brake_is_that_of_short_ones(permille):
    """Mean forces of a minute times its way, in place of work, would put the motors 5 % too high."""
    long, short = (
        used_by_trains(run(braking_within_steps(permille, step_min))) for step_min in (1.0, 0.02)
    )
    total = sum(short.values())
    for name in ("motors and gears", "running resistance", "climb", "brakes"):
        assert long[name] == pytest.approx(short[name], abs=0.02 * total), name


def test_gravity_feeds_where_trains_run_downhill():
    """20 km at -6 ‰: 1470 t · 9.81 · 120 m = 0.4807 MWh."""
    result = run({"line.gradients": [{"from_km": 0.0, "permille": -6.0}]})
    assert used_by_trains(result)["climb"] == pytest.approx(-0.4807, rel=1e-3)
    (panel,) = energy_flow(result).axes
    names = [text.get_text() for text in panel.figure.legends[0].get_texts()]
    assert any(name.startswith("descent: 0.48") for name in names)
    assert not any(name.startswith("climb") for name in names)


def test_a_train_s_points_are_its_speed_and_force_below_the_machine_s_limit(hilly):
    panel = effort(hilly, "eastbound 1").axes[0]
    points = panel.collections[0].get_offsets()
    data = hilly.dataset.sel(train="eastbound 1")
    motoring = (data.tractive_force > 0.0).to_numpy()
    np.testing.assert_allclose(points[:, 0], data.speed.to_numpy()[motoring] * 3.6)
    np.testing.assert_allclose(points[:, 1], data.tractive_force.to_numpy()[motoring] / 1e3)
    curves = [line.get_label() for line in panel.lines]
    highest_kv = float(data.pantograph_voltage.max()) / 1e3
    assert curves[0] == f"machine at {highest_kv:.2f} kV"
    assert curves[2:] == ["adhesion, dry", "running resistance"]


def test_a_machine_gives_at_standstill_what_it_gives_close_to_it():
    train = tpss.load_scenario(EXAMPLES / "emu_25kv.toml").trains["emu"]
    still, slow = machine_limit(train, np.array([0.0, 0.01]), 25e3)
    assert still == pytest.approx(slow) == pytest.approx(200e3)


def test_the_machine_s_limit_follows_a_current_limitation():
    """At 100 km/h and 13 kV the Rc4 gives less with 250 A than without such a limit."""
    free = short_line().trains["freight"]
    limit = {"trains.freight.current_limitation": {"max_current_a": 250.0}}
    limited = short_line(limit).trains["freight"]
    speeds = np.array([5.0, 100.0]) / 3.6
    without, within = machine_limit(free, speeds, 13e3), machine_limit(limited, speeds, 13e3)
    assert within[0] == without[0]
    assert 0.0 < within[1] < 0.8 * without[1]


def test_a_run_that_collapsed_says_so_in_every_title():
    weak = {**LOSSES, "supply.catenary": {**RATED, "r_ohm_per_km": 0.3, "x_ohm_per_km": 0.35},
            "line.speed_limits": [{"from_km": 0.0, "speed_kmh": 100.0}],
            "line.gradients": [{"from_km": 0.0, "permille": 5.0}],
            "supply.converter_stations": [
                {"name": "West", "position_km": 0.0, "converters": 1,
                 "type": "Q48/Q49 with losses (estimate)"}],
            "traffic.0.headway_min": 3.0,
            "simulation.duration_min": 25.0}  # fmt: skip
    result = run(weak)
    assert result.status == "collapsed"
    for name in set(OF_CONVERTERS) - {"storage"}:  # of which it has none
        assert "collapsed at" in title(draw(name, result))


def test_a_result_that_failed_its_audit_is_not_drawn(hilly):
    audit = {**hilly.audit, "passed": False, "failures": ["power mismatch of 3 VA"]}
    failed = replace(hilly, figures={**hilly.figures, "audit": audit})
    with pytest.raises(ResultError, match="power mismatch of 3 VA"):
        draw("energy", failed)


def test_without_trains_the_stations_are_drawn_and_the_trains_are_not():
    empty = run(NOBODY)
    for name in ("voltage", "stations", "converters", "energy"):
        draw(name, empty)
    for name in ("time-distance", "journey", "effort", "train-voltage"):
        with pytest.raises(NothingToDrawError, match="no train was on the line"):
            draw(name, empty)


def test_names_that_are_formulas_to_matplotlib_are_drawn_as_they_are(tmp_path):
    names = {**LOSSES, "traffic.0.name": "$1 to $2", "line.stations.1.name": "a$_{$",
             "supply.converter_stations.0.name": "A$_{$",
             "trains.freight.motor_rating": MOTOR}  # fmt: skip
    result = run({**names, **STORING})
    for name in OF_CONVERTERS:
        draw(name, result).savefig(tmp_path / "figure.svg")
    fed = run({**PHASES, "simulation.duration_min": 3.0})
    draw("unbalance", fed).savefig(tmp_path / "figure.svg")
