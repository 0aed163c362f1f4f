"""Random lines up to and past collapse, each judged by a slow load flow.

``python benchmarks/stress.py`` does the same with ten thousand lines.
"""

import math

import numpy as np
import pytest

from tpss.powerflow.chain import WARM
from tpss.powerflow.newton import MOST_PASSES, Solution, newton
from tpss.powerflow.solve import solve

from networks import BT, ROTARY, STIFF, constant_loads, network_of, place, simple_line, sources
from stress import COLLAPSED, run
from stress import SOLVED as CARRIED

LINES = range(20_000, 20_150)


@pytest.fixture(scope="module")
def stressed():
    return run(LINES)


def test_no_start_leads_to_a_wrong_result(stressed):
    """No false root, no NaN, no other branch, no load given up that the line carries."""
    _, faults = stressed
    assert faults == []


def test_lines_up_to_and_past_collapse_were_tried(stressed):
    outcomes = stressed[0]["flat"].outcomes
    assert outcomes[CARRIED] > len(LINES) / 2
    assert outcomes[COLLAPSED] > len(LINES) / 10


@pytest.mark.parametrize(("start", "mean", "worst"), [("flat", 8.0, 90), ("step", 4.0, 8)])
def test_solutions_take_few_passes(stressed, start, mean, worst):
    """A slow but converging fault shows here.  The worst flat start needs the continuation."""
    passes = stressed[0][start].passes[CARRIED]
    assert np.mean(passes) < mean
    assert max(passes) <= worst


def test_the_root_beyond_the_turning_point_is_no_solution():
    """Both roots of the closed form lie in the plausible band if the load is capacitive.

    E = 16.5 kV, Z = 8.4 + 8.0j ohm, S = 8 - 5.5j MVA:
    U² = E²/2 - (RP + XQ) ± √((E²/2 - (RP + XQ))² - |Z|²|S|²), so U = 11.01 kV or 10.23 kV.
    """
    z, load = BT * 40e3, 8e6 - 5.5e6j
    half = 16_500.0**2 / 2 - (z.real * load.real + z.imag * load.imag)
    apart = math.sqrt(half**2 - abs(z * load) ** 2)
    high, low = math.sqrt(half + apart), math.sqrt(half - apart)
    assert (high, low) == pytest.approx((11_010, 10_230), abs=10)
    case = simple_line(60e3, [40e3], [load], STIFF)
    # With U real, E = U + Z (S / U)*, turned back so that the source has the angle 0.
    source = low + z * load.conjugate() / low
    turned = low * abs(source) / source
    case.flow.sections.current_a = (load / turned).conjugate()
    case.flow.nodes.voltage_v = [16_500.0, turned]
    status, _ = newton(1.0, WARM, MOST_PASSES, case.network, case.flow, case.loads)
    assert status == Solution.WRONG_BRANCH
    share, _ = solve(True, case.network, case.flow, case.loads)
    assert share == 1.0
    assert abs(case.train_voltage[0]) == pytest.approx(high, rel=1e-9)


def test_stations_in_antiphase_are_no_solution():
    """From there Newton's method finds 651 Mvar from one machine, whose droop leaves -16 kV."""
    train = 1e6 + 0j
    case = simple_line(2e3, [1e3], [train], ROTARY, {**ROTARY, "installed": 6})
    case.flow.nodes.voltage_v = 16_500.0 * np.array([0.973, 0.996]) * np.exp([2.81j, -1.85j])
    west, east = case.flow.nodes.voltage_v
    case.flow.sections.current_a = (west - east) / (BT * 2e3)
    status, _ = newton(1.0, WARM, MOST_PASSES, case.network, case.flow, case.loads)
    assert status != Solution.SOLVED
    share, _ = solve(True, case.network, case.flow, case.loads)
    assert share == 1.0
    assert np.abs(np.angle(case.flow.nodes.voltage_v)).max() < 0.1


def test_feeding_points_eight_metres_apart_are_solved():
    """Over 8 m of 132 kV line, 10 µΩ, the rounding of a voltage is a mismatch of 1e-10 of base power."""
    per_m = complex(0.051, 0.062) * 1e-3 / 8**2
    sections = [(0, 1, 0.0, 50e3, BT, 0.0), (1, 2, 50e3, 50_008.0, BT, 0.0)]
    branches = [(0, 3, 0.037 + 0.54j), (1, 4, 0.065 + 0.85j), (2, 5, 0.065 + 0.85j)]
    branches += [(3, 4, per_m * 50e3), (4, 5, per_m * 8.0)]
    network = network_of(6, sections, branches, sources((0, ROTARY)))
    for km in range(26, 46):
        case = place(network, constant_loads([1e3 * km], [2e6 + 1e6j]))
        share, passes = solve(False, case.network, case.flow, case.loads)
        assert share == 1.0
        assert passes <= 10
