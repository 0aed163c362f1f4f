"""A report of results: one HTML file that needs nothing else, to be read, printed and passed on.

Jinja2 fills the page, because it escapes every name and text of a scenario; plotly draws, and its
script is part of the file.  The page blocks all access to the network.
"""

import json
from collections.abc import Callable, Mapping, Sequence
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path
from typing import Any

import jinja2
import tomli_w
from plotly.graph_objects import Figure
from plotly.offline import get_plotlyjs

from tpss.audit.verdict import JUDGED, usual_limits
from tpss.files.refusals import explained, refuse_to_replace
from tpss.files.whole import write_file
from tpss.model.supply import system_of
from tpss.report import sampling, tables
from tpss.report.contact_line import LineVoltage, line_voltage
from tpss.report.corridor import along, gradients_along, is_corridor
from tpss.report.drawings.journey import journey
from tpss.report.drawings.losses import losses
from tpss.report.drawings.network import network, rows_of
from tpss.report.drawings.parts import Drawing
from tpss.report.drawings.stations import station_loading, station_powers
from tpss.report.drawings.time_distance import time_distance
from tpss.report.drawings.voltage import envelopes
from tpss.report.moving import network_moving
from tpss.report.render.interactive import render
from tpss.report.trains import chosen_train, seen_trains
from tpss.report.validity import limits_of_validity
from tpss.results.contents import REPORT_MARK, is_report
from tpss.results.notes import notes
from tpss.results.result import Result
from tpss.results.step_words import step_lines
from tpss.units import kilometres

STATUS_IN_WORDS = {
    "finished": "The run finished.",
    "collapsed": "The line cannot carry its load: the run collapsed.",
    "stalled": "A train stalled, which ended the run.",
    "interrupted": "The run was interrupted.",
}

OVER_TIME: dict[str, tuple[Callable[[Mapping[str, Result]], Drawing], int]] = {
    "powers": (station_powers, 440),
    "converters": (station_loading, 440),
    "losses": (losses, 260),
}
"""Plots of one run or several over time, by the names of their elements, and their heights. [px]"""

OF_A_JOURNEY = ("speed [km/h]", "voltage [kV]", "gradient [‰]")
"""Panels of a journey; the page refills them when another train is chosen."""


def write_report(
    results: Result | Mapping[str, Result], file: str | Path, *, force: bool = False
) -> Path:
    """Write a report of one result, or a comparison of several, into one HTML file.

    Parameters
    ----------
    results : Result or mapping of str to Result
        A result, or results by the labels under which they are compared.
    file : path
        File to write.
    force : bool
        Whether a report that is there may be replaced.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    ResultError
        The file exists, or cannot be written.
    """
    place = Path(file)
    check_target(place, force)
    text = report(results) if isinstance(results, Result) else comparison(results)
    with explained(place):
        write_file(place, text.encode())
    return place


def check_target(file: Path, force: bool) -> None:
    """Raise a `ResultError` if a report may not be written there."""
    refuse_to_replace(file, force, "a report", is_report)


def report(result: Result) -> str:
    """Page about one result.

    A result whose audit failed is shown without its figures: they cannot be trusted.
    """
    trusted, seen = bool(result.audit["passed"]), along(result)
    voltage = line_voltage(seen.dataset) if trusted else None
    figures, data = _figures(seen, voltage) if voltage else ({}, {})
    if voltage and is_corridor(seen):
        figures["network"], data["network"] = _network(result)
    shown = [
        tables.of_frame("trains", "Trains", result.trips),
        tables.of_frame("stops", "Times at stops", result.stops),
        *(
            [tables.of_frame("waits", "Waits for others", result.waits)]
            if len(result.waits)
            else []
        ),
        tables.of_frame("stations", "Feeding stations", result.stations),
        *tables.of_standards(result),
    ]
    return _page(
        title=result.scenario.name,
        results={"": result},
        figures=figures,
        data=data,
        tables=shown if trusted else [],
        key_figures=tables.of_figures({"value": result}) if trusted else None,
        notes=_notes(result, voltage, data),
    )


def comparison(results: Mapping[str, Result]) -> str:
    """Page that compares results side by side; curves of results whose audit failed are left out."""
    trusted = {label: result for label, result in results.items() if result.audit["passed"]}
    seen = {label: along(result) for label, result in trusted.items()}
    voltages = {label: line_voltage(result.dataset) for label, result in seen.items()}
    drawn = {label: (seen[label], line) for label, line in voltages.items() if line is not None}
    runs = {label: result for label, (result, _) in drawn.items()}
    figures, data = {}, {}
    if drawn:
        figures = {"envelopes": render(envelopes(drawn, with_trains=True), 460), **_over_time(runs)}
        driven = {
            f"{label}: {chosen_train(run)}": run for label, run in runs.items() if seen_trains(run)
        }
        if driven:
            figures["journey"] = render(journey(driven, shown=OF_A_JOURNEY), 560)
        data = _moving(runs, "envelopes")
    left_out = [f"{label}: nothing to draw" for label in results if label not in drawn]
    return _page(
        title=" / ".join(results),
        results=results,
        figures=figures,
        data=data,
        tables=[],
        key_figures=tables.of_figures(trusted) if trusted else None,
        differing=tables.of_differences(results),
        notes=[*left_out, *_about_samples(data, runs)],
    )


def _figures(result: Result, voltage: LineVoltage) -> tuple[dict[str, Figure], dict[str, Any]]:
    """Figures of a result, and what the page needs to move trains and to show any journey."""
    figures = {
        "moment": render(envelopes({"": (result, voltage)}, with_trains=True), 460),
        "graph": render(time_distance(result, voltage), 520),
        **_over_time({"": result}),
    }
    chosen = chosen_train(result) if seen_trains(result) else None
    if chosen is not None:
        figures["journey"] = render(journey({chosen: result}, shown=OF_A_JOURNEY), 560)
    return figures, {**_moving({"": result}, "moment"), "chosen": chosen}


def _network(result: Result) -> tuple[Figure, dict[str, Any]]:
    """The plan of a network, and what the page needs to move the trains on it."""
    drawing = network(result, with_trains=True)
    return render(drawing, 140 + round(120 * rows_of(drawing))), network_moving(result)


def _over_time(runs: Mapping[str, Result]) -> dict[str, Figure]:
    return {key: render(describe(runs), height) for key, (describe, height) in OVER_TIME.items()}


def _moving(runs: Mapping[str, Result], plot: str) -> dict[str, Any]:
    """Data to move the trains of all runs in a plot; time advances in the finest steps."""
    most = sampling.MOST_OF_TRAINS // len(runs)
    moving, thinned = [], False
    for label, result in runs.items():
        samples = sampling.sample_trains(result.dataset, most)
        thinned = thinned or samples.thinned
        limits = result.scenario.standards.voltage_limits
        moving.append(
            {
                "label": label,
                "step_min": result.dataset.attrs["time_step_s"] / 60.0,
                "steps": result.dataset.sizes["time"] - 1,
                "trains": samples.trains,
                "low_kv": limits.umin1_kv,
                "high_kv": limits.umax1_kv,
                "gradients": [list(each) for each in gradients_along(result)],
            }
        )
    finest = min(run["step_min"] for run in moving)
    return {
        "plot": plot,
        "step_min": finest,
        "steps": max(round(run["steps"] * run["step_min"] / finest) for run in moving),
        "runs": moving,
        "chosen": None,
        "thinned": thinned,
    }


def _notes(result: Result, voltage: LineVoltage | None, data: Mapping[str, Any]) -> list[str]:
    """What was limited in the run, and what the plots leave out."""
    remarks = [*notes(result), *result.standards.notes]
    if result.dataset.sizes["time"] < 2:
        return [*remarks, "no time step was simulated, so there is nothing to draw"]
    if voltage is None:
        return remarks
    if voltage.steps_a_column > 1:
        remarks.append(
            f"a column of the time-distance graph shows the lowest voltage of {voltage.steps_a_column} "
            "time steps"
        )
    return [*remarks, *_about_samples(data, {"": result})]


def _about_samples(data: Mapping[str, Any], runs: Mapping[str, Result]) -> list[str]:
    """Notes on trains and curves that are not drawn from every time step."""
    notes = []
    if data and data["thinned"]:
        notes.append(
            "the journeys and the moving trains are drawn from a part of the time steps, which holds "
            "the lowest and highest speeds and voltages; between them the motion is interpolated"
        )
    curves = 2 * sum(run.dataset.sizes["station"] for run in runs.values())
    most = sampling.share(sampling.MOST_OF_CURVES, curves)
    if any(run.dataset.sizes["time"] > most for run in runs.values()):
        notes.append(
            "the curves over time are drawn from a part of the time steps, which holds the lowest and "
            "highest value of each interval; the saved result has them all"
        )
    return notes


def _page(
    *,
    title: str,
    results: Mapping[str, Result],
    figures: Mapping[str, Figure],
    data: Mapping[str, Any],
    tables: Sequence[tables.Table],
    key_figures: tables.Table | None,
    notes: Sequence[str],
    differing: tables.Table | None = None,
) -> str:
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("tpss.report", "template"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["kilometres"] = kilometres
    first = next(iter(results.values()))
    return environment.get_template("report.html").render(
        generator=REPORT_MARK,
        version=version("tpss"),
        title=title,
        results=results,
        single=first if len(results) == 1 else None,
        troubles=_troubles(results),
        status_names=STATUS_IN_WORDS,
        figures=figures,
        data=data,
        tables=tables,
        key_figures=key_figures,
        differing=differing,
        notes=notes,
        limits={label: _limits(result) for label, result in results.items()},
        judged=JUDGED,
        validity=limits_of_validity(results.values()),
        violations=_violations(results),
        steps={label: step_lines(result.summary) for label, result in results.items()},
        scenarios={key: tomli_w.dumps(run.scenario.as_document()) for key, run in results.items()},
        style=_part("report.css"),
        script=_part("report.js"),
        plotly=get_plotlyjs() if figures else "",
        report_data=_for_script(figures, data),
    )


def _limits(result: Result) -> dict[str, float]:
    """Limits of a run's audit; the usual ones of a result that was saved without them."""
    usual = usual_limits(system_of(result.scenario.supply).base_power_va)
    limits: dict[str, float] = result.audit.get("limits", usual)
    return limits


def _troubles(results: Mapping[str, Result]) -> list[dict[str, Any]]:
    """Banners above everything: runs that failed their audit or ended early."""
    troubles = []
    for label, result in results.items():
        failures = result.audit["failures"]
        if result.status == "finished" and result.audit["passed"]:
            continue
        troubles.append(
            {
                "label": label,
                "failures": failures,
                "audit_failed": not result.audit["passed"],
                "status": result.status,
                "problem": result.summary.get("problem", ""),
                "advice": result.summary.get("advice", ""),
            }
        )
    return troubles


def _violations(results: Mapping[str, Result]) -> dict[str, list[str]]:
    """Violations of limits in words, the worst first, of the runs that have a voltage."""
    return {
        label: [str(words) for words in result.standards.violations.words]
        for label, result in results.items()
        if result.audit["passed"] and result.dataset.sizes["time"] > 1
    }


def _part(name: str) -> str:
    return (files("tpss.report") / "template" / name).read_text(encoding="utf-8")


def _for_script(figures: Mapping[str, Figure], data: Mapping[str, Any]) -> str:
    """The page's data as JSON that cannot end the script element which holds it."""
    drawn = ",".join(f"{json.dumps(key)}:{figure.to_json()}" for key, figure in figures.items())
    text = f'{{"plots":{{{drawn}}},"run":{json.dumps(data, separators=(",", ":"))}}}'
    return text.replace("<", "\\u003c")
