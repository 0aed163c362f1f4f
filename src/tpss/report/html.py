"""A report of results: one HTML file that needs nothing else, to be read, printed and passed on."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import tomli_w
from plotly.graph_objects import Figure

from tpss.audit.verdict import JUDGED, usual_limits
from tpss.errors import ResultError
from tpss.files.refusals import explained, refuse_to_replace
from tpss.files.whole import write_file
from tpss.measured.compare import MeasuredComparison
from tpss.model.supply import system_of
from tpss.report import sampling, tables
from tpss.report.contact_line import LineVoltage, line_voltage
from tpss.report.corridor import ALONG, along, gradients_along, is_corridor
from tpss.report.cover import Cover, drawing_of, worst_places
from tpss.report.drawings.braking import braking
from tpss.report.drawings.converter_losses import converter_losses
from tpss.report.drawings.journey import journey
from tpss.report.drawings.losses import losses
from tpss.report.drawings.network import network, rows_of
from tpss.report.drawings.parts import Drawing
from tpss.report.drawings.rails import rail_voltage
from tpss.report.drawings.stations import station_loading, station_powers
from tpss.report.drawings.storage import storage
from tpss.report.drawings.thermal import thermal
from tpss.report.drawings.time_distance import time_distance
from tpss.report.drawings.unbalance import unbalance
from tpss.report.drawings.voltage import envelopes
from tpss.report.measured import MeasuredPart, measured_part
from tpss.report.moving import network_moving
from tpss.report.page import fill
from tpss.report.render.interactive import render
from tpss.report.status import STATUS_IN_WORDS
from tpss.report.trains import chosen_train, seen_trains
from tpss.report.validity import limits_of_validity
from tpss.results.contents import is_report
from tpss.results.notes import notes
from tpss.results.places import LINE
from tpss.results.result import Result
from tpss.results.step_words import step_lines

OVER_TIME: dict[str, tuple[Callable[[Mapping[str, Result]], Drawing], int]] = {
    "powers": (station_powers, 440),
    "converters": (station_loading, 440),
    "losses": (losses, 260),
    "converter-losses": (converter_losses, 440),
    "unbalance": (unbalance, 760),
    "storage": (storage, 440),
    "thermal": (thermal, 440),
}
"""Plots of one run or several over time, by the names of their elements, and their heights. [px]"""

OF_A_JOURNEY = ("speed [km/h]", "voltage [kV]", "gradient [‰]")
"""Panels of a journey; the page refills them when another train is chosen."""


def write_report(
    results: Result | Mapping[str, Result],
    file: str | Path,
    *,
    force: bool = False,
    corridor: Sequence[str] = (),
    measured: MeasuredComparison | None = None,
    cover: Cover | None = None,
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
    corridor : sequence of str
        Stations of a network over which plots along a line are drawn, by default those on the way of the
        first service; or two stations of a single line.
    measured : MeasuredComparison, optional
        Comparison of a single result with measurements, which becomes a part of its report.
    cover : Cover, optional
        Title and remarks of an author, for the first page of the report of a single result.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    ResultError
        The file exists, or cannot be written; there is no such corridor; or measurements are given for
        several results, or for another one; or a cover is given for several results.
    """
    place = Path(file)
    check_target(place, force)
    if measured is not None and measured.result is not results:
        raise ResultError(
            "measurements belong into the report of the result they are compared with"
        )
    if cover is not None and not isinstance(results, Result):
        raise ResultError("a cover belongs to the report of a single result")
    text = (
        report(results, corridor, measured, cover)
        if isinstance(results, Result)
        else comparison(results, corridor)
    )
    with explained(place):
        write_file(place, text.encode())
    return place


def check_target(file: Path, force: bool) -> None:
    """Raise a `ResultError` if a report may not be written there."""
    refuse_to_replace(file, force, "a report", is_report)


def report(
    result: Result,
    corridor: Sequence[str] = (),
    measured: MeasuredComparison | None = None,
    cover: Cover | None = None,
) -> str:
    """Page about one result, perhaps with its comparison with measurements.

    A result whose audit failed is shown without its figures: they cannot be trusted.
    """
    trusted, seen = bool(result.audit["passed"]), along(result, corridor)
    voltage = line_voltage(seen.dataset) if trusted else None
    figures, data = _figures(result, seen, voltage) if voltage else ({}, {})
    part, drawn = (None, {}) if measured is None else measured_part(measured)
    shown = [
        tables.of_frame("trains", "Trains", result.trips),
        tables.of_frame("stops", "Times at stops", result.stops),
        *(
            [tables.of_frame("waits", "Waits for others", result.waits)]
            if len(result.waits)
            else []
        ),
        tables.of_frame("stations", "Feeding stations", result.stations),
        *tables.of_converter_losses(result),
        *tables.of_transformer_losses(result),
        *tables.of_regeneration(result),
        *tables.of_conductors(result),
        *tables.of_storage(result),
        *(
            [tables.of_frame("thermal", "Thermal state of equipment", result.thermal)]
            if len(result.thermal)
            else []
        ),
        *tables.of_standards(result),
    ]
    return _page(
        title=(cover and cover.title) or result.scenario.name,
        cover=cover,
        results={"": result},
        figures={**figures, **drawn},
        data=data,
        tables=shown if trusted else [],
        key_figures=tables.of_figures({"value": result}) if trusted else None,
        notes=_notes(result, voltage, data),
        measured=part,
    )


def comparison(results: Mapping[str, Result], corridor: Sequence[str] = ()) -> str:
    """Page that compares results side by side; curves of results whose audit failed are left out."""
    trusted = {label: result for label, result in results.items() if result.audit["passed"]}
    seen = {label: along(result, corridor) for label, result in trusted.items()}
    voltages = {label: line_voltage(result.dataset) for label, result in seen.items()}
    drawn = {label: (seen[label], line) for label, line in voltages.items() if line is not None}
    runs = {label: trusted[label] for label in drawn}
    figures, data = {}, {}
    if drawn:
        figures = {"envelopes": render(envelopes(drawn, with_trains=True), 460), **_over_time(runs)}
        driven = {
            f"{label}: {chosen_train(run)}": run for label, run in runs.items() if seen_trains(run)
        }
        if driven:
            figures["journey"] = render(journey(driven, shown=OF_A_JOURNEY), 560)
        data = _moving({label: seen[label] for label in drawn}, runs, "envelopes")
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


def _figures(
    result: Result, seen: Result, voltage: LineVoltage
) -> tuple[dict[str, Figure], dict[str, Any]]:
    """Figures of a result, some as it is seen, and what the page needs to move trains."""
    figures = {
        "moment": render(envelopes({"": (seen, voltage)}, with_trains=True), 460),
        "graph": render(time_distance(seen, voltage), 520),
        **_over_time({"": result}),
    }
    data = _moving({"": seen}, {"": result}, "moment")
    if data["choices"]:
        chosen = data["runs"][0]["chosen"]
        figures["journey"] = render(journey({chosen: result}, shown=OF_A_JOURNEY), 560)
    if LINE in result.dataset.coords:
        plan = network(result, with_trains=True)
        figures["network"] = render(plan, 140 + round(120 * rows_of(plan)))
    return figures, data


def _over_time(runs: Mapping[str, Result]) -> dict[str, Figure]:
    rated = {label: run for label, run in runs.items() if run.equipment.elements}
    lossy = {label: run for label, run in runs.items() if len(run.converter_losses)}
    at_grid = {label: run for label, run in runs.items() if len(run.standards.unbalance)}
    storing = {label: run for label, run in runs.items() if len(run.storage)}
    shown = {
        "thermal": rated, "converter-losses": lossy, "unbalance": at_grid, "storage": storing,
    }  # fmt: skip
    drawn = {
        key: render(describe(own), height)
        for key, (describe, height) in OVER_TIME.items()
        if (own := shown.get(key, runs))
    }
    return {**drawn, **_braked(runs), **_rails(runs)}


def _rails(runs: Mapping[str, Result]) -> dict[str, Figure]:
    """Voltage of the rails of a single run; nothing unless they are conductors of their own."""
    if len(runs) > 1 or not all(len(run.rails) for run in runs.values()):
        return {}
    drawing = rail_voltage(next(iter(runs.values())))
    return {"rails": render(drawing, 60 + 320 * len(drawing.panels))}


def _braked(runs: Mapping[str, Result]) -> dict[str, Figure]:
    """Where braked energy goes, as high as its bars; nothing without electric brakes."""
    if not any(len(run.regeneration) for run in runs.values()):
        return {}
    drawing = braking(runs)
    return {"braking": render(drawing, 170 + 44 * len(drawing.panels[0].rows))}


def _moving(seen: Mapping[str, Result], whole: Mapping[str, Result], plot: str) -> dict[str, Any]:
    """Data to move the trains of all runs in a plot, and to show the journey of any.

    Time advances in the finest steps.
    """
    most = sampling.MOST_OF_TRAINS // len(seen)
    moving = [_moving_run(label, run, whole[label], most) for label, run in seen.items()]
    finest = min(run["step_min"] for run in moving)
    common = [{train["name"] for train in (run["network"] or run)["trains"]} for run in moving]
    names = [train["name"] for train in (moving[0]["network"] or moving[0])["trains"]]
    return {
        "plot": plot,
        "step_min": finest,
        "start_s": next(iter(whole.values())).scenario.simulation.start_s,
        "steps": max(round(run["steps"] * run["step_min"] / finest) for run in moving),
        "runs": moving,
        "choices": [name for name in names if all(name in each for each in common)],
        "thinned": any(run["thinned"] for run in moving),
        "corridor": next(iter(seen.values())).dataset.attrs.get(ALONG, ""),
    }


def _moving_run(label: str, seen: Result, whole: Result, most: int) -> dict[str, Any]:
    """Data of a run: trains as they are seen along a line, and those of a network on all lines."""
    several = LINE in whole.dataset.coords  # whose trains are in the page twice
    share = most // 2 if several else most
    network = network_moving(whole, share) if several else None
    samples = sampling.sample_trains(seen.dataset, share, with_gaps=is_corridor(seen))
    limits = whole.scenario.standards.voltage_limits
    return {
        "label": label,
        "step_min": whole.dataset.attrs["time_step_s"] / 60.0,
        "steps": whole.dataset.sizes["time"] - 1,
        "trains": samples.trains,
        "network": network,
        "chosen": chosen_train(whole) if seen_trains(whole) else None,
        "thinned": samples.thinned or bool(network and network["thinned"]),
        "low_kv": limits.umin1_kv,
        "high_kv": limits.umax1_kv,
        "gradients": [list(each) for each in gradients_along(seen)],
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
    measured: MeasuredPart | None = None,
    cover: Cover | None = None,
) -> str:
    first = next(iter(results.values()))
    return fill(
        "report.html",
        title,
        figures,
        data,
        results=results,
        single=first if len(results) == 1 else None,
        troubles=_troubles(results),
        status_names=STATUS_IN_WORDS,
        tables=tables,
        key_figures=key_figures,
        differing=differing,
        measured=measured,
        cover=cover,
        picture=drawing_of(first) if cover else "",
        worst=worst_places(first) if cover else [],
        notes=notes,
        limits={label: _limits(result) for label, result in results.items()},
        judged=JUDGED,
        validity=limits_of_validity(result.scenario for result in results.values()),
        violations=_violations(results),
        steps={label: step_lines(result.summary) for label, result in results.items()},
        scenarios={key: tomli_w.dumps(run.scenario.as_document()) for key, run in results.items()},
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
