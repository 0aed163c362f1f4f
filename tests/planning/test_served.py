"""What is used and missed in a year: a supply that does not carry a traffic runs less of it."""

import numpy as np
import pytest

import tpss
from tpss.planning.served import NO_TRAFFIC
from tpss.planning.solve import price_of_node
from tpss.planning.uncounted import uncounted

from small_plans import modelled

HOURS = 6000.0
SPARSE, DENSE, NOTHING = 0, 1, 2
TODAY, AT, MID, _ = range(4)
"""Configurations of the small plan, in their order."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("plan")


def row(model, state, configuration):
    case = next(
        case
        for case in model.case_list.cases
        if (case.state, case.configuration, case.outage) == (state, configuration, "")
    )
    return model.table.loc[case.digest]


def test_a_year_costs_its_energy_and_the_minutes_that_trains_lose(folder):
    """3 trains an hour, 6000 h: 0.65 SEK a kWh, 67 SEK a minute, in MSEK."""
    model = modelled(folder)
    outcome = row(model, SPARSE, MID)
    energy = outcome.drawn_from_grid_mw * HOURS * 1e3 * 0.65e-6
    lost = 3.0 * HOURS * outcome["service.eastbound.mean_lost_min"] * 67e-6
    assert model.priced[0].yearly_cost[0, MID] == pytest.approx(energy + lost, rel=1e-12)


def test_what_a_supply_does_not_carry_is_not_run_and_missed(folder):
    """A limit between both: 20 min are carried, 5 min are not; 9 of 12 trains an hour are missed."""
    limit = modelled(folder)
    sparse, dense = (row(limit, state, TODAY).lowest_voltage_kv for state in (SPARSE, DENSE))
    assert dense < sparse
    model = modelled(folder, {"require/lowest_voltage_kv": float(0.5 * (dense + sparse))})
    own = model.priced[0].yearly_cost[:, TODAY]
    assert own[1] == own[0]
    assert own[2] == pytest.approx(own[0] + 9.0 * HOURS * 0.06, rel=1e-12)
    assert model.priced[0].served(np.array([TODAY] * 3)).tolist() == [SPARSE, SPARSE, SPARSE]
    (reason,) = model.served[0].reasons[DENSE, TODAY]
    assert reason.startswith("lowest voltage")
    assert model.served[0].reasons[SPARSE, TODAY] == []


def test_a_supply_that_carries_nothing_misses_all_trains(folder):
    model = modelled(folder, {"require/lowest_voltage_kv": 50.0})
    yearly = model.priced[0].yearly_cost
    assert np.allclose(yearly[0], 3.0 * HOURS * 0.06, rtol=1e-12)
    assert np.allclose(yearly[2], 12.0 * HOURS * 0.06, rtol=1e-12)
    assert model.served[0].traffic[model.priced[0].served(np.array([AT] * 3))[0]] == NO_TRAFFIC


def test_it_must_hold_with_an_outage_too(folder):
    """With half the converters the loading doubles: a limit between both is not kept."""
    alone = modelled(folder)
    loading = row(alone, SPARSE, TODAY).peak_loading
    changes = {"require/also_with": ["one out"], "require/peak_loading": 1.2 * float(loading)}
    with_outage = modelled(folder, changes)
    (reason,) = with_outage.served[0].reasons[SPARSE, TODAY]
    assert reason.startswith("peak loading")
    assert reason.endswith("with one out")


def test_less_is_run_only_of_the_trains_that_are_asked_for(folder):
    """Lighter trains are no part of a traffic of heavy ones."""
    mass = {
        "scenarios/low/trains.freight.mass_t": [400.0, 400.0],
        "scenarios/high/trains.freight.mass_t": [400.0, 1400.0],
    }
    may_serve = modelled(folder, mass).served[0].quantities.may_serve
    assert may_serve.tolist() == [[True, False, True], [False, True, True]]


def test_more_is_never_run_than_is_asked_for(folder):
    may_serve = modelled(folder).served[0].quantities.may_serve
    assert may_serve.tolist() == [[True, False, True], [True, True, True]]


def fed_back(table):
    table["fed_back_to_grid_mw"] = 0.1
    return table


def test_energy_that_is_given_back_needs_a_price(folder):
    with pytest.raises(tpss.ScenarioError, match=r"economics\.fed_back_per_kwh"):
        modelled(folder, tamper=fed_back)


def test_what_rounding_gives_back_needs_none(folder):
    """1e-17 MWh a year, of some thousand drawn: a sum that did not end at 0."""

    def rounded(table):
        table["fed_back_to_grid_mw"] = 2e-21
        return table

    model = modelled(folder, tamper=rounded)
    assert "No energy is given back to the grid." in list(uncounted(model))


def test_energy_that_is_given_back_is_paid_for(folder):
    """0.1 MW for 6000 h at 0.30 SEK a kWh: 0.18 MSEK a year."""
    without = modelled(folder)
    paid = modelled(folder, {"economics/fed_back_per_kwh": 0.30e-6}, fed_back)
    saved = without.priced[0].yearly_cost[0, MID] - paid.priced[0].yearly_cost[0, MID]
    assert saved == pytest.approx(0.18, rel=1e-9)


def test_fixed_costs_are_those_of_what_is_built(folder):
    fixed = {"measures/Mid/fixed_per_year": 2.0, "measures/AT/fixed_per_year": 3.0}
    without, model = modelled(folder), modelled(folder, fixed)
    more = model.priced[0].yearly_cost[0] - without.priced[0].yearly_cost[0]
    assert more.tolist() == pytest.approx([0.0, 3.0, 2.0, 5.0])


def test_prices_may_differ_between_futures_and_stages(folder):
    prices = {
        "scenarios/low/economics.energy_per_kwh": [0.5e-6, 0.4e-6],
        "scenarios/high/economics.energy_per_kwh": [0.5e-6, 0.9e-6],
    }
    model = modelled(folder, prices)
    assert price_of_node(model.plan, model.tree)[:, 0].tolist() == [0.5e-6, 0.4e-6, 0.9e-6]


def test_a_case_whose_audit_failed_is_not_used(folder):
    def failed(table):
        return table.assign(audit_passed=False, problem="network balance 1e-3")

    with pytest.raises(tpss.AuditError, match="network balance"):
        modelled(folder, tamper=failed)
