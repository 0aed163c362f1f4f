"""What holds of the line constants of any geometry."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import tpss
from tpss import library
from tpss.conductors.catenary import capacitance, chosen
from tpss.conductors.load import geometry_of

from conductor_cases import CONDUCTORS
from conftest import EXAMPLES
from direct_scenarios import direct_scenario

DOUBLE_TRACK = EXAMPLES / "geometry_double_track.toml"


def geometry(conductors=CONDUCTORS, **others):
    return geometry_of({"conductors": list(conductors), **others}, Path("case.toml"))


def at(frequency_hz, conductors=CONDUCTORS, **others):
    return tpss.line_constants(geometry(conductors, **others), frequency_hz)


def changed(name, **values):
    """The single track with some values of a conductor changed."""
    return [each | values if each["name"] == name else each for each in CONDUCTORS]


def equivalents_of(found):
    return {each.name: each for each in found.equivalents}


@st.composite
def lines(draw):
    """One or two tracks of library wires at places of their own."""
    wires = st.sampled_from(sorted(library.entries("wires")))
    places, conductors = set(), []
    for track in range(1, draw(st.integers(1, 2)) + 1):
        groups = ["contact", "rails", *draw(st.lists(GROUPS, max_size=5))]
        for group in groups:
            place = draw(PLACES.filter(lambda place: place not in places))
            places.add(place)
            conductors.append(
                {"name": f"{len(conductors)}", "group": group, "track": track, "wire": draw(wires)}
                | {"x_m": 0.5 * place[0], "height_m": 0.5 * place[1]}
            )
    return conductors


GROUPS = st.sampled_from(["contact", "rails", "feeder", "positive", "earth"])
PLACES = st.tuples(st.integers(-20, 20), st.integers(1, 40))
"""Across the line and above ground, in half metres. [0.5 m]"""


@settings(max_examples=60, deadline=None, derandomize=True)
@given(lines(), st.sampled_from([0.0, 16.7, 50.0, 1000.0]), st.sampled_from([1.0, 100.0, 1e4]))
def test_matrices_are_symmetric_and_passive(conductors, frequency_hz, earth_ohm_m):
    """No current makes a line give off power, no charge gives it less energy than none."""
    found = at(frequency_hz, conductors, earth_resistivity_ohm_m=earth_ohm_m)
    for matrix in (found.impedance, found.capacitance, found.conductor_impedance):
        assert matrix == pytest.approx(matrix.T, rel=1e-9, abs=1e-12 * abs(matrix).max())
    assert np.linalg.eigvalsh(found.impedance.real).min() > 0.0
    assert np.linalg.eigvalsh(found.capacitance).min() > 0.0
    for each in found.equivalents:  # what comes on top in a cell may be anything, its sum may not
        if each.name != "autotransformers-in-cell":
            assert np.linalg.eigvalsh(each.impedance.real).min() > 0.0


def test_a_catenary_of_direct_current_feeds_a_line_of_direct_current():
    catenary = at(0.0).catenary
    assert "capacitance_nf_per_km" not in catenary
    supply = direct_scenario(**{"supply.catenary": catenary}).supply
    assert supply.catenary.r_ohm_per_km == catenary["r_ohm_per_km"]


def test_a_low_frequency_comes_to_the_resistances_of_direct_current():
    low, direct = at(1e-5), at(0.0)
    assert low.impedance == pytest.approx(direct.impedance, abs=1e-9)
    assert direct.x_ohm_per_km.abs().max().max() == 0.0


def test_direct_current_is_divided_by_resistances_and_returns_in_the_rails():
    """0.153 ∥ 0.1938 = 0.08550 Ω/km; rails 0.1 ∥ 0.1 ∥ 0.306 = 0.04298 Ω/km."""
    found = at(0.0)
    assert found.r_ohm_per_km.loc["contact", "contact"] == pytest.approx(0.08550, abs=5e-6)
    assert found.r_ohm_per_km.loc["rails", "rails"] == pytest.approx(0.04298, abs=5e-6)
    (equivalent,) = found.equivalents
    assert 1e3 * equivalent.own == pytest.approx(0.12848, abs=1e-5)


def test_wear_and_warmth_raise_the_resistance():
    """0.153 Ω/km (1 + 0.0038 · 20) / (1 - 0.1) = 0.18292 Ω/km."""
    wire = CONDUCTORS[0]["wire"] | {"temperature_coefficient_per_k": 0.0038}
    worn = changed("contact", wire=wire, wear_percent=10.0, temperature_c=40.0)
    (contact, *_) = geometry(worn).conductors
    assert contact.r_ohm_per_km == pytest.approx(0.18292, abs=5e-6)


def test_a_wire_counts_two_thirds_of_its_sag_below_its_supports():
    sagging = at(50.0, changed("messenger", height_m=7.25 + 0.6, sag_m=0.9))
    assert sagging.impedance == pytest.approx(at(50.0).impedance, rel=1e-12)


def test_a_mirrored_line_has_the_same_constants():
    mirrored = [each | {"x_m": -each["x_m"]} for each in CONDUCTORS]
    assert at(50.0, mirrored).impedance == pytest.approx(at(50.0).impedance, rel=1e-12)


def test_the_order_of_conductors_is_of_no_account():
    backwards = at(50.0, CONDUCTORS[::-1])
    assert backwards.groups == at(50.0).groups
    assert backwards.impedance == pytest.approx(at(50.0).impedance, rel=1e-9)


def test_two_halves_of_one_voltage_are_one_conductor():
    """By the first terms, which know no heights: two like wires at d are one of R/2 and √(d GMR)."""
    half = {"r_ohm_per_km": 0.2, "radius_mm": 5.0, "gmr_mm": 4.0}
    whole = {"r_ohm_per_km": 0.1, "radius_mm": 300.0, "gmr_mm": np.sqrt(4.0 * 400.0)}
    place = {"group": "contact", "height_m": 6.0, "x_m": 0.0}
    two = [place | {"name": str(x), "x_m": x, "wire": half} for x in (-0.2, 0.2)]
    found = [
        at(50.0, each, method="clem") for each in (two, [place | {"name": "w", "wire": whole}])
    ]
    assert found[0].impedance == pytest.approx(found[1].impedance, rel=1e-9)


def test_conductors_of_the_group_positive_are_connected_to_the_contact_line():
    """The equivalents are those of a feeder that is called contact; its matrix has a row of its own."""
    positive, contact = (
        at(50.0, changed("feeder", group=group)) for group in ("positive", "contact")
    )
    assert positive.groups == ("contact", "positive", "rails")
    assert contact.groups == ("contact", "rails")
    for name, each in equivalents_of(contact).items():
        assert equivalents_of(positive)[name].own == pytest.approx(each.own, rel=1e-9)
    assert capacitance(positive) == pytest.approx(capacitance(contact), rel=1e-9)


def test_a_feeder_changes_nothing_without_autotransformers():
    without = at(50.0, [each for each in CONDUCTORS if each["name"] != "feeder"])
    for each in without.equivalents:
        assert equivalents_of(at(50.0))[each.name].own == pytest.approx(each.own, rel=1e-9)
    assert "autotransformers" not in equivalents_of(without)


def test_without_rails_the_return_is_through_the_earth():
    alone = at(50.0, CONDUCTORS[:1])
    (equivalent,) = alone.equivalents
    assert (equivalent.name, equivalent.own) == ("earth-return", alone.impedance[0, 0])


def test_like_tracks_are_alike_and_have_something_in_common():
    """At 16.7 Hz of rails and earth alone: near the 0.124 + j0.129 and 0.011 + j0.038 Ω/km of other
    wires over better earth, and of the library's catenaries between AT and BT."""
    found = tpss.line_constants(tpss.load_geometry(DOUBLE_TRACK))
    earthed = equivalents_of(found)["rails-earthed"]
    assert earthed.spread < 1e-12
    assert 1e3 * earthed.own == pytest.approx(0.1417 + 0.1401j, abs=5e-5)
    assert 1e3 * earthed.mutual == pytest.approx(0.0083 + 0.0438j, abs=5e-5)
    assert library.values("catenaries", "AT")["r_ohm_per_km"] < 1e3 * earthed.own.real
    assert library.values("catenaries", "BT")["r_ohm_per_km"] > 1e3 * earthed.own.real


def test_a_catenary_with_a_feeder_is_one_of_autotransformers():
    found = at(16.7)
    assert chosen(found).name == "autotransformers"
    table = found.catenary
    assert table["r_ohm_per_km"] == pytest.approx(0.05073, abs=5e-6)
    assert table["x_ohm_per_km"] == pytest.approx(0.05108, abs=5e-6)
    # C_cc + C_ff - 2 C_cf of the case: 12.366 + 8.425 + 2 · 1.737 nF/km.
    assert table["capacitance_nf_per_km"] == pytest.approx(24.266, abs=1e-3)


def test_what_tracks_have_in_common_is_left_out_where_it_is_negative():
    """Feeders outside both tracks hide the reactance of one from the other, and a little more."""
    document = tomllib.loads(DOUBLE_TRACK.read_text("utf-8"))
    feeder = {"group": "feeder", "wire": "Al212", "height_m": 10.5}
    document["conductors"] += [
        feeder | {"name": f"feeder {track}", "track": track, "x_m": x_m}
        for track, x_m in ((1, -5.75), (2, 5.75))
    ]
    found = tpss.line_constants(geometry_of(document, DOUBLE_TRACK))
    mutual = chosen(found).mutual
    assert mutual.real < 0.0 < mutual.imag
    assert "mutual_r_ohm_per_km" not in found.catenary
    assert found.catenary["mutual_x_ohm_per_km"] == pytest.approx(1e3 * mutual.imag, rel=1e-5)


@pytest.mark.parametrize(
    ("rails", "r_ohm_per_km"), [("earthed", 0.1121132878), ("insulated", 0.1342177794)]
)
def test_rails_say_which_impedance_a_catenary_has(rails, r_ohm_per_km):
    conductors = [each for each in CONDUCTORS if each["name"] != "feeder"]
    table = at(16.7, conductors, earth_resistivity_ohm_m=250.0, rails=rails).catenary
    assert table["r_ohm_per_km"] == pytest.approx(r_ohm_per_km, abs=1e-6)
