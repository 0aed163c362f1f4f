"""The mismatches of the original program: zero at a solution, and their derivatives by differences."""

from types import SimpleNamespace

import numpy as np
import pytest

from tpss.original.grid import lay_out
from tpss.original.least_squares import Search
from tpss.original.mismatch import Mismatch
from tpss.powerflow.solve import solve

from networks import ROTARY, STIFF, simple_line

LOADED = ([4e3, 9e3, 21e3], [2e6 + 1e6j, 1e6 - 0.2e6j, 3e6 + 0.5e6j])


def fed_from_both_ends():
    return simple_line(30e3, *LOADED, ROTARY, ROTARY, susceptance=1e-9)


def unknowns(case):
    volts = np.concatenate([case.flow.nodes.voltage_v, case.train_voltage])
    return np.concatenate(
        [np.angle(volts), np.abs(volts) / 16.5e3, case.fed.real / 10e6, case.fed.imag / 10e6]
    )


def mismatch(case, share=1.0):
    grid = lay_out(len(case.train_voltage), case.network, case.flow)
    return Mismatch(grid, case.network, case.flow, case.loads, share)


def test_nothing_is_left_at_the_solution_of_the_equations():
    """Tolerance of the equations: 1e-10 of base voltage, some 1e-9 of base power."""
    case = fed_from_both_ends()
    assert solve(False, case.network, case.flow, case.loads)[0] == 1.0
    assert np.abs(mismatch(case).residuals(unknowns(case))).max() < 1e-9


def test_without_generation_a_mismatch_is_what_is_consumed_and_transmitted_away():
    """At one voltage everywhere nothing is transmitted: ΔP = -P_D and ΔQ = -Q_D at the trains."""
    case = simple_line(30e3, *LOADED, STIFF)
    x = np.concatenate([np.zeros(5), np.ones(5), [0.3, 0.1]])
    active, reactive = mismatch(case).residuals(x)[:10].reshape(2, 5)
    assert active == pytest.approx([0.3, 0.0, -0.2, -0.1, -0.3])
    assert reactive == pytest.approx([0.1, 0.0, -0.1, 0.02, -0.05])


@pytest.mark.parametrize("share", [1.0, 0.3])
def test_jacobian_is_that_of_the_residuals(share):
    case = fed_from_both_ends()
    problem = mismatch(case, share)
    generator = np.random.default_rng(1)
    x = np.concatenate([generator.uniform(-0.3, 0.1, 5), generator.uniform(0.8, 1.0, 5)])
    x = np.concatenate([x, generator.uniform(0.0, 0.5, 4)])
    reach = 1e-5 * np.eye(x.size)
    columns = [(problem.residuals(x + r) - problem.residuals(x - r)) / 2e-5 for r in reach]
    assert problem.jacobian(x) == pytest.approx(np.array(columns).T, abs=1e-7)


def test_low_voltage_solution_within_the_plausible_band_is_refused():
    """Over X = 0.65 p.u. with P = 1 p.u. and Q X = -0.3 there are two voltages at the load:

    V⁴ - (1 - 2 Q X) V² + X² (P² + Q²) = V⁴ - 1.6 V² + 0.5125 = 0:  V = 1.0757 or 0.6655.
    """
    x, q = 0.65, -0.3 / 0.65
    impedance = 1j * x * (16.5**2 / 10) / 999.0
    case = simple_line(1e3, [999.0], [10e6 + 10e6j * q], STIFF, impedance=impedance)
    loads = case.loads
    search = Search(
        lay_out(1, case.network, case.flow),
        1,
        SimpleNamespace(network=case.network, points=loads.points, **loads.driving._asdict()),
        SimpleNamespace(flow=case.flow, trains=loads.trains, scratch=loads.scratch),
    )

    def solution(voltage):
        angle = -np.arcsin(x / voltage)
        fed = q + x * (1.0 + q**2) / voltage**2
        return np.array([0.0, angle, angle, 1.0, voltage, voltage, 1.0, fed])

    high, low = np.sqrt(0.8 + np.array([1, -1]) * np.sqrt(0.1275))
    for voltage in (high, low):
        assert np.abs(search.problem(1.0).residuals(solution(voltage))).max() < 1e-9
    assert search.attempt(1.0, solution(high))
    assert abs(case.train_voltage[0]) == pytest.approx(high * 16.5e3)
    assert not search.attempt(1.0, solution(low))
