"""A store of energy over one step: limits, losses, and what no step can do."""

import numpy as np
import pytest

from tpss.storage.store import Store, Stored, begin_store, energy_after, lost_power


def store(**fields):
    """One of 10 MJ and 1 MW, 0.8 in and 0.5 out."""
    given = {
        "capacity_j": 10e6, "charge_power_w": 1e6, "discharge_power_w": 1e6,
        "charge_efficiency": 0.8, "discharge_efficiency": 0.5, **fields,
    }  # fmt: skip
    return Store.array([Store.row(**given)])[0]


def begun(energy_j, step_s, own):
    state = Stored.array([Stored.row(energy_j=energy_j)])[0]
    begin_store(step_s, own, state)
    return state


def test_power_is_limited_by_its_rating_in_the_middle():
    state = begun(5e6, 1.0, store())
    assert (state.charge_limit_w, state.discharge_limit_w) == (1e6, 1e6)


def test_a_step_charges_no_more_than_there_is_room():
    """1 MJ of room: at 80 % 1.25 MJ fill it, 125 kW for 10 s."""
    state = begun(9e6, 10.0, store())
    assert state.charge_limit_w == pytest.approx(125e3)
    assert energy_after(state.charge_limit_w, 10.0, store(), state) == 10e6


def test_a_step_gives_no_more_than_there_is():
    """1 MJ gives at 50 % 0.5 MJ, 50 kW for 10 s."""
    state = begun(1e6, 10.0, store())
    assert state.discharge_limit_w == pytest.approx(50e3)
    assert energy_after(-state.discharge_limit_w, 10.0, store(), state) == 0.0


def test_a_supercapacitor_is_limited_by_its_current_at_its_voltage():
    """128 F at 3 + 4 MJ has sqrt(2 x 7e6 / 128) = 330.72 V; 1900 A x 330.72 V / 0.95, x 0.95."""
    own = store(
        capacity_j=12e6, charge_efficiency=0.95, discharge_efficiency=0.95, capacitance_f=128.0,
        empty_j=4e6, highest_current_a=1900.0,
    )  # fmt: skip
    state = begun(3e6, 1.0, own)
    assert state.charge_limit_w == pytest.approx(661437.8278, rel=1e-9)
    assert state.discharge_limit_w == pytest.approx(1900.0 * 330.7189139 * 0.95, rel=1e-9)


def test_standing_by_a_flywheel_runs_down_and_stops():
    """50 kW: 0.5 MJ in 10 s, then the rest."""
    own = store(standby_w=50e3)
    state = begun(0.6e6, 10.0, own)
    assert state.standby_j == pytest.approx(0.5e6)
    assert energy_after(0.0, 10.0, own, state) == pytest.approx(0.1e6)
    assert lost_power(0.0, 10.0, own, state) == pytest.approx(50e3)
    state = begun(0.1e6, 10.0, own)
    assert energy_after(0.0, 10.0, own, state) == 0.0
    assert lost_power(0.0, 10.0, own, state) == pytest.approx(10e3)


def test_what_is_taken_is_kept_or_lost():
    """Charging 0.5 MW loses 20 %; giving 0.5 MW takes 1 MW of the energy."""
    state = begun(5e6, 2.0, store())
    assert energy_after(0.5e6, 2.0, store(), state) == pytest.approx(5.8e6)
    assert lost_power(0.5e6, 2.0, store(), state) == pytest.approx(0.1e6)
    assert energy_after(-0.5e6, 2.0, store(), state) == pytest.approx(3e6)
    assert lost_power(-0.5e6, 2.0, store(), state) == pytest.approx(0.5e6)


def test_no_step_passes_full_or_empty_whatever_is_asked():
    """Ten thousand random stores, states, steps and powers within their limits; the balance closes."""
    rng = np.random.default_rng(7)
    for _ in range(10_000):
        own = store(
            capacity_j=10.0 ** rng.uniform(3, 9), charge_power_w=10.0 ** rng.uniform(3, 8),
            discharge_power_w=10.0 ** rng.uniform(3, 8), charge_efficiency=rng.uniform(0.1, 1.0),
            discharge_efficiency=rng.uniform(0.1, 1.0), standby_w=rng.choice([0.0, 1e3, 1e6]),
        )  # fmt: skip
        energy_j = own.capacity_j * rng.choice([0.0, 1.0, rng.uniform()])
        step_s = 10.0 ** rng.uniform(-2, 3)
        state = begun(energy_j, step_s, own)
        share = rng.choice([-1.0, 0.0, 1.0, rng.uniform(-1.0, 1.0)])
        limit_w = state.charge_limit_w if share > 0.0 else state.discharge_limit_w
        power_w = share * limit_w
        after_j = energy_after(power_w, step_s, own, state)
        assert limit_w >= 0.0
        assert 0.0 <= after_j <= own.capacity_j
        balance_j = energy_j + (power_w - lost_power(power_w, step_s, own, state)) * step_s
        assert after_j == pytest.approx(balance_j, abs=1e-12 * own.capacity_j)
