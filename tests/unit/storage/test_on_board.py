"""The rule of a store on board: braking first, a cap of the line's power, charging at stops."""

import math

import numpy as np
import pytest

from tpss.storage.on_board import OnBoard, exchange
from tpss.storage.store import Store, Stored, begin_store, energy_after

STEP_S = 5.0


def on_board(**fields):
    store = Store.row(
        capacity_j=14.4e6, charge_power_w=900e3, discharge_power_w=900e3, charge_efficiency=0.93,
        discharge_efficiency=0.93,
    )  # fmt: skip
    return OnBoard.array([OnBoard.row(store=store, **{"line_cap_w": 600e3, **fields})])[0]


TWELVE_STEPS = [
    # asked for or, below 0, offered: W; taken by the store: W; from the line: W; energy after: J
    (300000.0, 0.0, 300000.0, 7200000.0),
    (1200000.0, -600000.0, 600000.0, 3974193.548),
    (1600000.0, -739200.0, 860800.0, 0.0),
    (1400000.0, 0.0, 1400000.0, 0.0),
    (700000.0, 0.0, 700000.0, 0.0),
    (-400000.0, 400000.0, 0.0, 1860000.0),
    (-1300000.0, 900000.0, -400000.0, 6045000.0),
    (-800000.0, 800000.0, 0.0, 9765000.0),
    (50000.0, 0.0, 50000.0, 9765000.0),
    (1500000.0, -900000.0, 600000.0, 4926290.323),
    (1500000.0, -900000.0, 600000.0, 87580.64516),
    (1500000.0, -16290.0, 1483710.0, 0.0),
]


def test_a_store_caps_what_the_line_gives_and_takes_what_is_braked():
    """4 kWh, 0.9 MW, 93 % each way, 0.6 MW from the line, half full; twelve steps of 5 s.

    Of 1.2 MW it gives 0.6, which takes 0.6 MW x 5 s / 0.93 = 3.226 MJ; of 1.6 MW what is left, 3.974 MJ
    x 0.93 / 5 s = 739.2 kW, and the line the rest; it takes 0.9 of 1.3 MW, and the line 0.4.
    """
    own = on_board()
    state = Stored.array([Stored.row(energy_j=7.2e6)])[0]
    for power_w, taken_w, line_w, after_j in TWELVE_STEPS:
        begin_store(STEP_S, own.store, state)
        asked_w, offered_w = max(power_w, 0.0), max(-power_w, 0.0)
        line, _, used = exchange(750.0, asked_w, 0.0, offered_w, 1.0, 0.0, False, own, state)
        assert state.power_w == pytest.approx(taken_w, rel=1e-9, abs=1e-6)
        assert line == pytest.approx(line_w, rel=1e-9, abs=1e-6)
        assert used == offered_w
        state.energy_j = energy_after(state.power_w, STEP_S, own.store, state)
        assert state.energy_j == pytest.approx(after_j, rel=1e-9, abs=1e-3)


def begun(own, energy_j=7.2e6):
    state = Stored.array([Stored.row(energy_j=energy_j)])[0]
    begin_store(STEP_S, own.store, state)
    return state


def test_where_the_line_takes_less_the_store_has_had_its_part_before():
    """1.3 MW, 0.9 to the store; of the other 0.4 MW the line takes a quarter."""
    own = on_board()
    state = begun(own)
    line, _, used = exchange(890.0, 0.0, 0.0, 1.3e6, 0.25, -0.05, False, own, state)
    assert (state.power_w, line, used) == (900e3, -100e3, 1e6)


def test_a_train_that_stands_charges_within_its_standing_current():
    """35 kW of auxiliaries; 400 A at 750 V are 300 kW, 265 kW of them for the store."""
    own = on_board(standing_current_a=400.0)
    state = begun(own)
    line, slope, _ = exchange(750.0, 35e3, 0.0, 0.0, 1.0, 0.0, True, own, state)
    assert (state.power_w, line, slope) == (265e3, 300e3, 400.0)
    state = begun(own)
    line, _, _ = exchange(750.0, 35e3, 0.0, 0.0, 1.0, 0.0, False, own, state)
    assert (state.power_w, line) == (0.0, 35e3)


def test_charging_keeps_to_the_cap_and_to_the_room_in_the_store():
    """1000 A would be 750 kW; the cap is 600 kW.  With 0.1 MJ of room, 0.1 MJ / 0.93 / 5 s = 21.5 kW."""
    own = on_board(standing_current_a=1000.0)
    state = begun(own)
    line, slope, _ = exchange(750.0, 35e3, 0.0, 0.0, 1.0, 0.0, True, own, state)
    assert (line, slope) == (600e3, 0.0)
    state = begun(own, 14.3e6)
    line, _, _ = exchange(750.0, 35e3, 0.0, 0.0, 1.0, 0.0, True, own, state)
    assert line == pytest.approx(35e3 + 0.1e6 / 0.93 / 5.0)


def test_without_a_cap_it_rests_while_the_line_feeds_the_train():
    own = on_board(line_cap_w=math.inf)
    state = begun(own)
    line, slope, _ = exchange(750.0, 1.5e6, 120.0, 0.0, 1.0, 0.0, False, own, state)
    assert (state.power_w, line, slope) == (0.0, 1.5e6, 120.0)


def test_the_slope_is_that_of_the_line_s_power():
    """Against differences, for trains that ask for more at a higher voltage and brakes that fade."""
    rng = np.random.default_rng(3)
    for _ in range(500):
        own = on_board(standing_current_a=rng.choice([0.0, 500.0]))
        energy_j = 14.4e6 * rng.choice([0.0, rng.uniform(), 1.0])
        asked_w, offered_w, stands = rng.uniform(0, 2e6), rng.choice([0.0, 2e6]), rng.random() < 0.3

        def line_w(
            voltage_v,
            own=own,
            energy_j=energy_j,
            asked_w=asked_w,
            offered_w=offered_w,
            stands=stands,
        ):
            share = 0.5 - 0.02 * (voltage_v - 890.0)
            asked = asked_w + 100.0 * (voltage_v - 890.0)
            state = begun(own, energy_j)
            return exchange(voltage_v, asked, 100.0, offered_w, share, -0.02, stands, own, state)[
                :2
            ]

        _, slope = line_w(890.0)
        above, below = line_w(890.0 + 1e-3)[0], line_w(890.0 - 1e-3)[0]
        assert slope == pytest.approx((above - below) / 2e-3, rel=1e-4, abs=1.0)
