"""The commands ``tpss approximate train``, ``predict`` and ``check``."""

import sys
import tempfile
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import pandas as pd
from rich.markup import escape
from rich.table import Table

from tpss import units
from tpss.cli.run import BAD_INPUT, DONE, INTERRUPTED
from tpss.cli.terminal import Console, print_in_parts, progress_bar, say, tell
from tpss.errors import ApproximatorError, Finding, ScenarioError
from tpss.extras import demand
from tpss.files.read import MEGABYTE, demand_readable
from tpss.files.refusals import reason

if TYPE_CHECKING:
    from tpss.approximator.approximator import Approximator
    from tpss.approximator.model_file import CollapseScore, Score

LINES_SHOWN = 20
"""Rows of a table whose figures are printed."""


def train_model(
    folder: Path, out: Path, form: str | None, seed: int, force: bool, quiet: bool
) -> int:
    """Train an approximator and write its file; return the exit code."""
    demand("training")
    from tpss.approximator.model_file import check_target
    from tpss.approximator.train import train_approximator

    check_target(out, force)
    console = Console(stderr=True, quiet=quiet)
    try:
        networks = "{task.completed}/{task.total} networks"
        with progress_bar("Training", networks, _progress, console) as report:
            model = train_approximator(folder, form=form, seed=seed, report=report)
    except KeyboardInterrupt:
        print("Interrupted; nothing was written.", file=sys.stderr)
        return INTERRUPTED
    written, fault = _save(model, out, force)
    if not quiet:
        _print_model(model, Console())
        if not fault:
            tell(f"Wrote {written}")
    if fault:
        print(fault, file=sys.stderr)
        return BAD_INPUT
    return DONE


def _save(model: "Approximator", out: Path, force: bool) -> tuple[Path | None, str]:
    """Write the file; if that fails, into a temporary one, so that the training is not lost."""
    try:
        return model.save(out, force=force), ""
    except ApproximatorError as error:
        fault = str(error)
    spare = Path(tempfile.mkdtemp(prefix="tpss-approximator-")) / out.name
    try:
        return model.save(spare), f"{fault}\nIt was saved as {spare} instead."
    except ApproximatorError as error:
        spare.parent.rmdir()
        return None, f"{fault}\n{error}\nOnly what is printed here is kept of the training."


def _progress(done: int, whole: int) -> dict[str, Any]:
    return {"completed": done, "total": whole}


def predict_lines(
    file: Path,
    assignments: list[str],
    table: Path | None,
    scenario: Path | None,
    flag: bool,
    out: Path | None,
    force: bool,
) -> int:
    """Predict, print, and write what is requested; return the exit code."""
    from tpss.approximator.approximator import load_approximator
    from tpss.approximator.model_file import check_target

    for place in (table, out):
        if place is not None:
            _demand_table_file(place)
    model = load_approximator(file)
    if out is not None:
        check_target(out, force)
    lines, origin = _lines(model, assignments, table, scenario)
    predictions = model.predict(lines, "flag" if flag else "refuse", origin)
    if out is not None:
        _write(pd.concat([lines.reset_index(drop=True), predictions], axis=1), out)
        tell(f"Wrote {out}")
    elif len(predictions) == 1:
        _print_prediction(model, predictions.iloc[0])
    else:
        _print_predictions(model, predictions)
    for row, words in enumerate(predictions["outside"].tolist()):
        if words and row < LINES_SHOWN:
            which = f"row {row + 1} " if len(predictions) > 1 else ""
            print(f"{which}outside the trained region: {words}", file=sys.stderr)
    return DONE


def _lines(
    model: "Approximator", assignments: list[str], table: Path | None, scenario: Path | None
) -> tuple[pd.DataFrame, str]:
    """Lines to predict, a row each, and where they come from."""
    if table is not None:
        return _read_table(table), str(table)
    values: dict[str, Any] = {}
    if scenario is not None:
        values |= _inputs_of_scenario(model, scenario)
    values |= dict(_assignment(text) for text in assignments)
    return pd.DataFrame({name: [value] for name, value in values.items()}), str(scenario or "--set")


def _assignment(text: str) -> tuple[str, Any]:
    """Input and value of ``input=value``."""
    name, equals, raw = text.partition("=")
    if not equals or not name.strip() or not raw.strip():
        remedy = "write --set headway_min=8"
        raise ScenarioError([Finding("--set", text, "", "not of the form INPUT=VALUE", remedy)])
    value = raw.strip()
    try:
        return name.strip(), float(value)
    except ValueError:
        return name.strip(), value


def _inputs_of_scenario(model: "Approximator", file: Path) -> dict[str, Any]:
    from tpss.approximator.forms import VARIED, with_traffic
    from tpss.approximator.from_scenario import demand_same_kind, inputs_from_scenario
    from tpss.scenario import load_scenario
    from tpss.sweep.inputs import inputs_of

    scenario = load_scenario(file)
    if model.file.form == VARIED:
        return inputs_from_scenario(model.file, scenario)
    demand_same_kind(model.file, scenario)
    described = pd.DataFrame([inputs_of(scenario)._asdict()])
    known = with_traffic(described).iloc[0].dropna()
    return {str(name): v for name, v in known.items() if model.file.inputs.has(str(name))}


MOST_TABLE = 2_000 * MEGABYTE
"""Longest table of cases that is read. [byte]"""


def _demand_table_file(path: Path) -> None:
    if path.suffix == ".parquet":
        demand("parquet")
    if path.suffix not in (".csv", ".parquet"):
        raise ApproximatorError(
            f"{path} is neither .csv nor .parquet; give it one of these endings"
        )


def _read_table(path: Path) -> pd.DataFrame:
    try:
        demand_readable(path, MOST_TABLE)
        if path.suffix == ".parquet":
            return pd.read_parquet(path)
        return pd.read_csv(path, comment="#", skipinitialspace=True)
    except (OSError, ValueError) as error:
        raise ApproximatorError(f"{path} cannot be read as a table: {reason(error)}") from error


def _write(table: pd.DataFrame, out: Path) -> None:
    from tpss.approximator.model_file import write_bytes

    if out.suffix == ".parquet":
        write_bytes(out, table.to_parquet(index=False))
    else:
        text = table.to_csv(index=False, float_format="%.10g", lineterminator="\n")
        write_bytes(out, text.encode())


def _print_prediction(model: "Approximator", row: Any) -> None:
    """Figures of one line, one row per output."""
    from tpss.approximator.approximator import COLLAPSE, LIKELY

    names = [output.name for output in model.file.outputs]
    if COLLAPSE in row and row[COLLAPSE] >= LIKELY:
        chance = f"{row[COLLAPSE]:.3f}"
        print(f"The line cannot carry this load: probability of collapse {chance}")
        return
    rows = []
    for name in names:
        low, high = (_number(row[f"{name}.{end}"]) for end in ("low", "high"))
        rows.append((_words(name), _number(row[name]), f"{low} to {high}", units.label(name)))
    if COLLAPSE in row:
        ends = (f"{row[f'{COLLAPSE}.{end}']:.3f}" for end in ("low", "high"))
        rows.append(("probability of collapse", f"{row[COLLAPSE]:.3f}", " to ".join(ends), ""))
    _print_table(("", "figure", "90 % interval", "unit"), rows, Console())


def _print_predictions(model: "Approximator", predictions: pd.DataFrame) -> None:
    """Figures of several lines, one row per line; those of single stations are in files only."""
    from tpss.approximator.approximator import COLLAPSE

    names = [output.name for output in model.file.outputs if "station." not in output.name]
    headings = ["row", *(_heading(name) for name in names)]
    headings += ["collapse"] if COLLAPSE in predictions else []
    rows = []
    for number, (_, row) in enumerate(predictions.head(LINES_SHOWN).iterrows(), start=1):
        cells = [_with_interval(row, name) for name in names]
        chance = [f"{row[COLLAPSE]:.3f}"] if COLLAPSE in predictions else []
        rows.append((str(number), *cells, *chance))
    _print_table(headings, rows, Console())
    if len(predictions) > LINES_SHOWN:
        print(
            f"{len(predictions) - LINES_SHOWN:,} more rows; --out writes all of them into a file."
        )


def _with_interval(row: Any, name: str) -> str:
    if pd.isna(row[name]):
        return "-"
    half = (row[f"{name}.high"] - row[f"{name}.low"]) / 2.0
    return f"{_number(row[name])} ±{half:.2g}"


def check_model(file: Path, folder: Path | None) -> int:
    """Print what an approximator is, or how well it predicts a study; return the exit code."""
    from tpss.approximator.approximator import load_approximator

    model, console = load_approximator(file), Console()
    if folder is None:
        _print_model(model, console)
        return DONE
    demand("study")
    from tpss.approximator.compare import compare

    comparison = compare(model, folder)
    say(console, f"{comparison.tested:,} cases {comparison.which}")
    if comparison.outside:
        say(console, f"{comparison.outside:,} lie outside the trained region")
    _print_scores(comparison.scores, comparison.collapse, console)
    return DONE


def _print_model(model: "Approximator", console: Console) -> None:
    from tpss.approximator.inputs import shown

    data, inputs = model.file.data, model.file.inputs
    description = [
        f"Trained on {data.used - len(data.held_out):,} cases of the study {data.study} "
        f"({data.study_hash}) at steps of {data.time_step_min:g} min; {len(data.held_out):,} held out.",
        f"Simulated by TPSS {data.tpss_version} (kernels {data.kernel_hash}), trained by "
        + ", ".join(f"{name} {version}" for name, version in model.file.made_by.items())
        + ".",
        f"{model.neurons} in each of {model.members} networks.",
    ]
    description += _not_known(model)
    for line in description:
        console.print(line, highlight=False, markup=False)
    headings = ("input", "trained at", "unit", "may be given as")
    rows = []
    for each in inputs.varying:
        others = ", ".join(other.name for other in inputs.multiples if other.of == each.name)
        rows.append((each.name, each.range, units.label(each.name), others))
    for name, value in inputs.fixed.items():
        rows.append((name, f"{shown(value)} only", units.label(name), "or left out"))
    _print_table(headings, rows, console)
    _print_scores(model.file.scores, model.file.collapse_score, console)


def _not_known(model: "Approximator") -> list[str]:
    """What is predicted, what the study varies and the inputs leave out, and what is not predicted."""
    from tpss.approximator.forms import FED_BACK, FORMS, LOST

    left_out, untold = model.file.left_out, model.file.untold
    names = [output.name for output in model.file.outputs]
    told = [f"Predicts {', '.join(map(_words, names))}."]
    known = {*names, *untold}
    form = FORMS.get(model.file.form)
    kinds = {"what converters lose": LOST, "what trains feed back": FED_BACK}
    unknown = [words for words, (first, *_) in kinds.items() if first not in known]
    if form is not None and form.where_told and unknown:
        told.append(f"Its study does not tell {' or '.join(unknown)}, so neither does it.")
    if left_out:
        told.append(
            f"Left out, though the study varies it: {', '.join(left_out)}. What it changes is in the "
            "intervals only."
        )
    if untold:
        told.append(f"Not predicted, as some cases lack it or all are alike: {', '.join(untold)}.")
    return told


def _print_scores(
    scores: Iterable["Score"], collapse: "CollapseScore | None", console: Console
) -> None:
    headings = ("in cases held out", "median error", "90th percentile", "in interval", "unit")
    rows = []
    for score in scores:
        unit = score.unit or units.label(score.name)
        errors = (_number(score.median), _number(score.ninetieth))
        rows.append((_words(score.name), *errors, f"{score.coverage:.1%}", unit))
    _print_table(headings, rows, console)
    if collapse is not None:
        console.print(
            f"Whether the line collapses is predicted correctly in {collapse.accuracy:.1%} of cases; "
            f"{collapse.share:.1%} collapse.",
            highlight=False,
        )


def _print_table(headings: Sequence[str], rows: Sequence[Sequence[str]], console: Console) -> None:
    """Print a table, in a narrow terminal in parts, of which each begins with the first column."""

    def table_of(shown: Sequence[int], _: str) -> Table:
        table = Table(box=None, pad_edge=False)
        for k in (0, *shown):
            side: Literal["left", "right"] = "left" if k == 0 or headings[k] == "unit" else "right"
            table.add_column(escape(headings[k]), justify=side, overflow="fold")
        for row in rows:
            table.add_row(*(escape(row[k]) for k in (0, *shown)))
        return table

    print_in_parts(range(1, len(headings)), table_of, console)


def _words(name: str) -> str:
    return units.words(name).replace("station.", "").replace(".", " ")


def _heading(name: str) -> str:
    return f"{_words(name)}\n[{units.label(name) or 1}]"


def _number(value: float) -> str:
    return f"{value:.4g}"
