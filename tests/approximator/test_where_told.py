"""What converters lose and what trains feed back are outputs where a study tells them."""

import numpy as np
import pandas as pd
import pytest

import tpss
from tpss.approximator.approximator import Approximator
from tpss.approximator.compare import compare
from tpss.approximator.forms import FED_BACK, LOST
from tpss.approximator.from_scenario import demand_same_kind
from tpss.approximator.train import train_approximator

from made_up_studies import made_up_table, write_study
from scenarios import short_line

BRAKES = {"trains.freight.regeneration": {"max_force_kn": 100.0, "max_power_kw": 2000.0}}

LOSING = {"supply.converter_stations.*.type": "Q48/Q49 with losses (estimate)"}


def telling(rows: int = 600) -> pd.DataFrame:
    """Made-up lines on which a converter loses 0.2 MWh and 4 % of what it feeds.

    Trains feed back 1 % of what they draw, and 3 % more for each per mille of the gradients' deviation:
    half of it reaches the grid.
    """
    table = made_up_table(rows)
    energy = table.total_energy_mwh
    lost = 0.2 * table.converters + 0.04 * energy
    back = energy * (0.01 + 0.03 * table.gradient_std_permille)
    columns = dict(zip((*LOST, *FED_BACK), (lost, energy + lost, back, 0.5 * back), strict=True))
    carried = table.status == "finished"
    return table.assign(**{name: each.where(carried) for name, each in columns.items()})


@pytest.fixture(scope="module")
def told(tmp_path_factory) -> Approximator:
    return train_approximator(write_study(tmp_path_factory.mktemp("told") / "study", telling()))


def outputs(model: Approximator) -> set[str]:
    return {output.name for output in model.file.outputs}


def test_they_are_learned_as_energy_is(told):
    """In cases held out, nine of ten are within 5 %; what is drawn is what is fed, and lost."""
    assert {*LOST, *FED_BACK} <= outputs(told)
    errors = {score.name: score for score in told.file.scores}
    for name in (*LOST, *FED_BACK):
        assert errors[name].unit == "%"
        assert errors[name].ninetieth < 5.0
    line = telling().query("status == 'finished'").iloc[[0]]
    names = [name for name in line if told.file.inputs.has(name)]
    (found,) = told.predict(line[names], outside="flag").to_dict("records")
    fed, lost = found["total_energy_mwh"], found["converter_losses_mwh"]
    assert found["drawn_from_grid_mwh"] == pytest.approx(fed + lost, rel=0.03)


def test_a_study_that_does_not_tell_them_has_the_outputs_of_before(model):
    assert outputs(model) == {
        "mean_speed_kmh", "trip_time_min", "total_energy_mwh", "losses_mwh", "lowest_voltage_kv",
        "peak_loading", "station.West.energy_mwh", "station.East.energy_mwh",
    }  # fmt: skip
    assert model.file.untold == ()


def test_columns_without_a_value_change_nothing(model, tmp_path):
    """A table of today has them, empty: the networks are those of a table without them, to the bit."""
    empty = dict.fromkeys((*LOST, *FED_BACK), np.nan)
    place = write_study(tmp_path / "study", made_up_table(600).assign(**empty))
    assert train_approximator(place).file.figures == model.file.figures


def test_what_some_cases_lack_or_all_have_alike_is_not_predicted(tmp_path):
    """Converters of a third say nothing, and nothing reaches the grid."""
    table = telling(300)
    table.loc[table.index[::3], list(LOST)] = np.nan
    table[FED_BACK[1]] = 0.0
    found = train_approximator(write_study(tmp_path / "study", table))
    assert found.file.untold == (*LOST, FED_BACK[1])
    assert FED_BACK[0] in outputs(found)


def test_a_study_that_lacks_them_is_not_compared(told, tmp_path):
    table = made_up_table(200).assign(**dict.fromkeys((*LOST, *FED_BACK), np.nan))
    with pytest.raises(tpss.ApproximatorError, match="no column converter_losses_mwh"):
        compare(told, write_study(tmp_path / "study", table))


def test_scenarios_of_another_kind_are_refused(told, model):
    """An approximator knows electric brakes and losses only from its study; no input tells them."""
    plain = short_line({"simulation": {"time_step_min": 0.1}})
    losing = plain.with_(LOSING)
    demand_same_kind(model.file, plain)
    demand_same_kind(model.file, losing)
    demand_same_kind(told.file, losing.with_(BRAKES))
    with pytest.raises(tpss.ScenarioError, match=r"freight\.regeneration\n +the study had no"):
        demand_same_kind(model.file, plain.with_(BRAKES))
    with pytest.raises(tpss.ScenarioError, match="no train has electric brakes"):
        demand_same_kind(told.file, losing)
    with pytest.raises(tpss.ScenarioError, match="do not say what they lose"):
        demand_same_kind(told.file, plain.with_(BRAKES))
