"""Libraries of one's own: their entries add to the shipped ones, and a scenario keeps what it took."""

import copy
import os

import pytest
import tomli_w

import tpss
from tpss import library
from tpss.conductors.load import geometry_of
from tpss.scenario.own_library import KINDS, NOT_OWN, VARIABLE, own_entries, using

from scenarios import SHORT_LINE

AT = library.values("catenaries", "AT")


@pytest.fixture
def scenario_file(tmp_path):
    file = tmp_path / "line.toml"
    file.write_text(tomli_w.dumps(SHORT_LINE), "utf-8")
    return file


@pytest.fixture
def write(tmp_path):
    """Writes entries of a kind into the library `own`, and returns that folder."""

    def write_kind(kind, entries):
        folder = tmp_path / "own"
        folder.mkdir(exist_ok=True)
        (folder / f"{kind}.toml").write_text(tomli_w.dumps(entries), "utf-8")
        return folder

    return write_kind


def catenary_of(scenario):
    return scenario.as_document()["supply"]["catenary"]


def faults(folder):
    with using(folder), pytest.raises(tpss.ScenarioError) as caught:
        own_entries()
    return [(f.key, f.value, f.problem, f.remedy) for f in caught.value.findings]


def test_an_entry_of_ones_own_is_its_values(scenario_file, write):
    own = write("catenaries", {"ours": {"r_ohm_per_km": 0.1, "x_ohm_per_km": 0.2, "source": "us"}})
    named = tpss.load_scenario(scenario_file, {"supply.catenary": "ours"}, library=own)
    given = {"r_ohm_per_km": 0.1, "x_ohm_per_km": 0.2}
    assert named == tpss.load_scenario(scenario_file, {"supply.catenary": given})


def test_an_entry_takes_over_what_it_does_not_give(scenario_file, write):
    """Key by key, and through several entries: the last one has its own x and the r of the second."""
    entries = {
        "second": {"based_on": "AT", "r_ohm_per_km": 0.03},
        "third": {"based_on": "second", "x_ohm_per_km": 0.05},
    }
    own = write("catenaries", entries)
    scenario = tpss.load_scenario(scenario_file, {"supply.catenary": "third"}, library=own)
    expected = {**AT, "r_ohm_per_km": 0.03, "x_ohm_per_km": 0.05}
    assert scenario == tpss.load_scenario(scenario_file, {"supply.catenary": expected})


def test_a_shipped_name_is_taken_by_an_entry_based_on_it_only_and_that_is_told(
    scenario_file, write
):
    own = write("catenaries", {"BT": {"based_on": "BT", "r_ohm_per_km": 0.3}})
    scenario = tpss.load_scenario(scenario_file, {"supply.catenary": "BT"}, library=own)
    assert catenary_of(scenario)["r_ohm_per_km"] == 0.3
    assert "BT is that of" in scenario.file_notes[0]
    (fault,) = faults(write("catenaries", {"BT": {"r_ohm_per_km": 0.3, "x_ohm_per_km": 0.3}}))
    assert fault[0] == "BT"
    assert 'based_on = "BT"' in fault[3]


def test_a_locomotive_and_a_train_s_own_keys(scenario_file, write):
    own = write("locomotives", {"heavy": {"based_on": "Rc4-freight-1470t", "mass_t": 1700.0}})
    changes = {"trains.freight": {"model": "heavy", "max_speed_kmh": 90.0}}
    train = tpss.load_scenario(scenario_file, changes, library=own).trains["freight"]
    assert (train.mass_t, train.max_speed_kmh, train.adhesive_mass_t) == (1700.0, 90.0, 79.0)


def test_a_curve_of_an_entry_lies_beside_its_file(scenario_file, write):
    effort = {"curve_file": "effort.csv"}
    own = write(
        "locomotives", {"mine": {"based_on": "Rc4-freight-1470t", "tractive_effort": effort}}
    )
    (own / "effort.csv").write_text("speed_kmh,force_kn\n0,200\n60,200\n120,100\n", "utf-8")
    scenario = tpss.load_scenario(
        scenario_file,
        {"trains.freight": {"model": "mine", "power_factor": 1.0}},
        library=own,
    )
    assert scenario.trains["freight"].tractive_effort.force_kn[0] == 200.0


def test_a_saved_scenario_needs_no_library(scenario_file, write, tmp_path):
    own = write("locomotives", {"heavy": {"based_on": "Rc4-freight-1470t", "mass_t": 1700.0}})
    write("catenaries", {"ours": {"based_on": "AT"}})
    changes = {"supply.catenary": "ours", "trains.freight.model": "heavy"}
    scenario = tpss.load_scenario(scenario_file, changes, library=own)
    saved = scenario.save(tmp_path / "saved.toml")
    assert tpss.load_scenario(saved) == scenario


def test_changed_copies_know_the_library_too(scenario_file, write):
    own = write("catenaries", {"ours": {"based_on": "AT"}})
    scenario = tpss.load_scenario(scenario_file, library=own)
    assert catenary_of(scenario.with_({"supply.catenary": "ours"}))["r_ohm_per_km"] == 0.0335
    with pytest.raises(tpss.ScenarioError, match="no such entry in catenaries"):
        tpss.load_scenario(scenario_file).with_({"supply.catenary": "ours"})


def test_the_environment_names_a_library_or_else_the_user_has_one(
    scenario_file, write, monkeypatch, tmp_path
):
    changes = {"supply.catenary": "ours"}
    own = write("catenaries", {"ours": {"based_on": "AT"}})
    monkeypatch.setenv(VARIABLE, str(own))
    assert tpss.load_scenario(scenario_file, changes)
    monkeypatch.delenv(VARIABLE)
    monkeypatch.setattr("tpss.scenario.own_library.user_folder", lambda: tmp_path / "of-the-user")
    with pytest.raises(tpss.ScenarioError, match="no such entry"):
        tpss.load_scenario(scenario_file, changes)
    own.rename(tmp_path / "of-the-user")
    assert tpss.load_scenario(scenario_file, changes)


def test_a_changed_file_is_read_again(scenario_file, write):
    for r_ohm_per_km in (0.1, 0.25):
        own = write("catenaries", {"ours": {"based_on": "AT", "r_ohm_per_km": r_ohm_per_km}})
        scenario = tpss.load_scenario(scenario_file, {"supply.catenary": "ours"}, library=own)
        assert catenary_of(scenario)["r_ohm_per_km"] == r_ohm_per_km


def test_types_of_the_scenario_come_before_those_of_a_library(scenario_file, write):
    """A result that names its own types must not change with a library."""
    plain = library.values("converters", "Q48/Q49")
    own = write("converters", {"mine": {**plain, "rating_mva": 20.0}})
    changes = {
        "supply.converter_types": {"mine": {**plain, "rating_mva": 5.0}},
        "supply.converter_stations.0.type": "mine",
    }
    scenario = tpss.load_scenario(scenario_file, changes, library=own)
    assert scenario.supply.converter_stations[0].type.rating_mva == 5.0


def test_wires_are_those_of_conductors(write, tmp_path):
    own = write("wires", {"thick": {"based_on": "Cu107", "radius_mm": 8.0}})
    place = {"name": "wire", "group": "contact", "x_m": 0.0, "height_m": 6.0}
    conductors = [{**place, "wire": "thick"}]
    with using(own):
        geometry = geometry_of({"conductors": conductors}, tmp_path / "conductors.toml")
    assert geometry.conductors[0].wire.radius_mm == 8.0


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_but_those_of_defaults_may_be_added_to(write, kind):
    name = next(iter(library.entries(kind)))
    with using(write(kind, {"mine": {"based_on": name}})):
        assert own_entries()[kind]["mine"].values == library.values(kind, name)


@pytest.mark.parametrize(
    ("entries", "key", "value", "problem", "remedy"),
    [
        ({"a": {"based_on": "AX"}}, "a.based_on", "'AX'", "such an entry", "choose from AT, BT"),
        ({"a": {"based_on": "BTT"}}, "a.based_on", "'BTT'", "such an entry", "did you mean BT?"),
        ({"a": {"based_on": 1}}, "a.based_on", "1", "such an entry", "choose from"),
        ({"a": {"based_on": "a"}}, "a.based_on", "'a'", "such an entry", "choose from"),
        ({"a": 1.0}, "a", "1.0", "not a table", "write a table [a]"),
        ({"a.toml": {}}, "a.toml", "", "as those of files do", "another name"),
        (
            {"a": {"based_on": "b"}, "b": {"based_on": "c"}, "c": {"based_on": "a"}},
            "c.based_on",
            "'a'",
            "a circle: a -> b -> c -> a",
            "give all values itself",
        ),
    ],
)
def test_a_fault_is_named(write, entries, key, value, problem, remedy):
    (fault,) = faults(write("catenaries", entries))
    assert fault[:2] == (key, value)
    assert problem in fault[2]
    assert remedy in fault[3]


@pytest.mark.parametrize("kind", ["catenary", *NOT_OWN])
def test_a_file_of_another_kind_is_refused(write, kind):
    ((_, _, problem, remedy),) = faults(write(kind, {}))
    assert "no kind of the library to which entries can be added" in problem
    assert remedy.startswith("did you mean catenaries?") or remedy == NOT_OWN[kind]


def test_a_value_at_fault_is_traced_to_its_entry(scenario_file, write):
    own = write("catenaries", {"ours": {"based_on": "AT", "r_ohm_km": 0.1, "x_ohm_per_km": "a"}})
    with pytest.raises(tpss.ScenarioError) as caught:
        tpss.load_scenario(scenario_file, {"supply.catenary": "ours"}, library=own)
    found = {f.key: f for f in caught.value.findings}
    assert {f.file for f in found.values()} == {str(own / "catenaries.toml")}
    assert "did you mean r_ohm_per_km?" in found["ours.r_ohm_km"].remedy
    assert found["ours.x_ohm_per_km"].value == "'a'"


def test_a_folder_that_is_not_there_is_refused(scenario_file, tmp_path):
    with pytest.raises(tpss.ScenarioError, match="no library: No such file"):
        tpss.load_scenario(scenario_file, library=tmp_path / "none")


def test_a_document_is_left_as_it_was(scenario_file, write):
    document = copy.deepcopy(SHORT_LINE) | {"supply": {**SHORT_LINE["supply"], "catenary": "ours"}}
    before = copy.deepcopy(document)
    with using(write("catenaries", {"ours": {"based_on": "AT"}})):
        tpss.Scenario.from_document(document)
    assert document == before
    assert VARIABLE in os.environ  # empty: whoever runs these tests may have a library
