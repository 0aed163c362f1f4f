"""What headings mean: three languages, capitals, accents, and units at any place."""

import pytest

from tpss.tables.aliases import ALIASES, meaning_of
from tpss.tables.kinds import GRADIENTS, KINDS, SPEED_LIMITS, STATIONS, TIMETABLE


@pytest.mark.parametrize(
    ("heading", "quantity", "factor"),
    [
        ("position_km", "position", 1.0), ("km", "position", 1.0), ("Kilometer", "position", 1.0),
        ("Position [m]", "position", 1e-3), ("chainage m", "position", 1e-3),
        ("gradient_permille", "gradient", 1.0), ("Neigung", "gradient", 1.0),
        ("Steigung [%]", "gradient", 10.0), ("lutning ‰", "gradient", 1.0),
        ("Längsneigung (mm/m)", "gradient", 1.0), ("altitude_m", "altitude", 1.0),
        ("elevation_m", "altitude", 1.0), ("Hoehe", "altitude", 1.0), ("HÖHE [m]", "altitude", 1.0),
        ("Höhe in m", "altitude", 1.0), ("Höhe m ü. NN", "altitude", 1.0), ("höjd", "altitude", 1.0),
        ("elevation (ft)", "altitude", 0.3048),
    ],
)  # fmt: skip
def test_headings_of_gradients(heading, quantity, factor):
    meaning = meaning_of(heading, GRADIENTS.quantities)
    assert (meaning.quantity, meaning.factor) == (quantity, factor)


@pytest.mark.parametrize(
    ("heading", "quantity"),
    [("von km", "position"), ("km bis", "end"), ("to_km", "end"), ("till [km]", "end"),
     ("V (km/h)", "speed_limit"), ("sth", "speed_limit"), ("Hastighet km/h", "speed_limit"),
     ("zulässige Geschwindigkeit", None), ("km", "position"), ("speed [mph]", "speed_limit")],
)  # fmt: skip
def test_headings_of_speed_limits(heading, quantity):
    meaning = meaning_of(heading, SPEED_LIMITS.quantities)
    assert (meaning and meaning.quantity) == quantity


@pytest.mark.parametrize("heading", ["m", "meter", "remark", ""])
def test_what_may_be_two_things_or_nothing_is_not_guessed(heading):
    assert meaning_of(heading, GRADIENTS.quantities) is None


@pytest.mark.parametrize("heading", ["Bahnhof", "Driftplats", "name", "STATION"])
def test_headings_of_stations(heading):
    assert meaning_of(heading, STATIONS.quantities).quantity == "station"


@pytest.mark.parametrize(
    ("heading", "quantity"),
    [("Zug", "train_name"), ("Ankunft", "arrival"), ("avgång", "departure"), ("train", "train_type"),
     ("min_dwell_s", "dwell"), ("Haltezeit [min]", "dwell")],
)  # fmt: skip
def test_headings_of_timetables(heading, quantity):
    assert meaning_of(heading, TIMETABLE.quantities).quantity == quantity


@pytest.mark.parametrize("kind", KINDS.values(), ids=lambda kind: kind.name)
def test_own_headings_mean_what_they_say_without_another_unit(kind):
    for name in kind.quantities:
        meaning = meaning_of(ALIASES[name].key, kind.quantities)
        assert (meaning.quantity, meaning.factor) == (name, 1.0)
