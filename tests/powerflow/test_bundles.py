"""Lines of several conductors against other programs' ten digits.

Nodal Newton methods and tableaus of all windings have found what stands in the files below `cases`:

    autotransformers             2x25 kV 50 Hz, single track: a station, two autotransformers, a train
    autotransformers_two_tracks  the same with two tracks, six coupled conductors, three trains
    rail_potential               750 V third rail, rails with leakage to earth, diode stations

Pieces are pi-sections of matrices between neighbouring points, with half of the shunt at either end.
"""

import json
from pathlib import Path

import numpy as np
import pytest

from tpss.powerflow.assembly import SectionPart, assemble
from tpss.powerflow.bundles import BundlePart
from tpss.powerflow.links import LinkPart
from tpss.powerflow.solve import solve
from tpss.powerflow.system import system
from tpss.sources.grid import GridLaw
from tpss.sources.kinds import Source, SourceKind
from tpss.track.leg import Leg

from direct_lines import BASE_W, Braking, Drawing, diode, loads_of, rectifiers
from networks import constant_loads, place

CASES = {
    name: json.loads((Path(__file__).parent / f"cases/{name}.json").read_text(encoding="utf-8"))
    for name in ("autotransformers", "autotransformers_two_tracks", "rail_potential")
}
V = A = 1e-3
"""Of ten digits. [V], [A]"""

ALTERNATING = system(25e3, 25e3, 10e6, 50.0, 0.5, 1.35)


def number(pair):
    return complex(*pair)


def matrix(rows):
    return np.array([[complex(*np.atleast_1d(each)) for each in row] for row in rows])


def bundled_line(posts_km, z, y, tracks, loads, places, links, fed, base, flat, inner_ohm):
    """Bundles between neighbouring posts, whose nodes are those of the conductors, post by post.

    `tracks` are pairs of the conductors under which trains stand and to which they return; `places` the
    track of each train.  Matrices are those of a kilometre.  Two tracks of three conductors each are one
    at the posts.
    """
    n, cells, width = len(z), len(posts_km) - 1, min(len(z), 3)
    sections = [
        SectionPart(
            width * k + c % width,
            width * (k + 1) + c % width,
            1e3 * posts_km[k],
            1e3 * posts_km[k + 1],
            z[c, c] / 1e3,
            0.0,
        )
        for c in range(n)
        for k in range(cells)
    ]
    returns = [dict(tracks).get(c, -1) for c in range(n)]
    bundles = [
        BundlePart(tuple(c * cells + k for c in range(n)), tuple(returns), z / 1e3, y / 1e3)
        for k in range(cells)
    ]
    network = assemble(
        len(flat), sections, [], fed, base, links=links, bundles=bundles, flat_pu=flat,
        inner_ohm=inner_ohm,
    )  # fmt: skip
    loads.trains.route = places
    legs = [
        (-np.inf, 1.0, 0.0, 0, k + 1, c * cells, (c + 1) * cells) for k, (c, _) in enumerate(tracks)
    ]
    case = place(network, loads, Leg.array(legs).reshape(len(legs), 1))
    share, _ = solve(False, case.network, case.flow, case.loads)
    assert share == 1.0
    return case


def with_autotransformers(inputs, y, z, tracks, trains):
    """A station at km 0, with autotransformers at the other posts; of two tracks all posts are tied.

    [Vcr, Vfr] = [E, -E] - [[zp + zh, -zp], [-zp, zp + zh]] [Ic, If] is a link (1, 1, -2) of 2 zh,
    and one of contact line, feeder and the source, (1, -1, -2), of 2 (2 zp + zh); of the latter 2 zp
    counts as the source's.
    """
    station, unit = inputs["substation"], inputs["autotransformer"]
    posts_km = inputs.get("posts_km", [0.0, 12.0, 26.0])
    x = 3 * len(posts_km)
    zp, zh = number(station["zp_ohm"]), number(station["zh_ohm"])
    zw, ym = number(unit["zw_ohm"]), number(unit["ym_s"])
    links = [
        LinkPart((0, 2, 1), (1.0, 1.0, -2.0), 2 * zh),
        LinkPart((0, 2, x), (1.0, -1.0, -2.0), 2 * zh),
        LinkPart((1,), (1.0,), complex(inputs.get("earthing_ohm", 0.5))),
    ]
    for k in range(1, len(posts_km)):
        c, r, f = 3 * k, 3 * k + 1, 3 * k + 2
        links += [LinkPart((c, r, f), (1.0, -2.0, 1.0), 2 * zw)]
        links += [LinkPart((c, f), (1.0, -1.0), 1 / ym)]
    law = GridLaw.row(
        no_load_voltage_v=station["e_v"], grid_impedance_ohm=zp, transformer_impedance_ohm=0j
    )
    fed = Source.array(
        [
            Source.row(
                node=x,
                kind=SourceKind.GRID,
                installed=1,
                controlled=False,
                rating_va=60e6,
                grid=law,
            )
        ]
    )
    flat = [*([1.0, 0.0, -1.0] * (x // 3)), 1.0]
    powers = [complex(each["p_w"], each["q_var"]) for each in trains]
    loads = constant_loads([1e3 * each["km"] for each in trains], powers)
    places = [each.get("track", 1) - 1 for each in trains]
    return bundled_line(
        posts_km, z, y, tracks, loads, places, links, fed, ALTERNATING, flat, [0.0]
    )  # fmt: skip


def shunt(inputs, leakage_s_per_km, rails):
    y = 2j * np.pi * 50.0 * matrix(inputs["c_f_per_km"])
    for r in rails:
        y[r, r] += leakage_s_per_km
    return y


@pytest.mark.parametrize("leaks", [False, True], ids=["insulated rails", "leaking rails"])
def test_a_train_between_autotransformers(leaks):
    case, inputs = CASES["autotransformers"], CASES["autotransformers"]["inputs"]
    variant = list(case["variants"].values())[leaks]
    z = matrix(inputs["z_ohm_per_km"])
    y = shunt(inputs, 0.1, [1]) if leaks else np.zeros((3, 3), dtype=complex)
    found = with_autotransformers(inputs, y, z, [(0, 1)], [inputs["train"]])
    expected = variant["trains"]["T1"]
    volts = found.flow.bundles.voltage_v[0]
    for c, name in enumerate(("contact", "rail", "feeder")):
        assert volts[c] == pytest.approx(number(expected[f"{name}_to_earth_v"]), abs=V)
    assert found.train_voltage[0] == pytest.approx(number(expected["u_v"]), abs=V)
    for k, post in enumerate(variant["posts"].values()):
        for c, name in enumerate(("contact", "rail", "feeder")):
            node = found.flow.nodes[3 * k + c]
            assert node.voltage_v == pytest.approx(number(post[f"{name}_v"]), abs=V)
    # What leaves the station's terminals goes along the line, or to earth by the rails.
    station = variant["posts"]["0"]
    for c, name in enumerate(("contact", "rail", "feeder")):
        along_a = number(station[f"i_out_{name}_a"])
        along_a -= number(station["earth_current_a"]) if name == "rail" else 0.0
        assert found.flow.sections[2 * c].current_a == pytest.approx(along_a, abs=A)


@pytest.mark.parametrize("variant", list(CASES["autotransformers_two_tracks"]["variants"].items()))
def test_trains_on_two_tracks_between_autotransformers(variant):
    """Six conductors are coupled, or three and three; one train brakes."""
    name, expected = variant
    inputs = CASES["autotransformers_two_tracks"]["inputs"]
    z, y = matrix(inputs["z_ohm_per_km"]), np.zeros((6, 6), dtype=complex)
    if "leakage" in name.replace("no leakage", ""):
        y = shunt(inputs, 0.1, [1, 4])
    if "without mutual coupling" in name:
        z[:3, 3:] = z[3:, :3] = 0.0
    found = with_autotransformers(inputs, y, z, [(0, 1), (3, 4)], inputs["trains"])
    for k, (train, each) in enumerate(
        zip(inputs["trains"], expected["trains"].values(), strict=True)
    ):
        first = 3 * (train["track"] - 1)
        for c, conductor in enumerate(("contact", "rail", "feeder")):
            volts = number(each[f"{conductor}_to_earth_v"])
            assert found.flow.bundles.voltage_v[k, first + c] == pytest.approx(volts, abs=V)
    for k, post in enumerate((expected["posts"] or {}).values()):
        for c, conductor in enumerate(("contact", "rail", "feeder")):
            volts = number(post[f"{conductor}_v"])
            assert found.flow.nodes[3 * k + c].voltage_v == pytest.approx(volts, abs=V)


def rail_potential(variant):
    inputs = variant["inputs"]
    stations, trains = inputs["stations"], inputs["trains"]
    z = np.diag([inputs["r_contact_ohm_per_km"], inputs["r_rails_ohm_per_km"]]).astype(complex)
    y = np.diag([0.0, inputs["leakage_s_per_km"]]).astype(complex)
    inner_ohm = 1e-6
    links = [
        LinkPart((2 * k, 2 * k + 1, 4 + k), (1.0, -1.0, -1.0), inner_ohm + 0j) for k in range(2)
    ]
    links += [
        LinkPart((2 * k + 1,), (1.0,), complex(each["earthing_ohm"]))
        for k, each in enumerate(stations)
        if "earthing_ohm" in each
    ]
    fed = rectifiers([diode(each["law"]["u0_v"], each["law"]["r_ohm"]) for each in stations])
    fed["node"] = [4, 5]
    loads = loads_of(
        [
            Drawing(each["km"], each["p_w"])
            if each["kind"] == "traction"
            else Braking(each["km"], each["p_w"], each["u1_v"], each["u2_v"], each["p_aux_w"])
            for each in trains
        ]
    )
    base = system(750.0, 750.0, BASE_W[750.0], 0.0, 0.5, 1.35)
    return bundled_line(
        [each["km"] for each in stations], z, y, [(0, 1)], loads, [0] * len(trains), links, fed, base,
        [1.0, 0.0, 1.0, 0.0, 1.0, 1.0], [inner_ohm] * 2,
    )  # fmt: skip


@pytest.mark.parametrize("variant", CASES["rail_potential"]["variants"])
def test_rails_that_leak_to_earth(variant):
    expected = CASES["rail_potential"]["variants"][variant]
    found = rail_potential(expected)
    for k, each in enumerate(expected["trains"].values()):
        contact_v, rail_v = found.flow.bundles.voltage_v[k].real
        assert contact_v == pytest.approx(each["contact_to_earth_v"], abs=V)
        assert rail_v == pytest.approx(each["rail_to_earth_v"], abs=V)
        assert found.train_voltage[k].real == pytest.approx(each["u_v"], abs=V)
    for k, each in enumerate(expected["stations"].values()):
        assert found.flow.nodes[2 * k + 1].voltage_v.real == pytest.approx(
            each["rail_to_earth_v"], abs=V
        )
        assert found.flow.nodes[4 + k].leaving_current_a.real == pytest.approx(each["i_a"], abs=A)


@pytest.mark.parametrize("km", [1.0, 2.5, 5.0, 7.5, 11.0, 15.0, 19.0, 29.0])
def test_the_impedance_up_to_a_train_is_a_saw_tooth_between_ideal_autotransformers(km):
    """Z(x) = zL x + zs x' (D - x') / D, x' from the post before the train, cells of D = 10 km.

    zL = (zc + zf - 2 zcf) / 4 and zs = zc + zr - 2 zcr - zL, for a contact line like the feeder and
    rails without leakage.  Here the autotransformers have 0.1 mΩ in each half.
    """
    zc, zr, zcr, zcf = 0.2 + 0.55j, 0.09 + 0.47j, 0.06 + 0.25j, 0.055 + 0.24j
    z = np.array([[zc, zcr, zcf], [zcr, zr, zcr], [zcf, zcr, zc]])
    along, within = (zc + zc - 2 * zcf) / 4, zc + zr - 2 * zcr - (zc + zc - 2 * zcf) / 4
    inputs = {
        "posts_km": [0.0, 10.0, 20.0, 30.0],
        "substation": {"e_v": 27.5e3, "zp_ohm": [0.0, 0.0], "zh_ohm": [1e-4, 0.0]},
        "autotransformer": {"zw_ohm": [1e-4, 0.0], "ym_s": [0.0, -1e-9]},
    }
    train = {"km": km, "p_w": 3e6, "q_var": 0.5e6}
    no_shunt = np.zeros((3, 3), dtype=complex)
    found = with_autotransformers(inputs, no_shunt, z, [(0, 1)], [train])
    voltage = found.train_voltage[0]
    current = np.conj((3e6 + 0.5e6j) / voltage)
    part_km = km % 10.0
    expected = along * km + within * part_km * (10.0 - part_km) / 10.0
    assert (27.5e3 - voltage) / current == pytest.approx(expected, abs=3e-4)
