"""The power of a store at the line over its voltage: dead band, slopes, limits."""

import numpy as np
import pytest

from tpss.storage.store import Stored
from tpss.storage.wayside import StoreLaw, power_at_voltage

LAW = StoreLaw.blank(1)[0]
LAW.charges_above_v, LAW.charge_w_per_v = 830.0, 25e3
LAW.discharges_below_v, LAW.discharge_w_per_v = 770.0, 15e3
STATE = Stored.array([Stored.row(charge_limit_w=500e3, discharge_limit_w=300e3)])[0]


@pytest.mark.parametrize(
    ("voltage_v", "power_w", "slope"),
    [
        (800.0, 0.0, 0.0),
        (830.0, 0.0, 0.0),
        (770.0, 0.0, 0.0),
        (840.0, 250e3, 25e3),
        (851.0, 500e3, 0.0),
        (760.0, -150e3, 15e3),
        (749.0, -300e3, 0.0),
    ],
)
def test_power_and_slope(voltage_v, power_w, slope):
    """25 kW/V above 830 V up to 500 kW, 15 kW/V below 770 V up to 300 kW, nothing between."""
    assert power_at_voltage(voltage_v, LAW, STATE) == (power_w, slope)


def test_the_slope_is_that_of_the_power():
    for voltage_v in np.linspace(740.0, 860.0, 241) + 0.1:
        _, slope = power_at_voltage(voltage_v, LAW, STATE)
        above, below = (power_at_voltage(voltage_v + d, LAW, STATE)[0] for d in (1e-4, -1e-4))
        assert slope == pytest.approx((above - below) / 2e-4, abs=1.0)
