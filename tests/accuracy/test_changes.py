"""What moves from one run to the next, and by which share."""

import math
from dataclasses import replace

import pytest

from tpss.accuracy.changes import LARGEST, LARGEST_OF_EXTREMES, changes_between
from tpss.accuracy.choose import STRICTNESS
from tpss.many import key_figures
from tpss.results.key_figures import LowestVoltage

from scenarios import short_line

NO_LOAD_KV = 16.5


@pytest.fixture(scope="module")
def figures():
    """A run of the short line, with figures that are easy to reckon with."""
    found = key_figures(short_line({"simulation.duration_min": 1.0}))
    west, east = found.stations
    service = replace(found.services[0], arrived=2, mean_trip_min=20.0)
    return replace(
        found,
        trip_time_min=25.0,
        services=(service,),
        stations=(
            replace(west, energy_mwh=3.0, peak_loading=0.4),
            replace(east, energy_mwh=1.0, peak_loading=0.2),
        ),
        lowest_voltage=LowestVoltage(14.5, "eastbound 1", 10.0, 0.5, None),
    )


def change_of(name, figures, finer, of=None):
    """The one change of that name."""
    found = [
        change
        for change in changes_between(figures, finer, NO_LOAD_KV)
        if change.figure == name and of in (None, change.of)
    ]
    (change,) = found
    return change


def test_nothing_moves_between_a_run_and_itself(figures):
    changes = changes_between(figures, figures, NO_LOAD_KV)
    assert {change.figure for change in changes} == {
        "trip_time_min", "mean_trip_min", "total_energy_mwh", "energy_mwh", "lowest_voltage_kv",
        "peak_loading",
    }  # fmt: skip
    assert all(change.share == 0.0 and change.within() for change in changes)


def test_a_trip_is_measured_by_itself(figures):
    """0.5 min of 25 min are 2 %, more than 1 %."""
    change = change_of("trip_time_min", figures, replace(figures, trip_time_min=25.5))
    assert change.of == "eastbound 1"
    assert change.share == pytest.approx(0.02)
    assert change.limit == LARGEST == 0.01
    assert not change.within()


def test_the_energy_of_a_station_is_measured_by_that_of_all(figures):
    """East moves by 0.02 of 1 MWh, which is 0.5 % of the 4 MWh of both; so does the total."""
    west, east = figures.stations
    finer = replace(figures, stations=(west, replace(east, energy_mwh=1.02)))
    for name, of in (("energy_mwh", "East"), ("total_energy_mwh", "")):
        change = change_of(name, figures, finer, of)
        assert change.share == pytest.approx(0.005)
        assert change.within()
    assert change_of("energy_mwh", figures, finer, "West").share == 0.0


@pytest.mark.parametrize(("finer_kv", "share"), [(14.46, -0.02), (14.56, 0.03)])
def test_a_voltage_is_measured_by_its_drop(figures, finer_kv, share):
    """Without load there are 16.5 kV, so 14.5 kV are a drop of 2 kV; 2 % of it are 40 V."""
    lowest = replace(figures.lowest_voltage, voltage_kv=finer_kv)
    change = change_of("lowest_voltage_kv", figures, replace(figures, lowest_voltage=lowest))
    assert change.share == pytest.approx(share)
    assert change.limit == LARGEST_OF_EXTREMES == 0.02


def test_hardly_any_drop_counts_as_a_hundredth_of_the_voltage(figures):
    """A drop that doubles from 1 V to 2 V: 1 V of 165 V, not of 1 V."""
    before, after = (
        replace(figures, lowest_voltage=replace(figures.lowest_voltage, voltage_kv=kv))
        for kv in (16.499, 16.498)
    )
    share = change_of("lowest_voltage_kv", before, after).share
    assert share == pytest.approx(-1.0 / 165.0)


def test_the_peak_loading_is_that_of_the_station_that_is_loaded_most(figures):
    west, east = figures.stations
    finer = replace(figures, stations=(replace(west, peak_loading=0.41), east))
    change = change_of("peak_loading", figures, finer)
    assert (change.of, change.share) == ("West", pytest.approx(0.025))


def test_trips_that_only_one_run_has_are_not_compared(figures):
    """Of the third train only one of the runs knows a trip: their means are of different trains."""
    service = replace(figures.services[0], arrived=3, mean_trip_min=30.0)
    finer = replace(figures, services=(service,), trip_time_min=math.nan)
    names = [change.figure for change in changes_between(figures, finer, NO_LOAD_KV)]
    assert "trip_time_min" not in names
    assert "mean_trip_min" not in names


def test_energies_of_nothing_do_not_move(figures):
    nothing = tuple(replace(station, energy_mwh=0.0) for station in figures.stations)
    still = replace(figures, stations=nothing)
    assert change_of("total_energy_mwh", still, still).share == 0.0


def test_of_runs_that_end_early_alike_the_end_is_compared(figures):
    """20 min, in steps of 0.1 min, and 20.3 min: 1.5 %."""
    early = replace(figures, status="collapsed", duration_min=20.0, steps=200)
    (change,) = changes_between(early, replace(early, duration_min=20.3, steps=406), NO_LOAD_KV)
    assert (change.figure, change.share) == ("duration_min", pytest.approx(0.015))


@pytest.mark.parametrize(
    ("ends_min", "steps", "within"),
    [((2.0, 1.5), (2, 3), True), ((0.0, 0.5), (0, 1), True), ((2.0, 0.5), (2, 1), False),
     ((0.0, 0.0), (0, 0), True)],
)  # fmt: skip
def test_an_end_that_moves_by_a_step_has_not_moved(ends_min, steps, within, figures):
    """In steps of 1 min an end is known to 1 min; to be chosen, a step must end it all but alike."""
    here, finer = (
        replace(figures, status="stalled", duration_min=end_min, steps=count)
        for end_min, count in zip(ends_min, steps, strict=True)
    )
    (change,) = changes_between(here, finer, NO_LOAD_KV)
    assert change.within() == within
    assert change.within(STRICTNESS) == (ends_min[0] == ends_min[1])


def test_of_runs_that_end_in_different_ways_nothing_is_compared(figures):
    assert changes_between(figures, replace(figures, status="stalled"), NO_LOAD_KV) == ()
