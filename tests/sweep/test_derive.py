"""Scenarios of cases are the base scenario with the values in their places, and stay valid."""

import math

import numpy as np
import pytest

from sweep.studies import study
from tpss import Scenario, simulate
from tpss.scenario.paths import places_of
from tpss.sweep.derive import scenario_of
from tpss.sweep.design import design_of
from tpss.sweep.inputs import inputs_of
from tpss.sweep.lengths import PLACES

from properties.kilometres import moved
from scenarios import SHORT_LINE, short_line

HIGH_VOLTAGE = {"type": "132kV", "transformers_km": [5.0, 15.0]}
DRAWN = {
    "mean_permille": [1.5],
    "standard_deviation_permille": [4.0],
    "piece_km": 0.3,
    "correlation_km": 2.0,
}


def first(tmp_path, changes) -> Scenario:
    return scenario_of(design_of(study(tmp_path, changes)), 0)


def test_a_case_is_the_scenario_that_with_gives(tmp_path):
    """Case 4 of the grid: headway 10 min, two converters in each of both stations."""
    expected = short_line(
        {
            "simulation.time_step_min": 0.5,
            "simulation.duration_min": 10.0,
            "traffic.0.headway_min": 10.0,
            "supply.converter_stations.0.converters": 2,
            "supply.converter_stations.1.converters": 2,
        }
    )
    case = scenario_of(design_of(study(tmp_path)), 4)
    assert case.name == "small-4"
    assert case.digest() == expected.digest()
    assert case.digest() != short_line().digest()


def test_a_star_means_every_item():
    places = places_of(SHORT_LINE, "supply.converter_stations.*.converters")
    assert list(places) == [f"supply.converter_stations.{i}.converters" for i in (0, 1)]
    assert list(places_of(SHORT_LINE, "trains.*.mass_t")) == ["trains.freight.mass_t"]
    assert list(places_of(SHORT_LINE, "traffic.*.stops.*.dwell_min")) == []
    assert list(places_of(SHORT_LINE, "nothing.*.here")) == []


def test_what_stands_along_a_shorter_line_moves_and_the_ground_stays(tmp_path):
    """From 20 to 5 km, positions are a quarter; the hill from km 2 on stays where it is."""
    places = {
        "supply.high_voltage_line": HIGH_VOLTAGE,
        "line.gradients": [{"from_km": 0.0, "permille": 0.0}, {"from_km": 2.0, "permille": 5.0}],
        "line.speed_limits": [
            {"from_km": 0.0, "speed_kmh": 60.0}, {"from_km": 8.0, "speed_kmh": 40.0}
        ],
        "traffic.0.initial_trains": [{"position_km": 4.0, "speed_kmh": 10.0}],
        "standards.zones": [{"name": "all", "from_km": 0.0, "to_km": 20.0}],
    }  # fmt: skip
    case = first(tmp_path, {"set": places, "vary": {"line.length_km": [5.0]}})
    assert case.line.length_km == 5.0
    assert [station.position_km for station in case.line.stations] == [0.0, 2.5, 5.0]
    assert [s.position_km for s in case.supply.converter_stations] == [0.0, 5.0]
    assert case.supply.high_voltage_line.transformers_km == (1.25, 3.75)
    assert [limit.from_km for limit in case.line.speed_limits] == [0.0, 2.0]
    assert case.traffic[0].initial_trains[0].position_km == 1.0
    assert case.standards.zones[0].to_km == 5.0
    assert [gradient.from_km for gradient in case.line.gradients] == [0.0, 2.0]


@pytest.mark.parametrize("length_km", [0.1, 7.3, 12.34567, 33.333, 199.9])
def test_what_stands_at_the_end_stands_there_exactly(tmp_path, length_km):
    case = first(tmp_path, {"vary": {"line.length_km": [length_km]}})
    assert case.line.stations[-1].position_km == length_km


@pytest.mark.parametrize(
    ("setting", "gone"),
    [
        ({"supply.high_voltage_line.transformers": 3}, "supply.high_voltage_line.transformers_km"),
        ({"traffic.0.departures_min": [0.0, 5.0]}, "traffic.0.headway_min"),
    ],
)
def test_a_key_takes_the_place_of_its_alternative(tmp_path, setting, gone):
    base = {"supply.high_voltage_line": HIGH_VOLTAGE, "simulation.time_step_min": 0.5}
    choices = {"way": {"other": setting}}
    case = first(tmp_path, {"set": base, "vary": None, "choices": choices})
    document = case.as_document()
    for key in gone.split("."):
        document = document[int(key)] if isinstance(document, list) else document.get(key)
    assert document is None


def test_choices_put_what_belongs_together_and_none_leaves_out(tmp_path):
    choices = {
        "supply": {
            "BT alone": {"supply.catenary": "BT", "supply.high_voltage_line": "none"},
            "AT, 132 kV": {"supply.catenary": "AT", "supply.high_voltage_line.base_kv": 130.0},
        }
    }
    changes = {"set": {"supply.high_voltage_line": HIGH_VOLTAGE}, "vary": None, "choices": choices}
    design = design_of(study(tmp_path, changes))
    alone, with_line = (scenario_of(design, case) for case in range(2))
    assert alone.supply.high_voltage_line is None
    assert with_line.supply.high_voltage_line.base_kv == 130.0
    assert (inputs_of(alone).catenary, inputs_of(with_line).catenary) == ("BT", "AT")


def test_a_drawn_profile_has_exactly_its_mean_and_standard_deviation(tmp_path):
    """Over a line of 20.2 km in pieces of 0.3 km, of which the last is 0.1 km long."""
    changes = {"vary": {"line.length_km": [20.2]}, "gradients": DRAWN}
    inputs = inputs_of(first(tmp_path, changes))
    assert inputs.gradient_mean_permille == pytest.approx(1.5, abs=1e-12)
    assert inputs.gradient_std_permille == pytest.approx(4.0, abs=1e-12)


def test_neighbouring_gradients_are_correlated_as_asked(tmp_path):
    """1 km apart at a correlation length of 2 km: exp(-1/2) = 0.61; 6,666 pieces tell it to 0.03."""
    changes = {
        "vary": {"line.length_km": [2000.0]},
        "gradients": DRAWN | {"piece_km": 0.3, "correlation_km": 2.0},
    }
    rises = np.array([g.permille for g in first(tmp_path, changes).line.gradients])
    assert np.corrcoef(rises[:-1], rises[1:])[0, 1] == pytest.approx(math.exp(-0.15), abs=0.03)
    assert np.corrcoef(rises[:-10], rises[10:])[0, 1] == pytest.approx(math.exp(-1.5), abs=0.1)


def test_each_case_has_its_own_profile_unless_profiles_are_numbered(tmp_path):
    own = design_of(study(tmp_path, {"gradients": DRAWN}))
    assert scenario_of(own, 0).line.gradients != scenario_of(own, 1).line.gradients
    assert scenario_of(own, 1).line.gradients == scenario_of(own, 1).line.gradients
    numbered = design_of(study(tmp_path, {"gradients": {**DRAWN, "profile": [7, 8]}}))
    profiles = [scenario_of(numbered, case).line.gradients for case in range(4)]
    assert profiles[0] == profiles[2] != profiles[1] == profiles[3]


def test_inputs_are_those_of_the_derived_scenario():
    """Hand calculation of every input of a made-up line.

    Stations at 0 and 20 km, transformers at 5 and 15 km: feeding points 20 / 3 km apart. Limits 60 and
    40 km/h over 8 and 12 km: mean 48. Rises of 0 and 5 ‰ over 2 and 18 km: mean 4.5, standard
    deviation √(0.1 · 4.5² + 0.9 · 0.5²) = 1.5. `test_gradients.py` has the others.
    """
    scenario = short_line(
        {
            "supply.high_voltage_line": HIGH_VOLTAGE,
            "line.gradients": [
                {"from_km": 0.5, "permille": 0.0},
                {"from_km": 2.0, "permille": 5.0},
                {"from_km": 30.0, "permille": 50.0},
            ],
            "line.speed_limits": [
                {"from_km": 0.0, "speed_kmh": 60.0},
                {"from_km": 8.0, "speed_kmh": 40.0},
            ],
            "supply.converter_stations.1.converters": 5,
            "traffic.0.stops": [{"station": "Middle", "dwell_min": 1.0}],
        }
    )
    found = inputs_of(scenario)
    assert (found.length_km, found.route_km, found.stops) == (20.0, 20.0, 1)
    assert (found.converter_stations, found.converters, found.transformers) == (2, 7, 2)
    assert found.station_distance_km == found.longest_station_distance_km == 20.0
    assert found.feeding_distance_km == pytest.approx(20.0 / 3.0)
    assert found.converters_per_station == 3.5
    assert found.converter_rating_mva == 70.0
    assert (found.catenary, found.high_voltage_line) == ("BT", True)
    assert (found.headway_min, found.trains_per_h) == (60.0, 1.0)
    assert (found.speed_limit_kmh, found.mean_speed_limit_kmh) == (60.0, pytest.approx(48.0))
    assert found.train_mass_t == 1470.0
    assert found.gradient_mean_permille == pytest.approx(4.5)
    assert found.gradient_std_permille == pytest.approx(1.5)
    assert found.steepest_permille == 5.0
    assert found.time_step_min == 0.05


def test_derived_scenarios_run(tmp_path):
    """A quarter of the line in ten minutes at 60 km/h: the train has arrived by then."""
    changes = {"vary": {"line.length_km": [5.0]}, "gradients": DRAWN | {"mean_permille": [0.0]}}
    assert simulate(first(tmp_path, changes)).trips.arrival_min.notna().any()


def test_every_position_but_that_of_the_ground_moves_with_the_end_of_the_line():
    assert set(PLACES) == {
        "line.stations.*.position_km",
        "line.curves.*.from_km",
        "line.curves.*.to_km",
        "line.speed_limits.*.from_km",
        "line.speed_limits_down.*.from_km",
        "line.tracks.*.from_km",
        "supply.converter_stations.*.position_km",
        "supply.transformer_stations.*.position_km",
        "supply.high_voltage_line.transformers_km.*",
        "supply.mixed_stations.*.position_km",
        "supply.rectifier_stations.*.position_km",
        "supply.contact_lines.*.from_km",
        "supply.contact_lines.*.to_km",
        "supply.posts.*.position_km",
        "supply.section_breaks.*.position_km",
        "supply.neutral_sections.*.from_km",
        "supply.neutral_sections.*.to_km",
        "supply.storage.*.position_km",
        "supply.without_contact_line.*.from_km",
        "supply.without_contact_line.*.to_km",
        "supply.autotransformers.*.positions_km.*",
        "outages.*.transformers_km.*",
        "outages.*.autotransformers.*.position_km",
        "outages.*.sections.*.from_km",
        "outages.*.sections.*.to_km",
        "traffic.*.initial_trains.*.position_km",
        "standards.zones.*.from_km",
        "standards.zones.*.to_km",
    }


def test_what_moves_with_the_length_keeps_its_share_of_the_way_from_the_beginning(tmp_path):
    """From 438 to 458 km; at 5 km, a quarter of it, the middle station stands 2.5 km on."""
    places = {
        "line": moved(SHORT_LINE, 438.1)["line"],
        "supply": moved(SHORT_LINE, 438.1)["supply"],
        "standards.zones": [{"name": "all", "from_km": 438.1, "to_km": 458.1}],
    }
    case = first(tmp_path, {"set": places, "vary": {"line.length_km": [5.2]}})
    assert (case.line.begins_at_km, case.line.end_km) == (438.1, 443.3)
    assert [s.position_km for s in case.line.stations] == pytest.approx([438.1, 440.7, 443.3])
    assert case.line.stations[-1].position_km == 443.3
    assert [s.position_km for s in case.supply.converter_stations] == [438.1, 443.3]
    assert [limit.from_km for limit in case.line.speed_limits] == [438.1]
    assert case.standards.zones[0].to_km == 443.3


def test_a_profile_is_drawn_from_where_the_line_begins(tmp_path):
    """Inputs of a case are those of the same line from 0 on."""
    cases = []
    for begin_km in (0.0, -7.5):
        places = {key: moved(SHORT_LINE, begin_km)[key] for key in ("line", "supply")}
        cases.append(first(tmp_path, {"set": places, "vary": None, "gradients": DRAWN}))
    assert [case.line.gradients[0].from_km for case in cases] == [0.0, -7.5]
    here, there = (inputs_of(case)._asdict() for case in cases)
    assert there.pop("catenary") == here.pop("catenary")
    assert there == pytest.approx(here, rel=1e-9, abs=1e-12, nan_ok=True)
