"""What a study varies, as inputs of an approximator, and which of it other inputs describe."""

from typing import Any

import numpy as np
import pandas as pd

from tpss.approximator.forms import AGGREGATED, FORMS, VARIED, Form
from tpss.sweep.columns import MADE_BY, OUTPUTS
from tpss.sweep.inputs import Inputs as CaseInputs

SET = "set."
"""Beginning of the columns of a study's parameters."""

PROFILE = "gradients.profile"
"""Which gradients are drawn of the same mean and standard deviation: a number without meaning."""

DRAWN, STARTING = f"{SET}gradients.mean_permille", "starting_gradient_permille"
"""Column of a study that draws gradients, and an input that says something of their order."""

SAME = 1e-9
"""Relative difference up to which two numbers count as equal."""


def parameters_of(table: pd.DataFrame) -> dict[str, str]:
    """Columns of a study's parameters by the names of the inputs that they are."""
    names = [str(name) for name in table if str(name).startswith(SET)]
    return {input_name(name.removeprefix(SET)): name for name in names}


def input_name(parameter: str) -> str:
    """Name of the input that a parameter of a study is: its own, or that of its column if another
    column has that.
    """
    others = {*CaseInputs._fields, *OUTPUTS, *MADE_BY}
    return f"{SET}{parameter}" if parameter in others else parameter


def with_parameters(table: pd.DataFrame) -> pd.DataFrame:
    """The table with the study's parameters as inputs."""
    more = {name: table[column] for name, column in parameters_of(table).items() if name != column}
    return pd.concat([table, pd.DataFrame(more, index=table.index)], axis=1) if more else table


def form_named(name: str, table: pd.DataFrame) -> Form:
    """A form, that of what varies made for a table of a study."""
    form = FORMS[name]
    if name != VARIED:
        return form
    names = [each for each in parameters_of(table) if not each.endswith(PROFILE)]
    numbers = tuple(each for each in names if _is_number(table[each]))
    return Form(
        numbers=numbers,
        choices=tuple(each for each in names if each not in numbers),
        outputs=form.outputs,
        of_each_station=form.of_each_station,
        where_told=form.where_told,
    )


def fitting_form(table: pd.DataFrame) -> str:
    """The aggregated form if it describes all that a study varies, else that of what varies."""
    left_out = [
        name for name in left_out_of(table, FORMS[AGGREGATED]) if not name.endswith(PROFILE)
    ]
    return VARIED if left_out else AGGREGATED


def left_out_of(table: pd.DataFrame, form: Form) -> list[str]:
    """Parameters that vary in a study's table, and that the inputs of a form do not describe.

    A number is described by an input that grows or falls with it, all else by inputs that together have
    one value for each of its values, and different ones.
    """
    inputs = [name for name in (*form.numbers, *form.choices) if name in table]
    left_out = []
    for name in parameters_of(table):
        values = table[name]
        if name in inputs or values.nunique() < 2:
            continue
        numbers = [each for each in inputs if each in form.numbers]
        if _is_number(values) and any(_follows(table[each], values) for each in numbers):
            continue
        if not _is_number(values) and _tell_apart(table[inputs], values):
            continue
        left_out.append(name)
    if DRAWN in table and PROFILE not in left_out and STARTING not in form.numbers:
        left_out.append(PROFILE)  # each case has its own
    return left_out


def _is_number(values: pd.Series) -> bool:
    return pd.api.types.is_numeric_dtype(values) and not pd.api.types.is_bool_dtype(values)


def _follows(column: pd.Series, parameter: pd.Series) -> bool:
    """Whether an input is a monotone function of a parameter; it may stay at its ends."""
    pairs = pd.DataFrame({"p": parameter, "x": column}).dropna()
    if len(pairs) < len(parameter):
        return False
    by_value = pairs.groupby("p")["x"].agg(["min", "max"])
    size = max(float(pairs["x"].abs().max()), 1e-300)
    if float((by_value["max"] - by_value["min"]).max()) > SAME * size:
        return False
    steps = np.diff(by_value["min"].to_numpy(dtype=float))
    level = np.abs(steps) <= SAME * size
    moving = steps[~level]
    if not len(moving) or not (np.all(moving > 0.0) or np.all(moving < 0.0)):
        return False
    first, last = np.flatnonzero(~level)[[0, -1]]
    return not level[first:last].any()


def _tell_apart(inputs: pd.DataFrame, parameter: pd.Series) -> bool:
    """Whether inputs that are the same wherever a parameter is tell all of its values apart."""
    groups = inputs.groupby(parameter.to_numpy())
    names = [str(name) for name in inputs]
    constant = [name for name in names if (groups[name].nunique(dropna=False) == 1).all()]
    if not constant:
        return False
    told: list[Any] = [tuple(row) for row in groups[constant].first().astype(str).to_numpy()]
    return len(set(told)) == len(told)
