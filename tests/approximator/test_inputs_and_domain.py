"""What of a table becomes an input, and where an approximator may be asked."""

import numpy as np
import pytest

import tpss
from tpss.approximator.domain import domain_of
from tpss.approximator.forms import FORMS, with_traffic
from tpss.approximator.inputs import inputs_of_table

from made_up_studies import made_up_table

AGGREGATED = FORMS["aggregated"]


def inputs_of(table):
    return inputs_of_table(with_traffic(table), AGGREGATED)


def test_what_varies_is_an_input_and_what_follows_from_it_is_a_multiple():
    inputs = inputs_of(made_up_table(300))
    assert [each.name for each in inputs.varying] == [
        "station_distance_km",
        "converters_per_station",
        "transformers",
        "headway_min",
        "speed_limit_kmh",
        "gradient_mean_permille",
        "gradient_std_permille",
        "catenary",
        "high_voltage_line",
    ]
    assert {each.name: (each.of, each.factor) for each in inputs.multiples} == {
        "length_km": ("station_distance_km", 1.0),
        "route_km": ("station_distance_km", 1.0),
        "converters": ("converters_per_station", 2.0),
        "converter_rating_mva": ("converters_per_station", 20.0),
        "mean_speed_limit_kmh": ("speed_limit_kmh", 1.0),
    }
    assert inputs.fixed == {
        "converter_stations": 2.0,
        "stops": 0.0,
        "train_mass_t": 1470.0,
        "max_motor_current_a": 1250.0,
    }


def test_catenaries_of_ones_own_are_told_apart_by_their_impedances():
    table = made_up_table(300)
    table.loc[table["catenary"] == "BT", "catenary"] = "own"
    names = [each.name for each in inputs_of(table).varying]
    assert "catenary" not in names
    assert "catenary_r_ohm_per_km" in names


def test_inputs_are_scaled_to_plus_and_minus_one():
    table = made_up_table(300)
    inputs = inputs_of(table)
    columns = {each.name: table[each.name] for each in inputs.varying}
    x = inputs.encode(inputs.read(columns, "table").inputs)
    assert x.shape == (300, inputs.width)
    assert x.min(axis=0) == pytest.approx(-1.0)
    assert x.max(axis=0) == pytest.approx(1.0)


def test_an_input_that_lacks_values_is_refused():
    table = made_up_table(300)
    table.loc[:2, "headway_min"] = np.nan
    with pytest.raises(tpss.ApproximatorError, match=r"headway_min in 3 case\(s\)"):
        inputs_of(table)


def test_the_original_form_asks_for_number_and_speed_of_the_trains():
    """10 trains an hour over 100 km at 80 km/h: 10 · 100 / 80 = 12.5 trains."""
    table = with_traffic(made_up_table(300).assign(trains_per_h=10.0, route_km=100.0))
    table = with_traffic(table.assign(mean_speed_limit_kmh=80.0))
    assert table["trains"].unique() == pytest.approx(12.5)
    varying = inputs_of_table(with_traffic(made_up_table(300)), FORMS["original"]).varying
    assert {"trains", "trains_speed_kmh"} <= {each.name for each in varying}
    assert "headway_min" not in {each.name for each in varying}


ASKED = {
    "station_distance_km": 100.0,
    "converters_per_station": 4,
    "headway_min": 12.0,
    "speed_limit_kmh": 80.0,
    "gradient_mean_permille": 0.0,
    "gradient_std_permille": 1.0,
    "catenary": "BT",
    "high_voltage_line": True,
    "transformers": 3,
}


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({}, ""),
        ({"train_mass_t": 1470.0, "length_km": 100.0}, ""),
        ({"station_distance_km": 170.0}, "station_distance_km = 170: trained at 60"),
        ({"catenary": "XT"}, "catenary = XT: trained at AT or BT"),
        ({"train_mass_t": 1200.0}, "train_mass_t = 1200: trained at 1470 only"),
        ({"length_km": 120.0}, "length_km = 120: it was always 1 times station_distance_km"),
        ({"transformers": 0}, "transformers = 0 with catenary = BT: never seen together"),
    ],
)
def test_each_row_outside_the_trained_region_says_why(changes, words):
    table = made_up_table(600)
    inputs = inputs_of(table)
    trained = inputs.read({each.name: table[each.name] for each in inputs.varying}, "table")
    domain = domain_of(trained.inputs, inputs)
    asked = {name: [value] for name, value in {**ASKED, **changes}.items()}
    (told,) = domain.objections(inputs.read(asked, "here"), inputs)
    assert told.startswith(words)
    assert bool(told) == bool(words)


def test_the_cases_trained_on_lie_inside():
    table = made_up_table(600)
    inputs = inputs_of(table)
    columns = {each.name: table[each.name].to_numpy() for each in inputs.varying}
    given = inputs.read(columns, "table")
    assert not any(domain_of(given.inputs, inputs).objections(given, inputs))
