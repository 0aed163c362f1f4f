"""What the networks know of outputs."""

import numpy as np
import pytest

from tpss.approximator.scales import output_of, scaled, unscaled


@pytest.mark.parametrize(
    ("name", "values", "scale"),
    [
        ("trip_time_min", [60.0, 90.0, 200.0], "log"),
        ("losses_mwh", [-0.1, 0.0, 3.0], "linear"),
        ("lowest_voltage_kv", [9.0, 15.0, 16.0], "drop"),
    ],
)
def test_values_are_scaled_to_plus_and_minus_one_and_back(name, values, scale):
    output = output_of(name, np.array(values))
    assert output.scale == scale
    x = scaled(values, output)
    assert (x.min(), x.max()) == pytest.approx((-1.0, 1.0))
    assert (np.diff(x) > 0.0).all()
    assert unscaled(x, output) == pytest.approx(values, rel=1e-12)


def test_a_voltage_is_known_by_its_drop():
    """From 16 + 0.05 · 8 = 16.4 kV, trained from 8 to 16 kV: drops of 8.4 and 0.4 kV are -1 and 1.

    Halfway between them, by ratio, is a drop of √(8.4 · 0.4) = 1.8330 kV, which is 14.567 kV.
    """
    output = output_of("lowest_voltage_kv", np.array([8.0, 16.0]))
    assert unscaled(np.zeros(1), output) == pytest.approx(14.567, abs=1e-3)
