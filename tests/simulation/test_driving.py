"""How trains run: the sequence of what they do first, then the numbers."""

import numpy as np
import pytest

from scenarios import phases, run


def speed(result, train="eastbound 1"):
    return result.dataset.speed.sel(train=train).dropna("time").to_numpy()


def test_a_train_accelerates_holds_its_limit_brakes_and_arrives():
    result = run()
    assert phases(result, "eastbound 1") == ["motoring", "braking", "arrived"]
    v = speed(result)
    assert v.max() == pytest.approx(60 / 3.6, rel=1e-15)
    assert (np.diff(v)[: int(v.argmax())] > 0).all()
    assert result.dataset.position.sel(train="eastbound 1").max() == 20_000.0


def test_a_train_never_passes_its_speed_limit_downhill():
    result = run({"line.gradients": [{"from_km": 0.0, "permille": -8.0}]})
    assert speed(result).max() <= 60 / 3.6
    assert "braking" in phases(result, "eastbound 1")
    assert result.summary["trip_time_min"] is not None


def test_a_train_s_own_limit_counts_too():
    assert speed(run({"trains.freight.max_speed_kmh": 45.0})).max() == pytest.approx(45 / 3.6)


def test_a_train_stops_exactly_dwells_and_goes_on():
    """Dwell of 1.03 min at steps of 0.05 min: 21 steps."""
    result = run({"traffic.0.stops": [{"station": "Middle", "dwell_min": 1.03}]})
    assert phases(result, "eastbound 1") == [
        "motoring", "braking", "dwelling", "motoring", "braking", "arrived",
    ]  # fmt: skip
    train = result.dataset.sel(train="eastbound 1")
    dwelling = train.train_state.to_numpy() == 4
    assert dwelling.sum() == 21
    assert set(train.position.to_numpy()[dwelling]) == {10_000.0}
    assert set(train.active_power.to_numpy()[dwelling]) == {151_500.0}  # auxiliaries only
    assert result.audit["stop_error_m"] < 1e-6


@pytest.mark.parametrize("step_min", [0.01, 0.3, 1.0, 5.0])
def test_a_train_stops_exactly_whatever_the_step(step_min):
    stops = [{"station": "Middle", "dwell_min": 0.0}]
    result = run({"simulation.time_step_min": step_min, "traffic.0.stops": stops})
    assert result.status == "finished"
    train = result.dataset.sel(train="eastbound 1")
    standing = train.position.to_numpy()[(train.speed == 0.0).to_numpy()]
    assert set(standing) == {0.0, 10_000.0, 20_000.0}
    assert train.acceleration.min() >= -0.85 - 1e-12
    assert np.nanmin(np.diff(train.position.to_numpy())) >= 0.0


def test_lower_limits_ahead_are_met_at_their_position():
    limits = [
        {"from_km": 0.0, "speed_kmh": 80.0},
        {"from_km": 8.0, "speed_kmh": 40.0},
        {"from_km": 12.0, "speed_kmh": 70.0},
    ]
    for step_min in (0.05, 1.0):
        result = run({"line.speed_limits": limits, "simulation.time_step_min": step_min})
        x = result.dataset.position.sel(train="eastbound 1").to_numpy() / 1e3
        v = result.dataset.speed.sel(train="eastbound 1").to_numpy() * 3.6
        in_zone = (x >= 8.0) & (x < 12.0)
        assert v[in_zone].max() <= 40 + 1e-9
        assert v[x < 8.0].max() > 41
        assert v[x >= 12.0].max() > 55
        # A step that passes the limit's position, not one that ends at it, begins at or below it.
        beyond = np.flatnonzero(x > 8.0 + 1e-9)[0]
        assert v[beyond - 1] <= 40 + 1e-9


def test_a_stop_closer_than_a_braking_distance_is_met():
    stations = [
        {"name": "West", "position_km": 0.0},
        {"name": "Next", "position_km": 0.05},
        {"name": "East", "position_km": 20.0},
    ]
    stops = [{"station": "Next", "dwell_min": 0.5}]
    result = run({"line.stations": stations, "traffic.0.stops": stops})
    x = result.dataset.position.sel(train="eastbound 1").to_numpy()
    assert 50.0 in x
    assert result.status == "finished"


def test_trains_depart_by_headway_at_the_first_instant_not_before_their_time():
    """Headway 2.5 min at steps of 0.4 min: 0, 2.5, 5.0, 7.5 -> instants 0, 2.8, 5.2, 7.6 min."""
    result = run(
        {
            "simulation.time_step_min": 0.4,
            "simulation.duration_min": 9.0,
            "traffic.0.headway_min": 2.5,
        }
    )
    assert result.trips.departure_min.to_list() == pytest.approx([0.0, 2.8, 5.2, 7.6])


def test_listed_departures_and_two_services_run_side_by_side():
    result = run(
        {
            "simulation.duration_min": 10.0,
            "traffic": [
                {
                    "name": "a",
                    "train": "freight",
                    "from": "West",
                    "to": "East",
                    "departures_min": [0.0, 4.0],
                },
                {
                    "name": "b",
                    "train": "freight",
                    "from": "Middle",
                    "to": "East",
                    "headway_min": 4.0,
                },
            ],
        }
    )
    assert result.trips.train.to_list() == ["a 1", "b 1", "a 2", "b 2", "b 3"]
    x = result.dataset.position
    assert float(x.sel(train="b 1")[0]) == 10_000.0


def test_placed_trains_head_for_their_next_stop():
    result = run(
        {
            "traffic.0.stops": [{"station": "Middle", "dwell_min": 1.0}],
            "traffic.0.initial_trains": [
                {"position_km": 9.0, "speed_kmh": 50.0},
                {"position_km": 15.0, "speed_kmh": 0.0},
            ],
        }
    )
    assert "dwelling" in phases(result, "eastbound initial 1")
    assert "dwelling" not in phases(result, "eastbound initial 2")
    assert result.trips.arrival_min[:2].notna().all()


def test_a_service_that_is_already_running_puts_trains_where_the_first_would_be():
    """A lone train at 15 kV, 5 and 10 minutes after its departure, is where the others start."""
    changes = {"traffic.0.headway_min": 5.0, "simulation.duration_min": 12.0}
    started = run({**changes, "traffic.0.already_running": True})
    alone = run({**changes, "traffic.0.headway_min": 60.0}).dataset.position.sel(
        train="eastbound 1"
    )
    first = started.dataset.position.isel(time=0)
    for n, train in ((1, "eastbound initial 1"), (2, "eastbound initial 2")):
        reference = float(alone.sel(time=300.0 * n))
        assert float(first.sel(train=train)) == pytest.approx(reference, rel=2e-3)


def test_an_arrived_train_leaves_the_line():
    result = run({"traffic.0.headway_min": 5.0, "simulation.duration_min": 40.0})
    arrived = result.trips.arrival_min[0]
    state = result.dataset.train_state.sel(train="eastbound 1")
    assert int(state.sel(time=arrived * 60.0)) == 5
    assert (state.where(state.time > arrived * 60.0, drop=True) == -1).all()


def test_balancing_speed_on_a_constant_gradient():
    """On 8 per mille a train settles where F_max(v) = A + B v + C v² + m g 0.008."""
    result = run({"line.gradients": [{"from_km": 0.0, "permille": 8.0}],
                  "line.speed_limits": [{"from_km": 0.0, "speed_kmh": 130.0}],
                  "line.length_km": 60.0, "line.stations.2.position_km": 60.0,
                  "supply.converter_stations.1.position_km": 60.0})  # fmt: skip
    train = result.dataset.sel(train="eastbound 1")
    late = train.isel(time=slice(-80, -40))
    assert abs(late.acceleration).max() < 2e-3
    force = late.running_resistance + late.gradient_force
    assert float(abs(late.tractive_force / force - 1).max()) < 0.02
    assert float(late.gradient_force[0]) == pytest.approx(1_470_000 * 9.81 * 0.008)
