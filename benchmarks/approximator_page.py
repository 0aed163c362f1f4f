"""Write ``docs/approximator.md`` and its figures from a study, its approximator and its twins.

Usage: python benchmarks/approximator_page.py FOLDER --speed N

FOLDER holds the study of examples/study_tpsa.toml, what ``tpss approximate train`` makes of it in its
three forms, and for two of them what ``benchmarks/twins.py`` writes; see the page for the commands.
"""

import argparse
from dataclasses import dataclass
from pathlib import Path
from string import Template
from typing import Any

import matplotlib
import numpy as np
import pandas as pd
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import tpss
from tpss import units
from tpss.approximator.approximator import Approximator
from tpss.approximator.compare import given_by
from tpss.approximator.train import read_table, usable
from tpss.report.palette import COLOURS
from tpss.report.render.static import STYLE
from tpss.units import label

DOCS = Path(__file__).parents[1] / "docs"
TEMPLATE = Path(__file__).parent / "approximator_page.md"

TARGETS = {"trip_time_min": 1.0, "total_energy_mwh": 3.0, "lowest_voltage_kv": 0.15}
"""What the 90th percentile of the errors was meant to stay below."""

COVERAGE = (0.85, 0.95)
"""Share of the cases that was meant to lie inside their intervals of 90 %."""

FEWEST_PROFILES = 3
"""Profiles of a case, with lines that carry their load, from which a spread is taken."""


@dataclass(frozen=True)
class Held:
    """Cases held out, in which the line carried its load, and what was predicted."""

    table: pd.DataFrame
    found: dict[str, Any]

    def errors(self, name: str, scale: str) -> pd.Series:
        size = (self.found[name] - self.table[name]).abs()
        return 100.0 * size / self.table[name] if scale == "log" else size

    def inside(self, name: str) -> pd.Series:
        low, high = (self.found[f"{name}.{end}"] for end in ("low", "high"))
        return (low <= self.table[name]) & (self.table[name] <= high)


def held_of(model: Approximator, study: Path) -> Held:
    table = usable(read_table(study)[0])
    table = table[table["case"].isin(model.file.data.held_out) & (table["status"] == "finished")]
    table = table.reset_index(drop=True)
    x = model.file.inputs.encode(given_by(model, table).inputs)
    return Held(table, model.figures(x))


def noise_floor(model: Approximator, study: Path, twins: pd.DataFrame) -> pd.DataFrame:
    """90th percentiles over profiles: of their distance from their mean, and of the mean's error.

    The distance is that from the mean of all profiles; the mean of the few at hand is nearer to each
    of them, by the square root of 1 - 1/n.
    """
    own = read_table(study)[0]
    inputs = own[own["case"].isin(twins["case"])].set_index("case")
    everything = pd.concat([twins, inputs.reset_index()], ignore_index=True)
    everything = everything[everything["status"] == "finished"]
    x = model.file.inputs.encode(given_by(model, inputs).inputs)
    found = pd.DataFrame(model.figures(x), index=inputs.index)
    rows = {}
    for output in model.file.outputs:
        groups = everything.groupby("case")[output.name]
        count, mean = groups.transform("count"), groups.transform("mean")
        known = count >= FEWEST_PROFILES
        distance = (everything[output.name] - mean).abs() * np.sqrt(count / (count - 1.0))
        of_mean = (found[output.name] - groups.mean()).abs()
        of_mean = of_mean[groups.count().reindex(of_mean.index, fill_value=0) >= FEWEST_PROFILES]
        if output.scale == "log":
            distance, of_mean = 100.0 * distance / mean, 100.0 * of_mean / groups.mean()
        rows[output.name] = {
            "floor": float(np.percentile(distance[known], 90)),
            "of_mean": float(np.percentile(of_mean.dropna(), 90)),
        }
    return pd.DataFrame(rows).T


def collapse_floor(study: Path, twins: pd.DataFrame) -> float:
    """How often the likelier outcome of a case's profiles is right."""
    own = read_table(study)[0]
    own = own[own["case"].isin(twins["case"])]
    everything = pd.concat([twins[["case", "status"]], own[["case", "status"]]])
    share = (everything["status"] != "finished").groupby(everything["case"]).mean()
    return float(np.maximum(share, 1.0 - share).mean())


def words(name: str) -> str:
    return units.words(name).replace("station.", "").replace(".", " ")


def score_table(model: Approximator, floor: pd.DataFrame) -> str:
    """Scores of all outputs, a row each."""
    lines = [
        "| 90th percentile of the error | target | TPSA | floor | mean of profiles | in interval | "
        "linear | nearest |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for score in model.file.scores:
        unit = score.unit or label(score.name)
        limit = TARGETS.get(score.name)
        target = "" if limit is None else f"{limit:g} {unit}"
        reached = "" if limit is None or score.ninetieth <= limit else " (missed)"
        low, high = COVERAGE
        covered = "" if limit is None or low <= score.coverage <= high else " (missed)"
        cells = [
            words(score.name),
            target,
            f"**{score.ninetieth:.3g} {unit}**{reached}",
            *(f"{floor.loc[score.name, column]:.3g} {unit}" for column in ("floor", "of_mean")),
            f"{score.coverage:.1%}{covered}",
            *(f"{each:.3g} {unit}" for each in (score.linear_ninetieth, score.nearest_ninetieth)),
        ]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def coverage_table(model: Approximator, held: Held) -> str:
    """Errors and coverage by the gradients' deviation, the lowest voltage, and the supply."""
    supplies = held.table.groupby(["catenary", "transformers"]).groups
    deviation, voltage = held.table["gradient_std_permille"], held.table["lowest_voltage_kv"]
    groups = {
        "standard deviation of gradients below 1 ‰": deviation < 1.0,
        "1 to 2 ‰": (deviation >= 1.0) & (deviation < 2.0),
        "above 2 ‰": deviation >= 2.0,
        "lowest voltage above 15 kV": voltage >= 15.0,
        "13.5 to 15 kV": (voltage >= 13.5) & (voltage < 15.0),
        "below 13.5 kV": voltage < 13.5,
        **{
            f"{catenary}, transformers: {transformers}": held.table.index.isin(rows)
            for (catenary, transformers), rows in supplies.items()
        },
    }
    shown = [output for output in model.file.outputs if output.name in TARGETS]
    heads = [
        f"{words(o.name)} [{'%' if o.scale == 'log' else label(o.name)}] | in interval"
        for o in shown
    ]
    lines = [
        f"| held out cases | number | {' | '.join(heads)} |",
        "|---" * (2 + 2 * len(shown)) + "|",
    ]
    for name, chosen in groups.items():
        cells = [name, f"{int(chosen.sum()):,}"]
        for output in shown:
            errors = held.errors(output.name, output.scale)[chosen]
            cells += [f"{np.percentile(errors, 90):.3g}"]
            cells += [f"{held.inside(output.name)[chosen].mean():.1%}"]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def draw_parity(held: Held, file: Path) -> None:
    """Predicted over simulated, with the intervals of some."""
    shown = [
        "trip_time_min",
        "mean_speed_kmh",
        "total_energy_mwh",
        "losses_mwh",
        "lowest_voltage_kv",
    ]
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(9.0, 6.0))
        axes = figure.subplots(2, 3).ravel()
        for axis, name in zip(axes, shown, strict=False):
            true, value = held.table[name], held.found[name]
            ends = [held.found[f"{name}.{end}"] for end in ("low", "high")]
            axis.plot([true.min(), true.max()], [true.min(), true.max()], color="black", lw=0.7)
            axis.vlines(true, *ends, color=COLOURS[0], alpha=0.25, lw=0.8)
            axis.plot(true, value, ".", color=COLOURS[0], ms=2.5)
            if name in ("total_energy_mwh", "losses_mwh"):
                axis.set_xscale("log")
                axis.set_yscale("log")
            axis.set_title(f"{words(name)} [{label(name)}]")
            axis.set_xlabel("simulated")
            axis.set_ylabel("predicted")
        draw_calibration(axes[-1], held)
        FigureCanvasAgg(figure)
        figure.savefig(file, dpi=110)


def draw_calibration(axis: Any, held: Held) -> None:
    """Median half interval and 90th percentile of the error over the deviation of the gradients."""
    deviation = held.table["gradient_std_permille"]
    edges = np.linspace(0.0, deviation.max(), 8)
    place = np.clip(np.digitize(deviation, edges) - 1, 0, len(edges) - 2)
    middle = (edges[:-1] + edges[1:]) / 2.0
    name, scale = "trip_time_min", "log"
    errors = held.errors(name, scale)
    half = 50.0 * (held.found[f"{name}.high"] - held.found[f"{name}.low"]) / held.found[name]
    bins = range(len(middle))
    axis.plot(
        middle,
        [np.percentile(errors[place == k], 90) for k in bins],
        "o",
        color=COLOURS[1],
        label="90th percentile of the error",
    )
    axis.plot(
        middle, [np.median(half[place == k]) for k in bins], color=COLOURS[0], label="half interval"
    )
    axis.set_title("trip time: error and interval [%]")
    axis.set_xlabel("deviation of the gradients [‰]")
    axis.legend(fontsize=7.5)


def verdict(model: Approximator, floor: pd.DataFrame) -> str:
    """Which targets are reached, and what the floor says of those that are not."""
    missed = [s for s in model.file.scores if s.ninetieth > TARGETS.get(s.name, np.inf)]
    if not missed:
        return "All targets are reached."
    lines = ["Missed targets:", ""]
    for score in missed:
        unit, limit = score.unit or label(score.name), TARGETS[score.name]
        known = floor.loc[score.name]
        judged = (
            "the floor lies above the target: no approximator of these inputs reaches it"
            if known["floor"] > limit
            else "the floor lies below the target, but leaves little of it for the approximator"
        )
        lines.append(
            f"- {words(score.name)}: {score.ninetieth:.3g} {unit} instead of {limit:g} {unit}. "
            f"Profiles alone differ by {known['floor']:.3g} {unit}: {judged}. "
            f"From the mean over profiles TPSA lies {known['of_mean']:.3g} {unit} off."
        )
    return "\n".join(lines)


def tried_table(model: Approximator) -> str:
    kinds = {
        "figures": "figures",
        "noise": "logarithm of errors",
        "collapse": "collapse (log loss)",
    }
    lines = ["| networks of | error of cases not seen, by neurons |", "|---|---|"]
    for kind, errors in model.file.tried.items():
        cells = ", ".join(f"{neurons}: {error:.4f}" for neurons, error in errors.items())
        lines.append(f"| {kinds[kind]} | {cells} |")
    return "\n".join(lines)


def score_section(model: Approximator, study: Path, twins: pd.DataFrame) -> str:
    """Scores of a form, and what is said of its collapses and of targets that it misses."""
    floor, collapse = noise_floor(model, study, twins), model.file.collapse_score
    told = (
        "Whether the line carries its load is predicted correctly in "
        f"**{collapse.accuracy:.1%}** of the cases\n"
        f"(target 98 %; Brier score {collapse.brier:.4f}; {collapse.share:.1%} do not). "
        f"Logistic regression:\n{collapse.linear_accuracy:.1%}, "
        f"nearest case: {collapse.nearest_accuracy:.1%}. "
        "The likelier outcome over the profiles of a case is\n"
        f"right for {collapse_floor(study, twins):.1%} of them."
    )
    return "\n\n".join([score_table(model, floor), told, verdict(model, floor)])


def page(models: dict[str, Approximator], folder: Path, speed: int) -> str:
    model, original = models["profile"], models["original"]
    study = folder / "tpsa"
    data, added = model.file.data, original.file.scores[0]
    twins = {
        "aggregated": pd.read_parquet(folder / "twins.parquet"),
        "profile": pd.read_parquet(folder / "profile_twins.parquet"),
    }
    return Template(TEMPLATE.read_text("utf-8")).substitute(
        cases=f"{data.cases:,}",
        lost=f"{1.0 - data.carried / data.used:.1%}",
        trained=f"{data.used - len(data.held_out):,}",
        held_out=f"{len(data.held_out):,}",
        study_hash=data.study_hash,
        kernel_hash=data.kernel_hash,
        scikit=model.file.made_by["scikit-learn"],
        members=model.members,
        neurons=model.neurons,
        twin_cases=f"{twins['profile']['case'].nunique():,}",
        twin_profiles=int(twins["profile"].groupby("case").size().iloc[0]),
        profile_scores=score_section(model, study, twins["profile"]),
        aggregated_scores=score_section(models["aggregated"], study, twins["aggregated"]),
        coverage=coverage_table(model, held_of(model, study)),
        tried=tried_table(model),
        speed=f"{speed:,}",
        original_error=f"{added.ninetieth:.3g} %",
        original_coverage=f"{added.coverage:.1%}",
        original_accuracy=f"{original.file.collapse_score.accuracy:.1%}",
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--speed", type=int, required=True, help="what approximator.py has printed")
    given = parser.parse_args()
    models = {
        form: tpss.load_approximator(given.folder / f"{form}.json")
        for form in ("profile", "aggregated", "original")
    }
    (DOCS / "approximator").mkdir(exist_ok=True)
    held = held_of(models["profile"], given.folder / "tpsa")
    draw_parity(held, DOCS / "approximator" / "parity.png")
    (DOCS / "approximator.md").write_text(page(models, given.folder, given.speed), "utf-8")


if __name__ == "__main__":
    main()
