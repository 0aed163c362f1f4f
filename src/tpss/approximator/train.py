"""Training of an approximator on the table of a study."""

from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pandas as pd

from tpss.approximator import fit as fitting
from tpss.approximator.approximator import Approximator
from tpss.approximator.calibrate import deviation, factor_of, log_sizes, usual_spread
from tpss.approximator.domain import domain_of
from tpss.approximator.forms import VARIED, Form, with_traffic
from tpss.approximator.inputs import inputs_of_table
from tpss.approximator.model_file import VERSION, Data, ModelFile, Output, Weights
from tpss.approximator.network import Array, Ensemble
from tpss.approximator.parameters import (
    fitting_form,
    form_named,
    left_out_of,
    with_parameters,
)
from tpss.approximator.scales import output_of, scaled
from tpss.approximator.scores import Cases, Simple, score_collapse, score_figures
from tpss.errors import ApproximatorError
from tpss.extras import demand

HELD_OUT = 0.2
"""Share of the cases that are not trained on, but used to score the predictions."""

FEWEST = 100
"""Least number of cases with lines that carry their load."""

FEWEST_COLLAPSES = 10
"""Least number of cases with lines that do not, if there are any."""


def train_approximator(
    folder: str | Path,
    *,
    form: str | None = None,
    seed: int = 0,
    report: Callable[[int, int], None] | None = None,
) -> Approximator:
    """Train an approximator on the table of a study.

    Parameters
    ----------
    folder : str or Path
        Folder that `tpss.run_study` has written; the study need not be finished.
    form : str, optional
        ``aggregated``; ``varied``: inputs are what the study varies, by its key paths; ``profile``:
        with more statistics of the gradients than mean and standard deviation; or ``original``: the
        highest mean speed of a train added to a line.  By default ``aggregated`` if that describes all
        that the study varies, else ``varied``.
    seed : int
        Seed of the random numbers.
    report : callable, optional
        Called with the number of networks that are fitted so far, and their total number.

    Returns
    -------
    Approximator
        Trained on four fifths of the cases; its scores are those of the last one.

    Raises
    ------
    StudyError
        The folder is not that of a study, or of another version.
    ApproximatorError
        The table has too few cases, or nothing varies in it.
    """
    table, origin = read_table(Path(folder))
    used = usable(table)
    _demand_enough(used, len(table))
    chosen = form or fitting_form(used)
    own = form_named(chosen, used)
    return _train(table, used, origin, (chosen, own), seed, report or (lambda *_: None))


def train_on(table: pd.DataFrame, form: Form, origin: "Origin", seed: int = 0) -> Approximator:
    """Train an approximator on a table of any origin, with a form made for it.

    Parameters
    ----------
    table : DataFrame
        Columns of the form, and ``case``, ``status``, ``audit_passed`` and ``time_step_min``.
    form : Form
        Each of its outputs differs between some cases.
    origin : Origin
    seed : int
        Seed of the random numbers.

    Raises
    ------
    ApproximatorError
        An input lacks values, or none varies.
    """
    return _train(table, usable(table), origin, (VARIED, form), seed, lambda *_: None)


@dataclass(frozen=True)
class Origin:
    """Where a table comes from."""

    study: str
    study_hash: str
    tpss_version: str
    kernel_hash: str
    definition: str
    """The study as text, from which its cases can be made; empty if that is not known."""


def read_table(folder: Path) -> tuple[pd.DataFrame, Origin]:
    """The cases of a study that were simulated and passed their audit, and where they come from.

    Raises
    ------
    StudyError, ApproximatorError
    """
    demand("training")
    from tpss.sweep.folder import load_table, read_manifest

    table = load_table(folder)
    manifest = read_manifest(folder)
    if table["time_step_min"].nunique() > 1:
        steps = ", ".join(f"{step:g}" for step in sorted(table["time_step_min"].unique()))
        raise ApproximatorError(
            f"{folder} mixes time steps ({steps} min), which give different results for the same line; "
            "run the study with one of them"
        )
    origin = Origin(
        study=str(manifest.get("name") or folder.absolute().name),
        **{
            name: str(manifest.get(name) or "unknown")
            for name in ("study_hash", "tpss_version", "kernel_hash")
        },
        definition=str(manifest.get("study") or ""),
    )
    return with_parameters(with_traffic(table)), origin


def usable(table: pd.DataFrame) -> pd.DataFrame:
    """Cases with a result that passed its audit."""
    ran = table["status"].isin(("finished", "collapsed", "stalled"))
    return table[ran & (table["audit_passed"] == True)]  # noqa: E712, it may be null


def _train(
    table: pd.DataFrame,
    used: pd.DataFrame,
    origin: Origin,
    named: tuple[str, Form],
    seed: int,
    report: Callable[[int, int], None],
) -> Approximator:
    form, own = named
    inputs = inputs_of_table(used, own)
    names, untold = (
        _outputs(own, used)
        if form == VARIED
        else (own.outputs_of([str(name) for name in used]), [])
    )
    more, lacking = _where_told(own, used)
    names, untold = [*names, *more], [*untold, *lacking]
    given = inputs.read({each.name: used[each.name] for each in inputs.varying}, "the table")
    cases = cases_of(used, inputs.encode(given.inputs), names)
    held_out = _held_out(len(used), seed)
    kept = np.setdiff1d(np.arange(len(used)), held_out)
    trained, tested = cases.of(kept), cases.of(held_out)
    carried = trained.of(np.flatnonzero(trained.carried))
    outputs = [output_of(name, carried.y[name]) for name in names]
    y = np.column_stack([scaled(carried.y[output.name], output) for output in outputs])
    classes = (~trained.carried[:, None]).astype(np.float64)
    tasks = {"figures": (carried.x, y), "noise": (carried.x, y)}
    if not trained.carried.all():
        tasks["collapse"] = (trained.x, classes)
    tick = _counter(
        sum(fitting.number_of_fits(kind, *task) for kind, task in tasks.items()), report
    )
    figures = fitting.fit("figures", carried.x, y, seed, tick)
    errors = figures.unseen - y
    noise = fitting.fit("noise", carried.x, log_sizes(errors), seed, tick)
    fitted = {"figures": figures, "noise": noise}
    if "collapse" in tasks:
        fitted["collapse"] = fitting.fit("collapse", trained.x, classes, seed, tick)
    file = ModelFile(
        format="tpss-approximator",
        version=VERSION,
        made_by={"tpss": version("tpss"), "scikit-learn": version("scikit-learn")},
        form=form,
        data=_data(table, used, held_out, seed, origin),
        inputs=inputs,
        domain=domain_of({name: each[kept] for name, each in given.inputs.items()}, inputs),
        outputs=tuple(
            _calibrated(output, errors[:, k], noise.unseen[:, k], figures.spread[:, k])
            for k, output in enumerate(outputs)
        ),
        left_out=tuple(left_out_of(used, own)),
        untold=tuple(untold),
        tried={
            kind: {str(neurons): error for neurons, error in each.errors.items()}
            for kind, each in fitted.items()
        },
        figures=_weights(figures.ensemble),
        noise=_weights(noise.ensemble),
        collapse=_weights(fitted["collapse"].ensemble) if "collapse" in fitted else None,
        scores=(),
        collapse_score=None,
    )
    return _scored(file, trained, tested)


def _outputs(form: Form, used: pd.DataFrame) -> tuple[list[str], list[str]]:
    """Outputs that there are in every case that finished, and that differ; and the others.

    Raises
    ------
    ApproximatorError
        There are none.
    """
    finished = used[used["status"] == "finished"]
    names = form.outputs_of([str(name) for name in used])
    told = [n for n in names if finished[n].notna().all() and finished[n].nunique() > 1]
    if not told:
        raise ApproximatorError(
            f"none of {', '.join(names)} is there in every case and differs; vary more in the study, or "
            "simulate longer"
        )
    return told, [name for name in names if name not in told]


def _where_told(form: Form, used: pd.DataFrame) -> tuple[list[str], list[str]]:
    """Of the outputs that not every study has: those that can be learned, and those that cannot.

    One of which no case has a value is none of either: the study does not tell it.
    """
    finished = used[used["status"] == "finished"]
    there = [name for name in form.where_told if name in used and finished[name].notna().any()]
    told = [n for n in there if finished[n].notna().all() and finished[n].nunique() > 1]
    return told, [name for name in there if name not in told]


def _calibrated(output: Output, errors: Array, log_noise: Array, spread: Array) -> Output:
    usual = usual_spread(log_noise, spread)
    factor = factor_of(errors, deviation(log_noise, spread, usual))
    return output.model_copy(update={"usual": usual, "factor": factor})


def _scored(file: ModelFile, trained: Cases, tested: Cases) -> Approximator:
    """The approximator with its scores in cases that it was not trained on."""
    unscored = Approximator(file)
    simple = Simple(unscored, trained)
    scores = {
        "scores": score_figures(unscored, tested, simple),
        "collapse_score": score_collapse(unscored, tested, simple),
    }
    return Approximator(file.model_copy(update=scores))


def _demand_enough(used: pd.DataFrame, cases: int) -> None:
    finished = int((used["status"] == "finished").sum())
    if finished < FEWEST:
        raise ApproximatorError(
            f"{finished} of {cases} cases finished and passed their audit: too few to learn from; an "
            f"approximator needs at least {FEWEST}, and thousands to be good"
        )
    lost = len(used) - finished
    if 0 < lost < FEWEST_COLLAPSES:
        raise ApproximatorError(
            f"{lost} case(s) collapsed or stalled: too few to learn where that begins; vary further, "
            f"until {FEWEST_COLLAPSES} do, or less far, until none does"
        )


def _held_out(rows: int, seed: int) -> fitting.Indices:
    order = np.random.default_rng(seed).permutation(rows)
    return np.sort(order[: round(HELD_OUT * rows)])


def cases_of(table: pd.DataFrame, x: Array, names: list[str]) -> Cases:
    """Cases of a table with their outputs."""
    carried = (table["status"] == "finished").to_numpy()
    y = {name: table[name].to_numpy(dtype=float) for name in names}
    return Cases(x, {k: np.where(carried, v, np.nan) for k, v in y.items()}, carried)


def _weights(ensemble: Ensemble) -> Weights:
    return Weights.model_validate({name: part.tolist() for name, part in vars(ensemble).items()})


def _counter(whole: int, report: Callable[[int, int], None]) -> Callable[[], None]:
    """Counts networks as they are fitted."""
    done = 0
    report(0, whole)

    def tick() -> None:
        nonlocal done
        done += 1
        report(done, whole)

    return tick


def _data(
    table: pd.DataFrame, used: pd.DataFrame, held_out: fitting.Indices, seed: int, origin: Origin
) -> Data:
    return Data(
        **vars(origin),
        cases=len(table),
        used=len(used),
        carried=int((used["status"] == "finished").sum()),
        held_out=tuple(used["case"].to_numpy()[held_out].tolist()),
        time_step_min=float(used["time_step_min"].iloc[0]),
        seed=seed,
    )
