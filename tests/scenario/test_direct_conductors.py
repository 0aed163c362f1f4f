"""A contact line of direct current by its conductors: wear, temperature, and what cannot be."""

from typing import Any

import pytest

import tpss
from tpss import library
from tpss.scenario.supply import Catenary
from tpss.scenario.supply.direct_conductors import DirectContactLine, RunningRails

from direct_scenarios import direct_document

PARTS = {"contact_line": "C120-2C", "rails": "PKP-S60"}


def scenario(catenary: dict[str, Any], system: str = "DC-3kV") -> tpss.Scenario:
    document = direct_document(system)
    document["supply"]["catenary"] = catenary
    return tpss.Scenario.from_document(document)


def test_contact_line_and_rails_are_in_series() -> None:
    """0.0613 + 0.0110 ohm/km."""
    assert scenario(PARTS).supply.catenary.r_ohm_per_km == pytest.approx(0.0723, abs=1e-12)


def test_wear_takes_conductance_from_the_contact_wires_alone() -> None:
    """62.5 % of the conductance wears by 20 %: 0.0613 / (1 - 0.125) = 0.070057 ohm/km."""
    own = DirectContactLine.model_validate(library.values("contact_lines", "C120-2C"))
    assert own.worn_ohm_per_km(20.0, 20.0) == pytest.approx(0.0613 / 0.875, rel=1e-12)
    third_rail = library.values("contact_lines", "third-rail-ASCR-4900")
    unworn = DirectContactLine.model_validate(third_rail)
    assert unworn.worn_ohm_per_km(20.0, 20.0) == 0.0067


def test_copper_and_steel_have_more_resistance_when_they_are_warm() -> None:
    """At 60 °C 1 + 0.0038 x 40 = 1.152 for copper, at 30 °C 1 + 0.005 x 10 = 1.05 for rails."""
    warm = {**PARTS, "conductor_temperature_c": 60.0, "rails_temperature_c": 30.0}
    expected = 0.0613 * 1.152 + 0.0110 * 1.05
    assert scenario(warm).supply.catenary.r_ohm_per_km == pytest.approx(expected, rel=1e-12)


def test_as_two_parallel_wires_of_which_one_wears() -> None:
    """0.124 beside a contact wire of 0.166 / 2 ohm/km, a quarter of it worn: 0.124 || 0.083 / 0.75."""
    own = DirectContactLine.model_validate(library.values("contact_lines", "CA-160-3kV"))
    worn_ohm = 0.083 / 0.75
    expected = 1.0 / (1.0 / 0.124 + 1.0 / worn_ohm)
    assert own.worn_ohm_per_km(25.0, 20.0) == pytest.approx(expected, rel=2e-3)


def test_the_scenario_as_run_has_the_resistance_and_its_parts() -> None:
    made = scenario({**PARTS, "wear_percent": 15.0})
    catenary = made.as_document()["supply"]["catenary"]
    assert catenary["wear_percent"] == 15.0
    assert catenary["r_ohm_per_km"] == made.supply.catenary.r_ohm_per_km
    assert tpss.Scenario.from_document(made.as_document()) == made


def test_a_changed_state_changes_the_resistance() -> None:
    made = scenario(PARTS).with_({"supply.catenary.wear_percent": 20.0})
    assert made.supply.catenary.r_ohm_per_km == pytest.approx(0.0613 / 0.875 + 0.0110)


def test_a_stretch_may_have_conductors_of_its_own() -> None:
    document = direct_document("DC-3kV")
    document["supply"]["contact_lines"] = [{"from_km": 2.0, "to_km": 4.0, "catenary": PARTS}]
    made = tpss.Scenario.from_document(document)
    stretch = made.supply.contact_lines[0].catenary
    assert stretch is not None
    assert stretch.r_ohm_per_km == pytest.approx(0.0723)
    assert tpss.simulate(made).audit["passed"]


def test_the_same_resistance_gives_the_same_run() -> None:
    one, other = (
        tpss.simulate(scenario(each)) for each in (PARTS, {"r_ohm_per_km": 0.0613 + 0.0110})
    )
    voltage = "lowest_voltage"
    assert one.summary[voltage] == other.summary[voltage]


@pytest.mark.parametrize("kind", ["contact_lines", "rails"])
def test_entries_of_the_library_are_resistances_of_their_kind(kind: str) -> None:
    part = {"contact_lines": DirectContactLine, "rails": RunningRails}[kind]
    for name, entry in library.entries(kind).items():
        found = part.model_validate(library.values(kind, name))
        assert 0.005 <= found.r_ohm_per_km <= 0.15, name  # type: ignore[attr-defined]
        assert entry["source"]


def test_both_figures_of_the_same_rails_are_told_with_their_doubt() -> None:
    """0.22 against 0.17 ohm mm²/m: 0.0143 and 0.0110 ohm/km of 60E1."""
    rails = library.entries("rails")
    ratio = rails["PKP-S60"]["r_ohm_per_km"] / rails["60E1"]["r_ohm_per_km"]
    assert ratio == pytest.approx(0.17 / 0.22, rel=0.01)
    assert all("doubt" in each["source"] for each in rails.values())


FAULTS = {
    "no way back": ({"contact_line": "C120-2C"}, "contact_line alone, and the current flows there and"),
    "no way there": ({"rails": "60E1"}, "rails alone"),
    "two descriptions": ({**PARTS, "r_ohm_per_km": 0.1}, "beside contact_line and rails, which have"),
    "wear of nothing": ({"r_ohm_per_km": 0.1, "wear_percent": 9.0}, "wear_percent without contact_line"),
    "nothing": ({}, "supply.catenary.r_ohm_per_km\n    it is missing"),
    "an unknown wire": ({**PARTS, "contact_line": "C120"}, "no such entry in contact_lines"),
    "too much wear": ({**PARTS, "wear_percent": 90.0}, "supply.catenary.wear_percent = 90"),
    "no rails at all": ({**PARTS, "rails": {"r_ohm_per_km": 0.0}}, "supply.catenary.rails.r_ohm_per_km"),
}  # fmt: skip


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_told_once_with_its_place(name: str) -> None:
    catenary, said = FAULTS[name]
    with pytest.raises(tpss.ScenarioError) as caught:
        scenario(catenary)
    assert said in str(caught.value)
    assert len(caught.value.findings) == 1


def test_an_alternating_current_has_no_such_conductors() -> None:
    given = tpss.load_scenario("examples/emu_25kv.toml")
    with pytest.raises(tpss.ScenarioError, match="beside the system 25kV-50Hz, none of direct"):
        given.with_({"supply.catenary": {**PARTS, "x_ohm_per_km": 0.4}})


def test_a_file_may_hold_them(tmp_path) -> None:
    (tmp_path / "wires.toml").write_text("r_ohm_per_km = 0.05\n", "utf-8")
    document = direct_document("DC-3kV")
    document["supply"]["catenary"] = {"contact_line": "wires.toml", "rails": "60E1"}
    made = tpss.Scenario.from_document(document, tmp_path / "line.toml")
    assert made.supply.catenary.r_ohm_per_km == pytest.approx(0.0643)
    assert isinstance(made.supply.catenary, Catenary)


def test_a_published_line_as_a_scenario() -> None:
    """[Yoo2024], Table 5: fed from one end, a train of 1000 A at 6 km has 3013.89 V.

    Contact line C120-2C, rails S60 with the earth of 0.46 ohm/km beside them, cables of 0.05138 ohm.
    The train dwells there, with auxiliaries of that power.
    """
    document = direct_document("DC-3kV")
    stations = [("A", 0.0), ("P", 6.0), ("B", 8.0)]
    document["line"] |= {
        "length_km": 8.0,
        "tracks": 1,
        "stations": [{"name": name, "position_km": km} for name, km in stations],
    }
    earthed = 0.011 * 0.46 / (0.011 + 0.46)
    document["supply"] = {
        "system": "DC-3kV",
        "catenary": {
            "contact_line": "C120-2C",
            "rails": {"r_ohm_per_km": earthed},
            "connection_r_ohm": 0.05138194444,
        },
        "rectifier_stations": [
            {"name": "West", "position_km": 0.0, "type": {
                "no_load_voltage_kv": 3.571254869, "resistance_ohm": 0.07372108531,
                "rated_current_a": 3400.0}},
        ],
    }  # fmt: skip
    del document["trains"]["unit"]["regeneration"]
    document["trains"]["unit"]["auxiliary_power_kw"] = 3013.89
    stop = {"station": "P", "dwell_min": 5.0}
    document["traffic"] = [
        {
            "name": "up",
            "train": "unit",
            "from": "A",
            "to": "B",
            "stops": [stop],
            "departures_min": [0.0],
        }
    ]
    result = tpss.simulate(tpss.Scenario.from_document(document))
    stands = result.dataset.speed.to_numpy()[:-1, 0] == 0.0
    at_stop = stands & (abs(result.dataset.position.to_numpy()[:-1, 0] - 6000.0) < 1.0)
    voltage_v = result.dataset.pantograph_voltage.to_numpy()[:-1, 0][at_stop]
    assert len(voltage_v) > 10
    assert voltage_v[1:-1] == pytest.approx(3013.89, abs=0.02)
