"""Tracks side by side whose currents induce voltages in each other, by hand and by a dense twin.

Zs is the impedance of a contact line by itself, Zm that of any two in common.
"""

import math

import numpy as np
import pytest

from tpss.numerics.pair_matrix import eliminate
from tpss.original.grid import lay_out
from tpss.powerflow.chain import LINKED, MOVED, WARM
from tpss.powerflow.coupled import evaluate_groups
from tpss.powerflow.newton import begin_pass, evaluate, find_direction, mark_base, take_step
from tpss.powerflow.solve import solve

from continuation import Equations, admittance_matrix, carry
from networks import (
    ROTARY,
    STIFF,
    highest_root,
    side_by_side,
    simple_line,
    solve_slowly,
    sources,
)  # fmt: skip

E = 16_500.0
ZS, ZM = complex(0.124, 0.129) * 1e-3, complex(0.011, 0.038) * 1e-3
"""Two tracks of a plain line at 16.7 Hz, 4.5 m apart. [Ω/m]"""

CAPACITANCE = 2 * math.pi * 16.7 * 10e-12
D = 40e3


def cell(*trains, tracks=2, ends=(STIFF,), mutual=ZM, **more):
    """Tracks that are tied at both ends of a cell; a source stands at its beginning, or at both."""
    fed = sources(*enumerate(ends))
    return side_by_side(
        [0.0, D], [[0, 1]] * tracks, list(trains), fed, mutual, impedance=ZS, **more
    )


def solved(case, warm=False):
    share, passes = solve(warm, case.network, case.flow, case.loads)
    assert share == 1.0
    return passes


def untied(*trains, **more):
    """Two tracks that are tied at their beginning only, where the source stands."""
    fed = sources((0, STIFF))
    return side_by_side([0.0, D], [[0, 1], [0, 2]], list(trains), fed, ZM, impedance=ZS, **more)


# Closed forms


@pytest.mark.parametrize("x", [1.0, 4e3, 20e3, 33e3, D - 1.0])
@pytest.mark.parametrize("tracks", [2, 3])
def test_a_train_in_a_cell_sees_what_is_even_up_to_it_and_what_is_odd_within_the_cell(x, tracks):
    """(Zs + (n-1) Zm)/n x of all tracks alike, and (Zs - Zm) (n-1)/n x (d - x)/d between them.

    For two tracks the second is (Zs - Zm)/2 x (d - x)/d.
    """
    load = 2e6 + 1e6j
    case = cell((1, x, load), tracks=tracks)
    solved(case)
    even = (ZS + (tracks - 1) * ZM) / tracks * x
    odd = (ZS - ZM) * (tracks - 1) / tracks * x * (D - x) / D
    assert abs(case.train_voltage[0]) == pytest.approx(highest_root(E, even + odd, load), rel=1e-10)


@pytest.mark.parametrize(("track", "sign"), [(0, 1.0), (1, -1.0)])
def test_the_odd_part_between_two_trains_of_a_cell_is_added_on_one_track_and_not_on_the_other(
    track, sign
):
    """At x1 < x2: (Zs + Zm)/2 x1 ± (Zs - Zm)/2 x1 (d - x2)/d; V = E - Z conj(S / V)."""
    places, loads = np.array([12e3, 31e3]), np.array([2e6 + 0.5e6j, 1.5e6 + 1e6j])
    case = cell((0, places[0], loads[0]), (track, places[1], loads[1]))
    solved(case)
    # In the order of sections, the first track's first.
    voltage = case.train_voltage[case.flow.standing.train.argsort()]
    first, second = np.minimum.outer(places, places), np.maximum.outer(places, places)
    odd = (ZS - ZM) / 2 * first * (D - second) / D
    impedance = (ZS + ZM) / 2 * first + odd * np.array([[1.0, sign], [sign, 1.0]])
    expected = E - impedance @ np.conj(loads / voltage)
    np.testing.assert_allclose(voltage, expected, rtol=1e-11)


def test_tracks_that_are_not_tied_have_the_mutual_impedance_up_to_the_nearer_train():
    """Z11 = Zs x1, Z22 = Zs x2, Z12 = Zm min(x1, x2); an open end has the voltage of the last train,
    but for what the other track induces beyond it.
    """
    near, far = 12e3, 31e3
    loads = np.array([2e6 + 0.5e6j, 1.5e6 + 1e6j])
    case = untied((0, near, loads[0]), (1, far, loads[1]))
    solved(case)
    voltage = case.train_voltage
    impedance = np.array([[ZS * near, ZM * near], [ZM * near, ZS * far]])
    current = np.conj(loads / voltage)
    np.testing.assert_allclose(voltage, E - impedance @ current, rtol=1e-11)
    ends = case.flow.nodes.voltage_v[1:]
    induced = np.array([ZM * (far - near) * current[1], 0.0])
    np.testing.assert_allclose(ends, voltage - induced, rtol=1e-11)


def test_alike_loads_on_both_tracks_are_those_of_tracks_tied_everywhere():
    """Only the even part: a line of (Zs + Zm)/2 and twice the capacitance, with twice the loads."""
    places, load = [9e3, 22e3, 36e3], 1.2e6 + 0.6e6j
    trains = [(track, x, load) for track in (0, 1) for x in places]
    case = cell(*trains, ends=(ROTARY, ROTARY), susceptance=CAPACITANCE)
    solved(case)
    one = simple_line(
        D, places, [2 * load] * 3, ROTARY, ROTARY, impedance=(ZS + ZM) / 2,
        susceptance=2 * CAPACITANCE,
    )  # fmt: skip
    solved(one)
    np.testing.assert_allclose(case.train_voltage, np.tile(one.train_voltage, 2), rtol=1e-11)
    np.testing.assert_allclose(case.fed, one.fed, rtol=1e-9)


def test_the_most_power_is_that_of_the_impedance_which_the_train_sees():
    """E² / (2 (R + |Z|)) at unity power factor; a load 1.25 times as large is carried to 80 %."""
    x = 25e3
    z = (ZS + ZM) / 2 * x + (ZS - ZM) / 2 * x * (D - x) / D
    most = E**2 / (2 * (z.real + abs(z)))
    below = cell((0, x, 0.9999 * most))
    solved(below)
    above = cell((0, x, 1.25 * most))
    share, _ = solve(False, above.network, above.flow, above.loads)
    assert share == pytest.approx(0.8, abs=2e-4)


# Twins


def random_tracks(seed, mutual=ZM, coupled=True, close=False):
    """Two or three tracks in three cells, tied at both ends, and at the points between or not.

    Some trains may be close to each other, and one at a point.
    """
    rng = np.random.default_rng(seed)
    tracks = int(rng.integers(2, 4))
    points = [0.0, *np.sort(rng.uniform(5e3, 55e3, 2)), 60e3]
    nodes, last = [[0] for _ in range(tracks)], 0
    for tied in (*rng.integers(0, 2, 2), 1):
        for k, of_track in enumerate(nodes):
            of_track.append(last + 1 if tied else last + 1 + k)
        last += 1 if tied else tracks
    count = int(rng.integers(3, 10))
    powers = rng.uniform(-0.5e6, 2.0e6, count) + 1j * rng.uniform(-0.3e6, 1e6, count)
    places = rng.uniform(0.0, 60e3, count)
    if close:
        places[0] = places[1] + rng.choice([0.0, rng.uniform(0.0, 1.5)])
        places[2] = rng.choice(points)
    trains = list(zip(rng.integers(0, tracks, count).tolist(), places, powers, strict=True))
    fed = sources((0, ROTARY), (last, ROTARY))
    return side_by_side(
        points, nodes, trains, fed, mutual, impedance=ZS, susceptance=CAPACITANCE, coupled=coupled
    )


def voltages(case):
    return np.concatenate([case.flow.nodes.voltage_v, case.train_voltage])


@pytest.mark.parametrize("seed", range(24))
def test_voltages_agree_with_all_nodes_of_all_tracks_solved_at_once(seed):
    """The twin has a node of every track at every train, and matrices of impedances in between."""
    case = random_tracks(seed)
    assert solved(case) <= 8
    assert np.abs(voltages(case) - solve_slowly(case)).max() < 1e-8 * E
    # Once more from close by: Newton's method converges quadratically.
    case.flow.nodes.voltage_v *= 1.001
    assert solved(case, warm=True) <= 4


@pytest.mark.parametrize("seed", range(24))
def test_trains_closer_than_a_metre_are_loads_of_the_nodal_equations_too(seed):
    """Powers from the voltages, by an admittance matrix of pieces with what they share in length.

    Over a piece of a metre, 0.2 milliohm, a rounding of 16.5 kV is some millivolt-amperes.
    """
    case = random_tracks(seed, close=True)
    solved(case)
    grid = lay_out(len(case.train_voltage), case.network, case.flow)
    drawn = case.loads.types[case.flow.standing.train]
    volts = voltages(case)
    power = volts * np.conj(grid.admittance_matrix() @ volts)
    power[case.flow.nodes.size :] += (
        drawn.auxiliary_power_w + 1j * drawn.auxiliary_reactive_power_var
    )
    power[case.network.sources.node] -= case.fed
    assert np.abs(power).max() < 0.02
    assert sum(grid.coupled_losses_w(volts)) == pytest.approx(
        case.flow.groups.lost_w.sum(), abs=1e-3
    )


@pytest.mark.parametrize("seed", range(8))
def test_without_anything_in_common_tracks_are_what_they_are_alone(seed):
    together = random_tracks(seed, mutual=0j, close=True)
    apart = random_tracks(seed, mutual=0j, coupled=False, close=True)
    solved(together)
    solved(apart)
    assert together.network.groups != ()
    assert apart.network.groups == ()
    assert np.abs(voltages(together) - voltages(apart)).max() < 1e-12 * E


@pytest.mark.parametrize("seed", range(8))
def test_what_is_fed_is_drawn_or_lost(seed):
    case = random_tracks(seed, close=True)
    solved(case)
    drawn = case.loads.types.auxiliary_power_w.sum()
    lost = case.flow.groups.lost_w.sum()
    assert case.fed.real.sum() == pytest.approx(drawn + lost, abs=1e-3)
    assert lost > 0.0


def test_the_share_of_too_large_a_load_is_that_of_another_load_flow():
    trains = [(0, 21e3, 12e6 + 6e6j), (1, 34e3, 10e6 + 4e6j), (1, 8e3, 4e6 + 0j)]
    case = cell(*trains, ends=(ROTARY,))
    share, _ = solve(False, case.network, case.flow, case.loads)
    assert 0.1 < share < 1.0
    expected, _ = carry(Equations.of(case.network, case.flow, case.loads))
    assert share == pytest.approx(expected, rel=1e-3)


# Derivatives


def residuals(case):
    """Gaps of the sections, and currents that nodes without source have left, or the sources' laws."""
    flow, network = case.flow, case.network
    left = flow.nodes.leaving_current_a.copy()
    for s, source in enumerate(network.sources):
        left[source.node] = flow.nodes[source.node].voltage_v - E
        assert network.source_of_node[source.node] == s
    return np.concatenate([flow.sections.gap_v, left])


@pytest.mark.parametrize("seed", range(12))
def test_the_newton_step_is_that_of_the_differences(seed):
    """Along the step d = -J⁻¹ r the residuals change by -r: (r(x + h d) - r(x - h d)) / 2h = -r(x)."""
    rng = np.random.default_rng(seed)
    trains = [
        (int(k), float(x), complex(p, q))
        for k, x, p, q in zip(
            rng.integers(0, 3, 6),
            rng.uniform(0.0, D, 6),
            rng.uniform(-1e6, 2e6, 6),
            rng.uniform(-1e6, 1e6, 6),
            strict=True,
        )
    ]
    nodes = [[0, 1 if seed % 2 else 1 + k] for k in range(3)]
    case = side_by_side(
        [0.0, D], nodes, trains, sources((0, STIFF)), ZM, impedance=ZS, susceptance=CAPACITANCE
    )
    flow = case.flow
    count = flow.nodes.size
    flow.nodes.voltage_v = E * (
        1.0 + 0.05 * rng.normal(size=count) + 0.05j * rng.normal(size=count)
    )
    flow.sections.current_a = rng.normal(0.0, 100.0, 3) + 1j * rng.normal(0.0, 100.0, 3)
    arguments = (1.0, WARM, case.network, flow, case.loads)
    evaluate(*arguments)
    expected = -residuals(case)
    find_direction(case.network, flow)
    mark_base(flow)
    at_steps = []
    for h in (1e-4, -1e-4):
        take_step(h, flow)
        evaluate(*arguments)
        at_steps.append(residuals(case))
    slope = (at_steps[0] - at_steps[1]) / 2e-4
    scale = np.where(np.arange(expected.size) < 3, E, 100.0)
    assert np.abs((slope - expected) / scale).max() < 1e-6


def test_a_linked_pass_takes_the_currents_of_the_trains_from_their_tangents():
    """At the trains' voltages themselves it is a warm pass; a volt beside, it errs by its square."""
    case = random_tracks(5)
    solved(case)
    network, flow, loads = case.network, case.flow, case.loads

    def end_currents(start):
        begin_pass(False, network, flow)
        evaluate_groups(network.groups, 0.0, 0.0, 1.0, 1.0, start, network, flow, loads)
        return flow.sections.end_current_a.copy()

    exact, at_trains = end_currents(WARM), flow.standing.voltage_v.copy()
    np.testing.assert_allclose(end_currents(LINKED), exact, atol=1e-9)
    errors = []
    for volts in (10.0, 20.0):
        flow.standing.voltage_v = at_trains + volts * np.exp(1j * np.arange(at_trains.size))
        flow.search[0].moved_v = 0.0
        errors.append(np.abs(end_currents(LINKED) - exact).max())
        end_currents(MOVED)
        assert flow.search[0].moved_v == pytest.approx(volts, rel=0.05)
    assert errors[1] / errors[0] == pytest.approx(4.0, rel=0.05)


@pytest.mark.parametrize("n", [1, 2, 4])
def test_small_systems_of_pairs_are_solved_with_the_sign_of_their_determinants(as_run, n):
    """A pair (p, q) is the real matrix of δ -> p δ + q conj(δ); its first pivot may well be singular."""
    rng = np.random.default_rng(n)
    for trial in range(6):
        rows = rng.normal(size=(n, 3 * n, 2)) + 1j * rng.normal(size=(n, 3 * n, 2))
        if trial == 0 and n > 1:
            rows[0, 0] = 0.0
        left, right = _real(*np.moveaxis(rows[:, :n], 2, 0)), _real(*np.moveaxis(rows[:, n:], 2, 0))
        sign = as_run(eliminate)(rows)
        assert sign == np.sign(np.linalg.det(left))
        found = _real(*np.moveaxis(rows[:, n:], 2, 0))
        np.testing.assert_allclose(found, np.linalg.solve(left, right), rtol=1e-8, atol=1e-9)


def _real(p, q):
    """Real matrix of a matrix of pairs."""
    found = np.zeros((2 * p.shape[0], 2 * p.shape[1]))
    found[::2, ::2], found[::2, 1::2] = p.real + q.real, q.imag - p.imag
    found[1::2, ::2], found[1::2, 1::2] = p.imag + q.imag, p.real - q.real
    return found


# Dead conductors


def test_a_track_that_is_not_fed_carries_nothing_and_induces_nothing():
    """The live one is what it is alone; a dead one has no voltage, as everything that is not fed."""
    trains = [(0, 12e3, 2e6 + 1e6j), (0, 30e3, 1e6 + 0j)]
    fed = sources((0, STIFF), (1, STIFF))
    case = side_by_side([0.0, D], [[0, 1], [2, 3]], trains, fed, ZM, impedance=ZS)
    solved(case)
    alone = simple_line(D, [12e3, 30e3], [2e6 + 1e6j, 1e6 + 0j], STIFF, STIFF, impedance=ZS)
    solved(alone)
    np.testing.assert_allclose(case.train_voltage, alone.train_voltage, rtol=1e-12)
    assert (case.flow.nodes.voltage_v[2:] == 0.0).all()
    assert abs(case.flow.sections.current_a[1]) == 0.0


def test_the_twin_knows_the_admittances_of_a_short_piece_of_two_tracks():
    """Without trains between two nodes of each track: the inverse of [[Zs, Zm], [Zm, Zs]] d."""
    case = side_by_side([0.0, D], [[0, 2], [1, 3]], [], sources((0, STIFF)), ZM, impedance=ZS)
    y = admittance_matrix(case.network, case.flow)
    own = np.linalg.inv(np.array([[ZS, ZM], [ZM, ZS]]) * D)
    np.testing.assert_allclose(y, np.block([[own, -own], [-own, own]]), rtol=1e-9)
