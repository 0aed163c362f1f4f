"""Lines of several conductors as a scenario describes them, against the cases of `test_bundles`."""

import json
from pathlib import Path

import numpy as np
import pytest
from pydantic import ValidationError

from tpss.model.contact_line import LineLayout
from tpss.model.supply import build_supply
from tpss.powerflow.solve import solve
from tpss.scenario.supply import Supply
from tpss.track.leg import along_one_line

from direct_lines import Braking, Drawing, loads_of
from networks import constant_loads, place

CASES = Path(__file__).parent / "cases"
V = A = 1e-3


def case_of(name):
    return json.loads((CASES / f"{name}.json").read_text(encoding="utf-8"))


def solved(supply, end_km, loads):
    line = LineLayout("line", 0, 0.0, end_km, (), ((0.0, end_km, 1),), True)
    network, plan = build_supply(supply, (line,))
    legs = along_one_line(len(range(*plan.runs[0][0].sections[0])))
    case = place(network, loads, legs)
    share, _ = solve(False, case.network, case.flow, case.loads)
    assert share == 1.0
    return case, plan


def parts(rows):
    """Real and imaginary part of a matrix of pairs."""
    values = np.array([[complex(*np.atleast_1d(each)) for each in row] for row in rows])
    return values.real.tolist(), values.imag.tolist()


def autotransformer_line(leakage_s_per_km, with_capacitance=True):
    """The station, 60 MVA, 10 %, 160 kW over both windings, 3000 MVA: of a half 10 % of 27.5²/60."""
    inputs = case_of("autotransformers")["inputs"]
    r, x = parts(inputs["z_ohm_per_km"])
    conductors = {"names": ["contact", "rails", "feeder"], "r_ohm_per_km": r, "x_ohm_per_km": x}
    if with_capacitance:
        _, c = parts([[[0.0, each[0] if isinstance(each, list) else each] for each in row]
                      for row in inputs["c_f_per_km"]])  # fmt: skip
        conductors["b_us_per_km"] = (1e6 * 2 * np.pi * 50.0 * np.array(c)).tolist()
    return Supply(
        system="25kV-50Hz",
        catenary={"r_ohm_per_km": 0.052, "x_ohm_per_km": 0.157, "conductors": conductors},
        conductors={"leakage_s_per_km": leakage_s_per_km, "nodes_every_km": 100.0},
        autotransformers=[
            {
                "positions_km": [12.0, 26.0], "rated_mva": 10.0, "short_circuit_percent": 0.9,
                "load_loss_kw": 18.0, "no_load_loss_kw": 8.0, "no_load_current_percent": 0.3,
            }
        ],
        transformer_stations=[
            {
                "name": "A", "position_km": 0.0, "no_load_voltage_kv": 27.5, "secondary": "2x",
                "grid_short_circuit_mva": 3000.0, "rail_earthing_ohm": 0.5,
                "transformer": {
                    "rated_mva": 60.0, "short_circuit_percent": 10.0, "load_loss_kw": 160.0,
                },
            }
        ],
    )  # fmt: skip


@pytest.mark.parametrize("leaks", [False, True], ids=["insulated rails", "leaking rails"])
def test_a_train_between_autotransformers(leaks):
    case = case_of("autotransformers")
    supply = autotransformer_line(0.1 if leaks else 0.0, leaks)
    train = case["inputs"]["train"]
    loads = constant_loads([19e3], [complex(train["p_w"], train["q_var"])])
    found, plan = solved(supply, 26.0, loads)
    expected = list(case["variants"].values())[leaks]
    assert found.train_voltage[0] == pytest.approx(complex(*expected["trains"]["T1"]["u_v"]), abs=V)
    for c, name in enumerate(("contact", "rail", "feeder")):
        volts = complex(*expected["trains"]["T1"][f"{name}_to_earth_v"])
        assert found.flow.bundles.voltage_v[0, c] == pytest.approx(volts, abs=V)
    for km, post in expected["posts"].items():
        for name, kind in (("contact", "contact line"), ("rail", "rails"), ("feeder", "feeder")):
            node = plan.nodes.index(f"{kind} at {km} km")
            volts = complex(*post[f"{name}_v"])
            assert found.flow.nodes[node].voltage_v == pytest.approx(volts, abs=V)


def test_a_secondary_of_two_windings_needs_an_impedance():
    supply = autotransformer_line(0.1).model_dump(exclude_none=True)
    (station,) = supply["transformer_stations"]
    station["transformer"] |= {"short_circuit_percent": 0.0, "load_loss_kw": 0.0}
    with pytest.raises(ValidationError, match="no impedance to lie in the halves"):
        Supply.model_validate(supply)


def direct_supply(conductors, stations, contact_ohm_per_km, rails_ohm_per_km):
    return Supply(
        system="DC-0.75kV",
        catenary={
            "contact_line": {"r_ohm_per_km": contact_ohm_per_km},
            "rails": {"r_ohm_per_km": rails_ohm_per_km},
        },
        conductors=conductors,
        rectifier_stations=[
            {
                "name": each["name"],
                "position_km": each["km"],
                "rail_earthing_ohm": each.get("earthing_ohm"),
                "type": {
                    "no_load_voltage_kv": each["law"]["u0_v"] / 1e3,
                    "resistance_ohm": each["law"]["r_ohm"],
                    "rated_current_a": 2500.0,
                },
            }
            for each in stations
        ],
    )


def test_rails_between_a_station_and_a_train_have_the_voltage_of_a_leaking_line():
    """V(x) = (r I / γ) sinh(γ (x - L/2)) / cosh(γ L/2), γ = sqrt(r g): 3 km, 0.015 ohm/km, 0.1 S/km.

    With 2000 A that is ±44.9494 V at the ends, and 3.3703 A leave.  Leakage that is lumped every 50 m
    errs by (γ h)²/12, 3e-7.
    """
    station = {"name": "A", "km": 0.0, "law": {"u0_v": 800.0, "r_ohm": 0.016}}
    conductors = {"leakage_s_per_km": 0.1, "nodes_every_km": 0.05}
    supply = direct_supply(conductors, [station], 0.0082, 0.015)
    found, plan = solved(supply, 3.0, loads_of([Drawing(3.0, 1.4e6)]))
    current_a = 1.4e6 / found.train_voltage[0].real
    gamma = np.sqrt(0.015 * 0.1)
    end_v = 0.015 * current_a / gamma * np.tanh(gamma * 1.5)
    assert end_v / current_a == pytest.approx(44.94944325 / 2000.0, rel=1e-8)
    at_ends = [plan.nodes.index(f"rails at {km} km") for km in ("0", "3")]
    volts = found.flow.nodes.voltage_v[at_ends].real
    # The train stands a metre beside the end, which shifts both by half of that metre's drop.
    assert (volts[1] - volts[0]) / 2.0 == pytest.approx(end_v, rel=5e-6)
    assert volts == pytest.approx([-end_v, end_v], abs=0.015e-3 * current_a)
    leaving_a = current_a * (1.0 - 1.0 / np.cosh(gamma * 1.5))
    middle = plan.nodes.index("rails at 1.5 km")
    (piece,) = (
        s for s, part in enumerate(plan.sections)
        if part.start_node == middle and plan.section_kinds[s] == "rails"
    )  # fmt: skip
    # Between the middle and the train all that leaves has left.
    half_shunt_a = 0.1 * 0.025 * found.flow.nodes.voltage_v[middle].real
    assert abs(found.flow.sections[piece].current_a.real - half_shunt_a) == pytest.approx(
        current_a - leaving_a, rel=5e-6
    )


@pytest.mark.parametrize("variant", case_of("rail_potential")["variants"])
def test_rails_of_direct_current_that_leak_to_earth(variant):
    expected = case_of("rail_potential")["variants"][variant]
    inputs = expected["inputs"]
    conductors = {"leakage_s_per_km": inputs["leakage_s_per_km"], "nodes_every_km": 100.0}
    supply = direct_supply(
        conductors, inputs["stations"], inputs["r_contact_ohm_per_km"],
        inputs["r_rails_ohm_per_km"],
    )  # fmt: skip
    loads = loads_of(
        [
            Drawing(each["km"], each["p_w"])
            if each["kind"] == "traction"
            else Braking(each["km"], each["p_w"], each["u1_v"], each["u2_v"], each["p_aux_w"])
            for each in inputs["trains"]
        ]
    )
    found, plan = solved(supply, 4.6, loads)
    for k, each in enumerate(expected["trains"].values()):
        assert found.train_voltage[k].real == pytest.approx(each["u_v"], abs=V)
        rail_v = found.flow.bundles.voltage_v[k, 1].real
        assert rail_v == pytest.approx(each["rail_to_earth_v"], abs=V)
    for k, each in enumerate(expected["stations"].values()):
        rails = plan.nodes.index(f"rails at {each['km']:g} km")
        rail_v = found.flow.nodes[rails].voltage_v.real
        assert rail_v == pytest.approx(each["rail_to_earth_v"], abs=V)
        source = found.flow.nodes[plan.sources[k]]
        assert source.leaving_current_a.real == pytest.approx(each["i_a"], abs=A)


def leaking_rails(nodes_every_km):
    """A station at km 0 feeds 60 km of 25 kV line, whose rails leak 1 S/km: exp(γ L) is 2e14 there."""
    r, x = [[0.15, 0.05], [0.05, 0.1]], [[0.6, 0.35], [0.35, 0.5]]
    catenary = {"names": ["contact", "rails"], "r_ohm_per_km": r, "x_ohm_per_km": x}
    station = {
        "name": "A", "position_km": 0.0, "no_load_voltage_kv": 27.5,
        "transformer": {"rated_mva": 30.0, "short_circuit_percent": 10.0},
    }  # fmt: skip
    return Supply(
        system="25kV-50Hz",
        catenary={"r_ohm_per_km": 0.15, "x_ohm_per_km": 0.4, "conductors": catenary},
        conductors={"leakage_s_per_km": 1.0, "nodes_every_km": nodes_every_km},
        transformer_stations=[station],
    )


def test_nothing_grows_along_rails_that_leak():
    """Trains without load every kilometre cut a piece of 60 km as 59 nodes do, between its two ends."""
    places_km = np.arange(1.0, 60.0)
    powers = np.where(places_km == 47.0, 4e6 + 1e6j, 0j)
    one, _ = solved(leaking_rails(100.0), 60.0, constant_loads((1e3 * places_km).tolist(), powers))
    cut, plan = solved(leaking_rails(1.0), 60.0, constant_loads([47e3], [4e6 + 1e6j]))
    for k, km in enumerate(places_km):
        rails = plan.nodes.index(f"rails at {km:g} km")
        contact = plan.nodes.index(f"contact line at {km:g} km")
        at_train = one.flow.bundles.voltage_v[k]
        # The train at km 47 stands a metre beside the node there.
        assert cut.flow.nodes[contact].voltage_v == pytest.approx(at_train[0], abs=1.0)
        assert cut.flow.nodes[rails].voltage_v == pytest.approx(at_train[1], abs=0.5)
    assert one.train_voltage[46] == pytest.approx(cut.train_voltage[0], abs=1.0)


def test_a_line_the_other_way_round_has_the_same_voltages():
    """Both rails' and contact line's, with stations and trains mirrored in the middle of 4.6 km."""
    stations = [
        {"name": "A", "km": 0.0, "law": {"u0_v": 800.0, "r_ohm": 0.016}, "earthing_ohm": 0.5},
        {"name": "B", "km": 4.6, "law": {"u0_v": 795.0, "r_ohm": 0.02}},
    ]
    turned = [{**each, "km": 4.6 - each["km"]} for each in stations]
    conductors = {"leakage_s_per_km": 0.1, "nodes_every_km": 100.0}
    trains = [(1.4, 2.0e6), (3.1, 1.2e6)]
    found = []
    for those, kms in (
        (stations, [km for km, _ in trains]),
        (turned, [4.6 - km for km, _ in trains]),
    ):
        loads = loads_of([Drawing(km, power) for km, (_, power) in zip(kms, trains, strict=True)])
        supply = direct_supply(conductors, those, 0.0082, 0.015)
        case, _ = solved(supply, 4.6, loads)
        found.append(case.flow.bundles.voltage_v.copy())
    np.testing.assert_allclose(found[0], found[1], rtol=0.0, atol=1e-9)
