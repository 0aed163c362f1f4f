"""Protection: stations that pass an overload trip, and what they carried goes to the others."""

import copy

import numpy as np
import pytest

import tpss
from faults import faults_of, finding_at
from lines import BOTH_WAYS, double_track, run
from tpss import library
from tpss.outages.report import outages_report
from tpss.outages.row import Verdict
from tpss.results.notes import notes

from properties.rules import keep_the_rules

Q48 = library.values("converters", "Q48/Q49")

THREE = {
    "format": 1, "name": "three",
    "simulation": {"time_step_min": 0.1, "duration_min": 60.0},
    "line": {
        "length_km": 80.0, "gradients": [{"from_km": 0.0, "permille": 2.0}],
        "speed_limits": [{"from_km": 0.0, "speed_kmh": 100.0}],
        "stations": [{"name": "A", "position_km": 0.0}, {"name": "B", "position_km": 80.0}],
    },
    "supply": {"catenary": "AT", "converter_stations": []},
    "trains": {"freight": {"model": "Rc4-freight-1470t", "mass_t": 900.0}},
    "traffic": [
        {"name": "up", "train": "freight", "from": "A", "to": "B", "headway_min": 6.0,
         "already_running": True}
    ],
}  # fmt: skip


def station(name: str, position_km: float, percent: float, minutes: float = 5.0, mva: float = 5.0):
    """One converter that bears a load for some minutes."""
    rating = {
        "time_constant_min": 30.0, "overloads": [{"percent": percent, "minutes": minutes}],
    }  # fmt: skip
    kind = {**Q48, "rating_mva": mva, "rating": rating}
    return {"name": name, "position_km": position_km, "type": kind, "converters": 1}


WEAK_MIDDLE = (
    station("West", 0.0, 900.0),
    station("Middle", 40.0, 101.0, mva=4.0),
    station("East", 80.0, 900.0),
)


def simulated(*stations, trip: bool = True, **changes) -> tpss.Result:
    document = copy.deepcopy(THREE)
    document["supply"]["converter_stations"] = list(stations)
    document["protection"] = {"trip": trip}
    document |= changes
    result = tpss.simulate(tpss.Scenario.from_document(document, "three"))
    keep_the_rules(result)
    return result


def loads(result: tpss.Result) -> np.ndarray:
    return result.dataset.converter_loading.to_numpy()[:-1]


def slow_trip_min(load: np.ndarray, step_min: float, percent: float, minutes: float) -> float:
    """The first instant at which the mean square over the minutes before it is above what is allowed."""
    per_window = round(minutes / step_min)
    for k in range(len(load)):
        begun = load[max(0, k + 1 - per_window) : k + 1]
        if (begun**2).sum() / per_window > (percent / 100.0) ** 2:
            return (k + 1) * step_min
    return np.inf


def test_a_station_trips_when_its_overload_is_passed_and_the_others_carry_its_load():
    """Middle alone has a weak converter.  When it trips is found once more from the run without
    protection; up to then both runs are the same, and after it Middle feeds nothing."""
    free, tripped = simulated(*WEAK_MIDDLE, trip=False), simulated(*WEAK_MIDDLE)
    (trip,) = tripped.summary["trips"]
    assert trip["element"] == "Middle"
    assert trip["time_min"] == pytest.approx(slow_trip_min(loads(free)[:, 1], 0.1, 101.0, 5.0))
    step = round(trip["time_min"] / 0.1)
    assert np.array_equal(loads(tripped)[:step], loads(free)[:step], equal_nan=True)
    power_mw = tripped.dataset.station_active_power.to_numpy()[:-1] / 1e6
    assert np.abs(power_mw[step:, 1]).max() == 0.0
    before_mw = free.dataset.station_active_power.to_numpy()[:-1] / 1e6
    assert power_mw[step, [0, 2]].sum() > before_mw[step, [0, 2]].sum() + 1.0
    assert any("protection, 1: Middle tripped" in note for note in notes(tripped))
    (loaded,) = (note for note in notes(tripped) if note.startswith("Middle was loaded"))
    assert loaded.endswith("it trips by its overloads")
    (loaded,) = (note for note in notes(free) if note.startswith("Middle was loaded"))
    assert loaded.endswith("the equipment would not")


def test_a_cascade_darkens_the_line_one_station_after_the_other():
    """Each station bears what it carries of the whole line, and not what one that has tripped leaves."""
    stations = [
        station("West", 0.0, 160.0, 2.0), station("Middle", 40.0, 101.0, mva=4.0),
        station("East", 80.0, 160.0, 2.0),
    ]  # fmt: skip
    result = simulated(*stations)
    names = [trip["element"] for trip in result.summary["trips"]]
    times = [trip["time_min"] for trip in result.summary["trips"]]
    assert names[0] == "Middle"
    assert sorted(names) == ["East", "Middle", "West"]
    assert times == sorted(times)
    last = result.dataset.station_active_power.to_numpy()[-2]
    assert np.abs(last).max() == 0.0


def test_a_trip_does_not_depend_on_the_step():
    """Loads of a step hold all through it; half the step moves the trip by a step at most."""
    times = []
    for step_min in (0.1, 0.05):
        simulation = {"time_step_min": step_min, "duration_min": 60.0}
        (trip,) = simulated(*WEAK_MIDDLE, simulation=simulation).summary["trips"]
        times.append(trip["time_min"])
    assert times[1] == pytest.approx(times[0], abs=0.2)


@pytest.mark.parametrize(("percent", "is_over"), [(260.0, True), (268.3, False)])
def test_what_trips_is_what_is_over_without_protection(percent, is_over):
    """By the same windows, 20 min and 1 min: the r.m.s. load over 20 min is 268 %.  Over 5 min, between
    the two, it is 268.5 %, which neither judges: that is left to the thermal state."""
    rating = {
        "time_constant_min": 30.0, "overloads": [
            {"percent": percent, "minutes": 20.0}, {"percent": 400.0, "minutes": 1.0},
        ],
    }  # fmt: skip
    weak = station("Middle", 40.0, percent, mva=4.0)
    weak["type"] = {**weak["type"], "rating": rating}
    ample = [station(name, km, 900.0, mva=20.0) for name, km in (("West", 0.0), ("East", 80.0))]
    free, tripped = simulated(*ample, weak, trip=False), simulated(*ample, weak)
    windows = free.thermal_windows.query("element == 'converter of Middle'")
    judged = windows.dropna(subset=["allowed_rms_percent"])
    assert judged.window_min.tolist() == [1.0, 20.0]
    assert (judged.highest_rms_percent > judged.allowed_rms_percent).any() == is_over
    assert ("trips" in tripped.summary) == is_over
    assert windows.highest_rms_percent[windows.window_min == 5.0].item() > 268.4


def test_trips_follow_an_outage():
    """With West out from the second step on, Middle carries more, and trips earlier than without."""
    outage = {"name": "no West", "stations": ["West"], "from_min": 0.1}
    simulation = {"time_step_min": 0.1, "duration_min": 60.0, "outage": "no West"}
    (alone,) = simulated(*WEAK_MIDDLE).summary["trips"][:1]
    first = simulated(*WEAK_MIDDLE, outages=[outage], simulation=simulation).summary["trips"][0]
    assert first["element"] == "Middle"
    assert first["time_min"] < alone["time_min"]


OVERLOADS = [{"percent": 110.0, "minutes": 2.0}]

AMPLE = tuple(station(name, km, 900.0, mva=20.0) for name, km in (("West", 0.0), ("East", 80.0)))


def supplied(**supply) -> tpss.Result:
    """The line with ample stations at both ends, and more of its supply."""
    given = {**copy.deepcopy(THREE["supply"]), **supply}
    document = {**copy.deepcopy(THREE), "supply": given, "protection": {"trip": True}}
    given["converter_stations"] = list(AMPLE) + given["converter_stations"]
    result = tpss.simulate(tpss.Scenario.from_document(document, "three"))
    keep_the_rules(result)
    return result


def test_a_transformer_of_the_high_voltage_line_trips_and_carries_nothing_from_then_on():
    """The one between the stations, of 3 MVA: 181.8 A at 16.5 kV.  Those at stations have no rating."""
    unit = library.values("transformers", "16MVA")
    unit["rating"] = {"rating_mva": 3.0, "time_constant_min": 60.0, "overloads": OVERLOADS}
    high_voltage = {"type": "132kV", "transformers_km": [40.0], "line_transformer": unit}
    result = supplied(catenary="BT", high_voltage_line=high_voltage)
    (trip,) = result.summary["trips"]
    assert trip["element"] == "transformer 40 km"
    current_a = result.dataset.branch_current.sel(branch="transformer 40 km").to_numpy()[:-1]
    assert trip["time_min"] == pytest.approx(slow_trip_min(current_a / 181.8182, 0.1, 110.0, 2.0))
    step = round(trip["time_min"] / 0.1)
    assert current_a[:step].min() > 0.0
    assert (current_a[step:] == 0.0).all()


WIRE = {"continuous_a": 400.0, "time_constant_min": 5.0, "overloads": OVERLOADS}


def test_a_section_of_contact_line_trips_and_its_trains_have_no_voltage():
    """Each end of a section has its relay; the station stays, and feeds the other side."""
    wire = {**library.values("catenaries", "AT"), "rating": WIRE}
    middle = station("Middle", 40.0, 900.0, mva=20.0)
    result = supplied(catenary=wire, converter_stations=[middle])
    data, first = result.dataset, result.summary["trips"][0]
    assert first["element"] == "contact line 40-80 km"
    ends = [f"contact line 40-80 km, {end}" for end in ("start", "end")]
    times = [
        slow_trip_min(data.branch_current.sel(branch=end).to_numpy()[:-1] / 400.0, 0.1, 110.0, 2.0)
        for end in ends
    ]
    assert first["time_min"] == pytest.approx(min(times))
    step = round(first["time_min"] / 0.1)
    km, volts = data.position.to_numpy()[:-1] / 1e3, data.pantograph_voltage.to_numpy()[:-1]
    beyond = (km > 40.01) & (km < 79.9)
    assert (volts[:step][beyond[:step]] > 0.0).all()
    assert (volts[step:][beyond[step:] & np.isfinite(volts[step:])] == 0.0).all()
    assert np.abs(data.station_active_power.sel(station="Middle")[step]) > 0.0


def test_contact_lines_that_may_trip_and_do_not_change_nothing_but_roundings():
    """Their sections have nodes of their own, which follow those where they hang."""
    wire = {**library.values("catenaries", "AT"), "rating": {**WIRE, "continuous_a": 4000.0}}
    guarded, plain = supplied(catenary=wire), supplied(catenary="AT")
    assert "trips" not in guarded.summary
    volts, other = (each.dataset.pantograph_voltage for each in (guarded, plain))
    np.testing.assert_allclose(volts, other, rtol=1e-7)
    nodes = guarded.dataset.node_voltage.to_pandas()
    for end in ("0", "80"):
        own, place = (f"contact line at {end} km{words}" for words in (", of 0-80 km", ""))
        np.testing.assert_allclose(nodes[own], nodes[place], rtol=1e-9)


def test_a_track_trips_alone_where_tracks_are_not_tied():
    """Coupled with the other one, whose trains go on until that trips too."""
    later = [{**each, "departures_min": [4.0 * k]} for k, each in enumerate(BOTH_WAYS)]
    found = double_track("no", later, mutual_x_ohm_per_km=0.03)
    found["supply"]["catenary"]["rating"] = {**WIRE, "continuous_a": 60.0}
    found["protection"] = {"trip": True}
    result = run(found)
    keep_the_rules(result)
    first, second = result.summary["trips"]
    out = int(first["element"][-1])
    assert first["element"] == f"contact line 0-40 km, track {out}"
    assert second["element"] == f"contact line 0-40 km, track {3 - out}"
    between = slice(*(round(trip["time_min"] / 0.1) for trip in (first, second)))
    data = result.dataset
    volts, track = data.pantograph_voltage.to_numpy()[between], data.train_track.to_numpy()[between]
    km = data.position.to_numpy()[between] / 1e3
    inside = (km > 0.01) & (km < 39.99) & np.isfinite(volts)
    assert (volts[inside & (track == out)] == 0.0).all()
    assert (volts[inside & (track != out)] > 0.0).all()
    assert (inside & (track == out)).any()
    assert (inside & (track != out)).any()


def test_a_station_of_several_types_trips_once_one_of_them_bears_too_much():
    """The weaker type, of 1 MVA, takes a part of the load by its droop and reactance, not its rating."""
    rating = {"time_constant_min": 30.0, "overloads": OVERLOADS}
    weak = {**Q48, "rating_mva": 1.0, "rating": rating}
    units = [{"type": Q48, "converters": 2}, {"type": weak, "converters": 1}]
    result = supplied(mixed_stations=[{"name": "Middle", "position_km": 40.0, "units": units}])
    (trip,) = result.summary["trips"]
    assert trip["element"] == "Middle"
    (k,) = (k for k, each in enumerate(result.equipment.elements) if "type 2" in each.name)
    load = result.equipment.load[:, k]
    assert trip["time_min"] == pytest.approx(slow_trip_min(load, 0.1, 110.0, 2.0))
    assert (load[round(trip["time_min"] / 0.1) :] == 0.0).all()


def test_a_table_of_outages_says_what_trips_and_what_converters_lose():
    """The trips of each case are those of its own run."""
    document = copy.deepcopy(THREE)
    document["simulation"]["duration_min"] = 20.0
    stations = [
        station("West", 0.0, 900.0),
        station("Middle", 40.0, 120.0, mva=11.0),
        station("East", 80.0, 900.0),
    ]
    for each in stations:
        each["type"]["losses"] = {"idle_kw": 100.0}
    document["supply"]["converter_stations"] = stations
    document["protection"] = {"trip": True}
    document["outages"] = [{"name": "no West", "stations": ["West"], "from_min": 2.0}]
    scenario = tpss.Scenario.from_document(document, "three")
    found = tpss.compare_outages(scenario, threads=1)
    result = tpss.simulate(scenario.with_outage("no West"))
    (trip,) = result.summary["trips"]
    table = found.table().set_index("outage")
    assert table.trips["intact"] == ""
    assert table.trips["no West"] == f"Middle {trip['time_min']:.1f} min"
    losses = result.summary["converter_losses"]["losses_mwh"]
    assert table.converter_losses_mwh["no West"] == pytest.approx(losses)
    assert table.converter_losses_mwh_change["no West"] < 0.0
    assert Verdict.TRIPPED < Verdict.OVERLOAD < Verdict.KEPT
    page = outages_report(found)
    assert f"Middle {trip['time_min']:.1f} min" in page
    assert "converter losses [MWh]" in page


def test_without_overloads_and_with_steps_protection_is_a_fault():
    with pytest.raises(
        tpss.ScenarioError, match="nothing of the supply has a rating with overloads"
    ):
        simulated({"name": "West", "position_km": 0.0, "type": "Q48/Q49", "converters": 2})
    stepped = {"protection.trip": True, "simulation.motion": "stepped"}
    assert finding_at("protection.trip", faults_of(stepped))
