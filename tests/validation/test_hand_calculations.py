"""The expected values of the closed forms, worked out once more by code of their own."""

import json
import math
from importlib.resources import files

import pytest

from cases import HERE, load_case

TRACTIVE_EFFORT = json.loads((files("tpss.library") / "networks.json").read_text("utf-8"))[
    "tractive_effort"
]


def expected(folder):
    """Expected values of a case by quantity and run."""
    quantities = load_case(HERE / folder).expected.quantities
    return {(q.name, run): value for q in quantities for run, value in q.published.items()}


def motor_force_n(speed_kmh, voltage_kv, current_a):
    """The network of [Boullanger2009], appendix C, as it is printed: inputs and output on ±1."""
    net = TRACTIVE_EFFORT
    inputs = [
        2.0 * (x - low) / (high - low) - 1.0
        for x, low, high in zip(
            (speed_kmh, voltage_kv, current_a), net["input_min"], net["input_max"], strict=True
        )
    ]
    output = net["b2"] + sum(
        w2 * math.tanh(b1 + sum(w * x for w, x in zip(w1, inputs, strict=True)))
        for w1, b1, w2 in zip(net["W1"], net["b1"], net["w2"], strict=True)
    )
    return net["output_min"] + (output + 1.0) / 2.0 * (net["output_max"] - net["output_min"])


def balancing_speed_kmh(permille, voltage_kv):
    """Where the force at 1250 A equals A + B v + C v² + m g α, by bisection."""
    low, high = 40.0, 240.0
    while high - low > 1e-9:
        kmh = (low + high) / 2.0
        v = kmh / 3.6
        resistance = 15_400.0 + 279.0 * v + 49.2 * v**2 + 1_470e3 * 9.81 * permille / 1e3
        if motor_force_n(kmh, voltage_kv, 1250.0) > resistance:
            low = kmh
        else:
            high = kmh
    return low


@pytest.mark.parametrize("permille", [0, 5, 10])
def test_the_balancing_speed_is_the_root_of_the_force_balance(permille):
    """The second assertion is the reason of the tolerance: what ten volts are worth."""
    value = expected("Closed_form_balancing_speed")["balancing speed", f"{permille} ‰"]
    at_16_500_v = balancing_speed_kmh(permille, 16.5)
    assert value == pytest.approx(at_16_500_v, abs=5e-4)
    assert at_16_500_v - balancing_speed_kmh(permille, 16.49) <= 0.048


def test_the_voltage_between_two_equal_stations_is_the_root_of_a_quadratic():
    """U⁴ - (E² - 2 R P) U² + |Z|² P² = 0, Z = z x (L - x) / L = 30 km of BT catenary."""
    z = complex(0.21, 0.20) * 40.0 * 120.0 / 160.0
    b = 16_500.0**2 - 2.0 * z.real * 2e6
    voltage = math.sqrt((b + math.sqrt(b**2 - 4.0 * abs(z) ** 2 * 2e6**2)) / 2.0)
    values = expected("Closed_form_two_stations")
    assert values["voltage at the train", "equal voltages"] == pytest.approx(voltage, abs=5e-3)


def test_rotary_stations_share_inversely_to_their_reactances():
    """X_q^m / 3 + X_q^g of a Q48/Q49, by the number that run, and j0.2 Ω/km of line."""
    x = 0.49 * 16.5**2 / 10.7 / 3.0 + 0.53 * 16.5**2 / 10.0
    west, east = x / 4.0 + 0.2 * 40.0, x / 2.0 + 0.2 * 120.0
    values = expected("Closed_form_two_stations")
    share = values["first station's share of the active power", "rotary, 4 and 2"]
    assert share == pytest.approx(100.0 * east / (west + east), abs=5e-3)


@pytest.mark.parametrize(("run", "permille"), [("level", 0.0), ("5 ‰", 5.0)])
def test_the_power_at_constant_speed_is_that_of_resistance_and_climb(run, permille):
    v = 60.0 / 3.6
    force = 15_400.0 + 279.0 * v + 49.2 * v**2 + 1_470e3 * 9.81 * permille / 1e3
    value = expected("Closed_form_power_at_constant_speed")["power at 80 km", run]
    assert value == pytest.approx(force * v / 0.8 + 151_500.0, abs=0.5)


@pytest.mark.parametrize("speed_m_s", [20.0, 40.0])
def test_time_and_way_of_a_start_are_those_of_constant_force_then_power(speed_m_s):
    """Energy P t = M v² / 2 and its integral; the second assertion is the reason of the tolerance."""
    mass_kg, force_n, power_w, step_s = 400e3, 200e3, 4e6, 0.06
    v1 = power_w / force_n
    time_s = mass_kg * v1 / force_n + mass_kg * (speed_m_s**2 - v1**2) / (2.0 * power_w)
    way_m = mass_kg * v1**2 / (2.0 * force_n) + mass_kg * (speed_m_s**3 - v1**3) / (3.0 * power_w)
    values = expected("Closed_form_constant_power")
    run = f"to {speed_m_s:g} m/s"
    assert values["time from standstill", run] == pytest.approx(time_s, abs=5e-3)
    assert values["way from standstill", run] == pytest.approx(way_m, abs=5e-3)
    assert step_s / 2.0 * math.log(speed_m_s / v1) <= 0.021
