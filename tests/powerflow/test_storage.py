"""A supercapacitor at a line of 750 V over ten steps, against other programs' ten digits."""

import numpy as np
import pytest

from tpss.powerflow.solve import solve
from tpss.powerflow.stores import begin_stores
from tpss.storage.store import Store, energy_after

from direct_lines import Braking, Drawing, diode, direct_line

STATIONS = [(0.0, diode(800.0, 0.02)), (5.0, diode(800.0, 0.02))]
STORE = {
    "store": Store.row(
        capacity_j=12e6, charge_power_w=800e3, discharge_power_w=800e3, charge_efficiency=0.95,
        discharge_efficiency=0.95, capacitance_f=128.0, empty_j=4e6, highest_current_a=1900.0,
    ),
    "start_j": 3e6,
    "charges_above_v": 830.0,
    "discharges_below_v": 770.0,
    "charge_w_per_v": 25e3,
    "discharge_w_per_v": 15e3,
}  # fmt: skip

STEPS = [
    # first train: km, MW; second train: km, MW; store: V, W; trains: V; stations: A; energy after: J
    (2.0, 1.5, 3.9, 0.3, 738.2751446, -475872.8307, (726.0357795, 757.1006633),
     (973.2134274, 844.4751321), 495406.1545),
    (2.05, 1.6, 3.86, 0.3, 703.8574523, -94127.16935, (694.6260745, 736.8985849),
     (1361.420226, 1215.358535), 0.0),
    (2.13, 0.7, 3.8, 0.2, 755.0459718, 0.0, (752.5206842, 768.1400559),
     (596.1742319, 594.401942), 0.0),
    (2.22, -1.3, 3.73, 0.1, 887.3156297, 500000.0, (890.726374, 883.0986604), (0.0, 0.0), 2375000.0),
    (2.3, -1.5, 3.65, -0.9, 891.7866571, 631219.0586, (893.3498983, 897.0196313), (0.0, 0.0),
     5373290.529),
    (2.37, -1.2, 3.58, -1.2, 889.8345806, 765395.7526, (890.3791687, 896.8336401), (0.0, 0.0),
     9008920.353),
    (2.42, -0.4, 3.53, -0.8, 882.3551257, 629700.9783, (882.754775, 892.7919214), (0.0, 0.0), 12e6),
    (2.45, 0.05, 3.5, 0.05, 795.3283152, 0.0, (795.2533111, 795.5266923),
     (53.57436698, 72.15012383), 12e6),
    (2.47, 1.4, 3.49, 0.05, 740.9860799, -435208.8014, (738.508439, 756.5472333),
     (676.7651387, 697.7001714), 9709427.361),
    (2.52, 1.7, 3.44, 1.5, 672.5026592, -800000.0, (663.5929074, 661.2770768),
     (1462.125468, 2178.437864), 5498901.045),
]  # fmt: skip


def train(km, power_mw):
    """One that draws, or brakes without auxiliaries: all is taken up to 880 V, nothing from 900 V."""
    if power_mw < 0.0:
        return Braking(km, -power_mw * 1e6, 880.0, 900.0, 0.0)
    return Drawing(km, power_mw * 1e6)


@pytest.mark.parametrize("warm", [False, True], ids=["each by itself", "from the step before"])
def test_a_supercapacitor_charges_discharges_and_meets_its_limits(warm):
    """128 F between 250 and 500 V at km 2.4 between stations of 800 V behind 0.02 ohm; steps of 5 s.

    It starts with 3 of 12 MJ, gives 475.9 kW / 0.95 in the first step and what is left in the second,
    94.1 kW = 495.4 kJ x 0.95 / 5 s.  It charges with the 1900 A that it bears, at first 500 kW =
    1900 A x 250 V / 0.95, is full after the seventh (629.7 kW = 2.991 MJ / (0.95 x 5 s)), and gives
    0.8 MW at last.  By nodal Newton and by a scan of all roots.
    """
    energy_j, before = 3e6, None
    for (
        first_km,
        first_mw,
        second_km,
        second_mw,
        store_v,
        store_w,
        train_v,
        station_a,
        after_j,
    ) in STEPS:
        trains = [train(first_km, first_mw), train(second_km, second_mw)]
        case = direct_line(750.0, 0.028, STATIONS, trains, [(2.4, STORE)])
        state = case.flow.stores[0]
        state.energy_j = energy_j
        begin_stores(5.0, case.network, case.flow)
        if warm and before is not None:
            for part in ("voltage_v", "last_v", "before_v"):
                case.flow.nodes[part] = before[0]
            for part in ("current_a", "last_a", "before_a"):
                case.flow.sections[part] = before[1]
            case.loads.trains["line_voltage_v"] = before[2]
        share, _ = solve(warm and before is not None, case.network, case.flow, case.loads)
        node_v, section_a = (
            case.flow.nodes["voltage_v"].copy(),
            case.flow.sections["current_a"].copy(),
        )
        before = node_v, section_a, case.train_voltage.copy()
        assert share == 1.0
        assert np.abs(case.flow.nodes.voltage_v.imag).max() < 1e-9
        nodes = case.flow.nodes[case.network.sources.node]
        # A station that blocks leaks a ten-millionth of its conductance: 0.4 mA, some 10 µV.
        assert nodes.leaving_current_a.real == pytest.approx(station_a, rel=2e-8, abs=1e-3)
        node = case.network.stores[0].node
        assert case.flow.nodes[node].voltage_v.real == pytest.approx(store_v, rel=1e-8, abs=3e-5)
        assert state.power_w == pytest.approx(store_w, rel=1e-8, abs=1e-6)
        assert case.train_voltage.real == pytest.approx(train_v, rel=1e-8, abs=3e-5)
        energy_j = energy_after(state.power_w, 5.0, case.network.stores[0].store, state)
        assert energy_j == pytest.approx(after_j, rel=1e-8, abs=1e-3)
