"""Bounds by an approximator: the lower ends of what it predicts, less a margin.

Some configurations with a traffic are drawn at random and simulated, and an approximator is trained on
them: its inputs are which measures stand, at which levels, and the values of the traffic, its outputs
what is used in an hour.  No case takes less, it is supposed, than the lower end of its 90 % interval,
its energy less a margin.  Trains of which it predicts that they lose less than nothing lose nothing.

What lies outside the region in which it was trained has no bound, and is simulated.  So has all of an
area in which too few cases came through to learn from.
"""

import hashlib
from functools import partial
from typing import Any

import numpy as np
import pandas as pd

from tpss.approximator.approximator import Approximator
from tpss.approximator.forms import Form
from tpss.approximator.train import Origin, train_on
from tpss.planning.cases import AreaCases
from tpss.planning.learnt import Learnt
from tpss.planning.money import Array
from tpss.planning.plan import Evaluation
from tpss.planning.strongest import anchors, energies_of
from tpss.planning.yearly_use import ENERGY, FED_BACK, LATE, LOST, Simulated
from tpss.sweep.versions import versions

FEWEST = 25
"""Least number of configurations with a traffic that came through, to learn from."""


def units_to_train(area: AreaCases, evaluation: Evaluation) -> set[tuple[int, int]]:
    """States and configurations that are simulated first: drawn at random, and the ends.

    The ends are the strongest supplies and today's, with each traffic.  Where there are no more than
    are to be drawn, all of them.
    """
    states, configurations = len(area.states.states), len(area.configurations)
    count = states * configurations
    if count <= evaluation.training_cases:
        drawn = np.arange(count)
    else:
        # Apart from the draw of the audit, which has the same seed.
        rng = np.random.default_rng([evaluation.audit_seed, 1])
        drawn = rng.permutation(count)[: evaluation.training_cases]
    ends = {(d, c) for d in range(states) for c in anchors(area).tolist()}
    return ends | {divmod(int(unit), configurations) for unit in drawn}


def bounds_by_approximator(simulated: Simulated, learnt: Learnt) -> Array:
    """Least use of each traffic by each configuration, NaN where the approximator does not know.

    Shape (states, configurations, components).

    Raises
    ------
    ApproximatorError
        A package is missing, or the file of the approximator is damaged.
    """
    area, evaluation = _area(simulated), simulated.case_list.plan.file.evaluate
    shape = (len(area.states.states), len(area.configurations), len(simulated.components))
    wanted = units_to_train(area, evaluation)
    trained = sorted(wanted & set(simulated.through))
    are_all = len(wanted) == shape[0] * shape[1]
    if are_all or not wanted <= set(simulated.rows) or len(trained) < FEWEST:
        return np.full(shape, np.nan)
    use = np.array([simulated.use(d, c) for d, c in trained]) / simulated.hours
    inputs = _inputs(area)
    digest = _digest(trained, use, inputs, simulated)
    predict = partial(_per_hour, simulated, trained, use, inputs, digest, learnt)
    per_hour = learnt.bounds(digest, predict).reshape(shape)
    return _less_margin(per_hour * simulated.hours, simulated)


def _area(simulated: Simulated) -> AreaCases:
    return simulated.case_list.areas[simulated.number]


def _inputs(area: AreaCases) -> pd.DataFrame:
    """Inputs of all states and configurations, a row each: levels of measures, and values of traffic.

    Values that are no numbers are told apart by the order in which they come.
    """
    states, configurations = area.states.states, area.configurations
    levels = np.array([each.levels for each in configurations], dtype=float)
    columns: dict[str, Any] = {
        f"measures.{name}": np.tile(levels[:, k], len(states))
        for k, name in enumerate(area.area.measures)
    }
    for path in dict.fromkeys(path for state in states for path in state.values):
        values = [state.values.get(path) for state in states]
        if not all(isinstance(v, int | float) and not isinstance(v, bool) for v in values):
            known = list(dict.fromkeys(str(value) for value in values))
            values = [f"value {known.index(str(value)) + 1}" for value in values]
        columns[path] = np.repeat(np.array(values), len(configurations))
    return pd.DataFrame(columns)


def _digest(
    trained: list[tuple[int, int]], use: Array, inputs: pd.DataFrame, simulated: Simulated
) -> str:
    """Digest of all on which the approximator and its bounds depend."""
    parts = [str(trained).encode(), use.tobytes(), inputs.to_csv().encode()]
    parts += [str(simulated.components).encode(), str(sorted(versions().items())).encode()]
    return hashlib.sha256(b"\0".join(parts)).hexdigest()[:20]


def _per_hour(
    simulated: Simulated,
    trained: list[tuple[int, int]],
    use: Array,
    inputs: pd.DataFrame,
    digest: str,
    learnt: Learnt,
) -> Array:
    """Least use in an hour, shape (states * configurations, components); NaN where it is not known.

    What was the same in all that was trained on stays so.
    """
    varying = [
        k
        for k, name in enumerate(simulated.components)
        if name.startswith((ENERGY, FED_BACK, LOST, LATE)) and np.ptp(use[:, k]) > 0.0
    ]
    names = [simulated.components[k] for k in varying]
    rows = [d * len(_area(simulated).configurations) + c for d, c in trained]
    table = inputs.iloc[rows].assign(**dict(zip(names, use[:, varying].T, strict=True)))
    found = learnt.approximator(digest, partial(_trained, simulated, table, names, digest))
    known = [str(name) for name in inputs if found.file.inputs.has(str(name))]
    told = found.predict(inputs[known], outside="flag")
    bound = np.tile(use[0], (len(inputs), 1))
    for k, name in zip(varying, names, strict=True):
        end = "high" if name == FED_BACK else "low"
        bound[:, k] = np.maximum(told[f"{name}.{end}"], 0.0)
    bound[told["outside"] != ""] = np.nan
    return bound


def _trained(
    simulated: Simulated, table: pd.DataFrame, outputs: list[str], digest: str
) -> Approximator:
    """An approximator of what is used in an hour."""
    plan, known = simulated.case_list.plan, versions()
    origin = Origin(plan.file.name, digest, known["tpss_version"], known["kernel_hash"], "")
    inputs = [str(name) for name in table if name not in outputs]
    choices = tuple(name for name in inputs if not pd.api.types.is_numeric_dtype(table[name]))
    numbers = tuple(name for name in inputs if name not in choices)
    form = Form(numbers, choices, tuple(outputs), of_each_station=())
    step_min = _area(simulated).area.today.simulation.time_step_min
    step_min = plan.file.evaluate.time_step_min or step_min or 0.0
    rows = table.reset_index(drop=True).assign(
        case=range(len(table)), status="finished", audit_passed=True, time_step_min=step_min
    )
    return train_on(rows, form, origin)


def _less_margin(use: Array, simulated: Simulated) -> Array:
    """Ends with less energy drawn, and more given back."""
    margin = simulated.case_list.plan.file.evaluate.bound_margin_percent / 100.0
    energies, bound = energies_of(simulated.components), use.copy()
    bound[:, :, energies.drawn] *= 1.0 - margin
    if energies.given_back is not None:
        bound[:, :, energies.given_back] *= 1.0 + margin
    return bound
