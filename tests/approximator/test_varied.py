"""Inputs are what a study varies where aggregates do not describe that; what is left out is told."""

import numpy as np
import pandas as pd
import pytest

import tpss
from sweep.studies import study as small_study
from tpss.approximator.approximator import Approximator
from tpss.approximator.forms import AGGREGATED, FORMS, VARIED
from tpss.approximator.from_scenario import inputs_from_scenario
from tpss.approximator.model_file import ModelFile
from tpss.approximator.parameters import fitting_form, form_named, left_out_of, with_parameters
from tpss.approximator.train import train_approximator
from tpss.sweep.derive import scenario_of
from tpss.sweep.design import design_of

from made_up_studies import made_up_table, write_study

SECOND = "set.traffic.1.headway_min"


def table_of_two_services(rows: int = 300) -> pd.DataFrame:
    """Made-up lines on which a second service doubles the energy at its shortest headway."""
    table = made_up_table(rows)
    drawn = np.random.default_rng(5)
    second_min = drawn.uniform(5.0, 20.0, rows)
    table["total_energy_mwh"] *= 1.0 + 5.0 / second_min
    return table.assign(
        **{
            "set.line.length_km": table["length_km"],
            "set.line.speed_limits.*.speed_kmh": table["speed_limit_kmh"],
            "set.gradients.mean_permille": table["gradient_mean_permille"],
            "set.gradients.standard_deviation_permille": table["gradient_std_permille"],
            "set.traffic.0.headway_min": table["headway_min"],
            "set.supply.converter_stations.*.converters": table["converters_per_station"],
            SECOND: second_min,
            "set.supply": table["catenary"] + ", " + table["transformers"].astype(str),
        }
    )


def test_aggregates_describe_what_follows_them():
    """The choice is one catenary with so many transformers; the order of the gradients is not told."""
    table = with_parameters(table_of_two_services())
    assert left_out_of(table, FORMS[AGGREGATED]) == ["traffic.1.headway_min", "gradients.profile"]
    assert left_out_of(table, FORMS["profile"]) == ["traffic.1.headway_min"]


def test_a_limit_that_trains_do_not_reach_is_described_by_the_speed_that_they_do():
    table = made_up_table(300)
    table["set.line.speed_limits.0.speed_kmh"] = table["speed_limit_kmh"]
    table["speed_limit_kmh"] = table["speed_limit_kmh"].clip(
        upper=table["speed_limit_kmh"].median()
    )
    assert left_out_of(with_parameters(table), FORMS[AGGREGATED]) == []


def test_inputs_are_what_varies_where_aggregates_leave_something_out():
    table = with_parameters(table_of_two_services())
    assert fitting_form(table) == VARIED
    assert fitting_form(table.drop(columns=[SECOND, "traffic.1.headway_min"])) == AGGREGATED
    form = form_named(VARIED, table)
    assert set(form.numbers) == {
        "line.length_km",
        "line.speed_limits.*.speed_kmh",
        "gradients.mean_permille",
        "gradients.standard_deviation_permille",
        "traffic.0.headway_min",
        "traffic.1.headway_min",
        "supply.converter_stations.*.converters",
    }
    assert form.choices == ("supply",)


def test_numbers_of_profiles_are_left_out_and_told():
    """They tell profiles apart, and mean nothing."""
    table = table_of_two_services()
    table["set.gradients.profile"] = np.arange(len(table)) % 7
    known = with_parameters(table)
    assert left_out_of(known, form_named(VARIED, known)) == ["gradients.profile"]


def test_an_input_with_the_name_of_another_column_keeps_that_of_its_own():
    table = made_up_table(300)
    table["set.catenary"] = table["catenary"]
    assert "set.catenary" in form_named(VARIED, with_parameters(table)).choices


def test_the_second_service_is_learned_and_asked_for(tmp_path):
    """Energy follows a law of both headways, as of one service times 1 + 5 / headway of the other."""
    folder = write_study(tmp_path / "study", table_of_two_services(600))
    model = train_approximator(folder)
    assert model.file.form == VARIED
    assert model.file.left_out == ("gradients.profile",)
    errors = {score.name: score.ninetieth for score in model.file.scores}
    poor = train_approximator(folder, form=AGGREGATED)
    assert poor.file.left_out == ("traffic.1.headway_min", "gradients.profile")
    poor_errors = {score.name: score.ninetieth for score in poor.file.scores}
    assert errors["total_energy_mwh"] < 0.5 * poor_errors["total_energy_mwh"]
    with pytest.raises(
        tpss.ScenarioError, match=r"traffic\.1\.headway_min\n +this input is missing"
    ):
        model.predict({"traffic.0.headway_min": [10.0]})


def test_a_figure_that_some_cases_lack_is_not_predicted(tmp_path):
    table = table_of_two_services(300)
    table.loc[table.index[::3], "trip_time_min"] = np.nan
    model = train_approximator(write_study(tmp_path / "study", table), form=VARIED)
    assert "trip_time_min" in model.file.untold
    assert "trip_time_min" not in [output.name for output in model.file.outputs]


def test_files_of_the_version_before_are_read(model: Approximator, tmp_path):
    document = model.file.model_dump(mode="json") | {"version": 2}
    del document["left_out"], document["untold"], document["data"]["definition"]
    before = ModelFile.model_validate(document)
    assert before.left_out == ()
    place = Approximator(before).save(tmp_path / "before.json")
    assert tpss.load_approximator(place).file.version == 2


@pytest.fixture
def of_small_study(model: Approximator, tmp_path) -> ModelFile:
    """An approximator that was trained on the small study, as far as its inputs go."""
    changes = {
        "choices": {"supply": {"BT": {"supply.catenary": "BT"}, "AT": {"supply.catenary": "AT"}}}
    }
    text = small_study(tmp_path, changes).as_json()
    data = model.file.data.model_copy(update={"definition": text})
    return model.file.model_copy(update={"form": VARIED, "data": data})


def case_of(file: ModelFile, case: int) -> tpss.Scenario:
    from tpss.sweep.study import study_of_json

    return scenario_of(design_of(study_of_json(file.data.definition)), case)


def test_inputs_of_a_scenario_are_read_where_the_study_sets_them(of_small_study):
    scenario = case_of(of_small_study, 3).with_({"traffic.0.headway_min": 7.5})
    assert inputs_from_scenario(of_small_study, scenario) == {
        "traffic.0.headway_min": 7.5,
        "supply.converter_stations.*.converters": 2,
        "supply": "AT",
    }


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"trains.freight.mass_t": 1000.0}, "= 1000.0\n    the study had 1470.0 only"),
        ({"supply.converter_stations.0.converters": 3}, "it is 1 to 3 here"),
        ({"supply.catenary.r_ohm_per_km": 0.1}, "supply\n    it is none of what was trained"),
    ],
)  # fmt: skip
def test_what_an_approximator_cannot_know_is_refused(of_small_study, changes, words):
    base = case_of(of_small_study, 0)
    if "supply.catenary.r_ohm_per_km" in changes:
        own = {**base.as_document()["supply"]["catenary"], "r_ohm_per_km": 0.1}
        changes = {"supply.catenary": own}
    with pytest.raises(tpss.ScenarioError) as caught:
        inputs_from_scenario(of_small_study, base.with_(changes))
    assert words in str(caught.value)
