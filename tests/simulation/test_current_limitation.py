"""Whole runs of trains whose current is limited at low voltage, on a line that sags."""

import numpy as np
import pytest

from tpss.results.explain import warnings

from scenarios import SHORT_LINE, gradients, run

WEAK = {
    "traffic.0.headway_min": 3.0,
    "simulation.duration_min": 25.0,
    "supply.catenary": {"r_ohm_per_km": 0.3, "x_ohm_per_km": 0.35},
    "supply.converter_stations": [
        {"name": "West", "position_km": 0.0, "type": "Q48/Q49", "converters": 1}
    ],
    "line.speed_limits": [{"from_km": 0.0, "speed_kmh": 100.0}],
    "line.gradients": [{"from_km": 0.0, "permille": 5.0}],
}
MAX_A = 350.0
LIMIT = {"trains.freight.current_limitation": {"max_current_a": MAX_A}}
TRAINS = {
    "network": {},
    "table": {"tractive_effort": {"speed_kmh": [0, 40, 80, 160],
                                  "force_kn": [240, 200, 120, 60]}, "power_factor": 0.9},
    "limits": {"tractive_effort": {"max_force_kn": 240.0, "max_power_kw": 4000.0},
               "power_factor": 0.95},
    "bridge": {"reactive_power": "double-bridge"},
}  # fmt: skip


def on_weak_line(train, **more):
    changes = {f"trains.freight.{name}": value for name, value in TRAINS[train].items()}
    return run({**WEAK, **changes, **more})


def placed(*places_km):
    """Trains on the line at the start, at 20 km/h."""
    return [{"position_km": km, "speed_kmh": 20.0} for km in places_km]


def allowed_a(voltage_v):
    """The characteristic once more: 151.5 kW at 0.8 are 17.2 A at 11 kV, 14.25 kV the knee."""
    auxiliaries_a = 151.5 / 0.8 / 11.0
    return np.interp(voltage_v, [11e3, 14.25e3], [auxiliaries_a, MAX_A])


@pytest.mark.parametrize("train", TRAINS)
@pytest.mark.parametrize("sampling", ["mean", "start"])
def test_the_limit_is_kept_at_every_step_and_met_where_it_holds(train, sampling):
    """`run` asserts the audit and the rules of every run besides."""
    result = on_weak_line(train, **LIMIT, **{"simulation.power_sampling": sampling})
    assert result.status == "finished", result.summary["problem"]
    data = result.dataset.isel(time=slice(0, -1))
    power_va = np.hypot(data.active_power, data.reactive_power)
    current_a = (power_va / data.pantograph_voltage).to_numpy()
    limit_a = allowed_a(data.pantograph_voltage.to_numpy())
    motoring = data.tractive_force.to_numpy() > 0.0
    assert np.nanmin(data.pantograph_voltage) < 13.5e3
    assert (current_a[motoring] <= limit_a[motoring] * (1.0 + 1e-9)).all()
    met = motoring & (current_a > limit_a * (1.0 - 1e-9))
    assert 0 < met.sum() == result.summary["limited"]["current_limited"]


@pytest.mark.parametrize("train", TRAINS)
def test_a_limit_that_is_never_met_changes_nothing(train):
    """10 kA at a knee of 9 kV: above anything that these trains draw."""
    generous = {"max_current_a": 10e3, "knee_factor": 0.6, "umin2_kv": 5.0}
    free = on_weak_line(train)
    limited = on_weak_line(train, **{"trains.freight.current_limitation": generous})
    assert limited.summary["limited"]["current_limited"] == 0
    for name in ("position", "pantograph_voltage", "active_power"):
        np.testing.assert_allclose(limited.dataset[name], free.dataset[name], rtol=1e-9)


def test_limited_trains_are_slower_and_keep_the_line_from_collapse():
    free, limited = on_weak_line("network"), on_weak_line("network", **LIMIT)
    assert (free.status, limited.status) == ("collapsed", "finished")
    last = free.dataset.time[-1]
    assert limited.dataset.pantograph_voltage.min() > free.dataset.pantograph_voltage.min()
    assert float(limited.dataset.position.sel(time=last).sum()) < float(
        free.dataset.position.sel(time=last).sum()
    )


def test_the_run_says_in_how_many_steps_the_current_held_trains_back():
    said = warnings(on_weak_line("network", **LIMIT).summary)
    assert any(line.startswith("the current limitation") for line in said)


def test_a_stall_at_low_voltage_names_the_limitation_that_keeps_the_force_from_the_train():
    """Two trains without it draw the voltage below Umin2 = 11 kV: then only the rotors, slowing down,
    give a wheel force, 0.9 kN, of 175.5 kN that the train could have."""
    traffic = SHORT_LINE["traffic"][0]
    free_km, limited_km = (12.0, 13.0), (15.0,)
    changes = {
        **{key: value for key, value in WEAK.items() if not key.startswith("traffic")},
        **LIMIT,
        **gradients((0.0, 0.0), (14.5, 8.0)),
        "trains.free": {"model": "Rc4-freight-1470t"},
        "traffic": [
            {**traffic, "name": name, "train": train, "initial_trains": placed(*places)}
            for name, train, places in (
                ("limited", "freight", limited_km),
                ("free", "free", free_km),
            )
        ],
    }
    result = run(changes)
    assert result.status == "stalled"
    assert "machine and adhesion give 0.9 kN at 10.75 kV" in result.summary["problem"]
    assert "passes 1 % of the wanted force, " in result.summary["problem"]
    assert result.summary["advice"].startswith("Relax the train's current_limitation")


def test_a_stall_for_want_of_grip_does_not_blame_the_limitation():
    result = on_weak_line("network", **LIMIT, **{"line.gradients.0.permille": 30.0})
    assert result.status == "stalled"
    assert "current limitation" not in result.summary["problem"]


OVERLOADED = {
    **WEAK,
    "simulation.time_step_min": 0.5,
    "simulation.braking": "within-step",
    "simulation.duration_min": 80.0,
    "line.length_km": 80.0,
    "line.stations.2.position_km": 80.0,
    **gradients((0.0, 0.0)),
    "supply.catenary": "BT",
    "supply.converter_stations.0.converters": 6,
    "traffic.0.headway_min": 5.0,
    "trains.freight.max_motor_current_a": 1250.0,
    "trains.freight.filter_reactance_ohm": -0.45,
    "trains.freight.reactive_power": "double-bridge",
    "trains.freight.current_limitation": {
        "max_current_a": 900.0, "umin2_kv": 12.0, "knee_factor": 0.95,
    },
}  # fmt: skip


@pytest.mark.parametrize("motion", ["continuous", "stepped"])
def test_a_line_of_limited_trains_is_solved_in_few_passes(motion):
    """Fifteen trains of one station, ten of them within 0.2 kV of Umin2: each adds 0.4 S to what the
    push along the line runs against.  Two starts that fail take 80 passes; a path takes thousands."""
    result = run({**OVERLOADED, "simulation.motion": motion})
    assert result.status == "finished"
    assert result.dataset.pantograph_voltage.min() == pytest.approx(12e3, rel=0.005)
    passes = result.dataset.load_flow_passes.to_numpy()
    assert passes.max() <= 150
    assert (passes > 80).any()


def test_trains_that_come_to_stand_at_umin2_are_a_stall_not_a_collapse():
    """On 4 per mille, one converter for sixteen trains.  Those at the end get no current for traction
    and roll to a stand within a step, where they go on to draw what their auxiliaries need."""
    changes = {
        **OVERLOADED,
        **gradients((0.0, 4.0)),
        "simulation.time_step_min": 0.2,
        "simulation.duration_min": 180.0,
        "line.length_km": 120.0,
        "line.stations.2.position_km": 120.0,
        "simulation.motion": "continuous",
        "supply.converter_stations.0.converters": 1,
        "traffic.0.already_running": True,
        "trains.freight.max_motor_current_a": 2080.0,
        "trains.freight.current_limitation": {
            "max_current_a": 600.0, "umin2_kv": 11.0, "knee_factor": 0.9,
        },
    }  # fmt: skip
    result = run(changes)
    assert result.status == "stalled"
    assert "current limitation passes 0 % of the wanted force" in result.summary["problem"]
