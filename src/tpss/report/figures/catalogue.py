"""All figures by their names, with their titles."""

from collections.abc import Callable, Mapping, Sequence
from typing import Literal, NamedTuple, get_args

from matplotlib.figure import Figure

from tpss.errors import ResultError, suggest
from tpss.report.corridor import ALONG, along
from tpss.report.drawings.braking import braking
from tpss.report.drawings.converter_losses import converter_losses
from tpss.report.drawings.effort import effort
from tpss.report.drawings.energy import energy_flow
from tpss.report.drawings.journey import journey
from tpss.report.drawings.network import network
from tpss.report.drawings.parts import Drawing
from tpss.report.drawings.rails import rail_voltage
from tpss.report.drawings.stations import station_loading, station_powers
from tpss.report.drawings.storage import storage
from tpss.report.drawings.thermal import thermal
from tpss.report.drawings.time_distance import time_distance
from tpss.report.drawings.unbalance import unbalance
from tpss.report.drawings.voltage import voltage_along_line, voltage_envelope
from tpss.report.palette import COLOURS
from tpss.report.render.static import as_text, render
from tpss.report.trains import NothingToDrawError, chosen_train
from tpss.results.result import Result

Against = Literal["time", "distance"]

Minutes = tuple[float | None, float | None]

TIME_DISTANCE = "time-distance"

Describe = Callable[..., Drawing]
"""From a result, or results by their labels, the name of a train or None, an `Against`, and `Minutes` or
nothing."""


class Entry(NamedTuple):
    """A figure of a result."""

    of: Literal["run", "trains", "train"]
    """What it needs: a run, trains on the line, or one train, which can be chosen."""
    shows: str
    """What it shows, and of which runs, as the gallery of the documentation says it."""
    describe: Describe
    overlaid: bool = False
    """Whether it can show several results: then it is described from results by their labels."""


FIGURES: dict[str, Entry] = {
    "network": Entry(
        "run",
        "all lines, true to length but without their course over the ground: the lowest voltage along "
        "them, stations, tracks, coupling posts and section breaks, open ones hollow, and what feeds "
        "them",
        lambda run, *_: network(run),
    ),
    TIME_DISTANCE: Entry(
        "trains",
        "paths of all trains, darker where the voltage at their pantographs is lower",
        lambda run, _train, _against, minutes=(None, None): time_distance(run, None, *minutes),
    ),
    "journey": Entry(
        "train",
        "a train's journey: gradient, speed below its limit, active and reactive power, voltage, angle, "
        "between the stations",
        lambda runs, train, against, *_: journey(runs, train, against, explained=len(runs) == 1),
        overlaid=True,
    ),
    "voltage": Entry(
        "run",
        "lowest, mean and highest voltage along the line, with the limits of EN 50163",
        lambda run, *_: voltage_envelope(run),
    ),
    "train-voltage": Entry(
        "train",
        "the voltage that one train met along the line, between the limits of EN 50163",
        lambda runs, train, *_: voltage_along_line(runs, train, True),
        overlaid=True,
    ),
    "stations": Entry(
        "run",
        "active and reactive power that each feeding station feeds",
        lambda runs, *_: station_powers(runs),
        overlaid=True,
    ),
    "converters": Entry(
        "run",
        "loading of the running converters or transformers, and how many run",
        lambda runs, *_: station_loading(runs),
        overlaid=True,
    ),
    "converter-losses": Entry(
        "run",
        "what converter stations take from the 50 Hz grid and lose; where their types describe losses",
        lambda runs, *_: converter_losses(runs),
        overlaid=True,
    ),
    "unbalance": Entry(
        "run",
        "negative-sequence voltage at the busbars of the grid and its means over 10 min, currents of "
        "the phases; where phases are told",
        lambda runs, *_: unbalance(runs),
        overlaid=True,
    ),
    "braking": Entry(
        "run",
        "what each service brakes, and where it goes; where trains have electric brakes",
        lambda runs, *_: braking(runs),
        overlaid=True,
    ),
    "storage": Entry(
        "run",
        "charge and power of the stores of energy; where trains or stations have any",
        lambda runs, *_: storage(runs),
        overlaid=True,
    ),
    "thermal": Entry(
        "run",
        "thermal state of the equipment with a rating that comes closest to what it bears, and its "
        "temperature where that is known",
        lambda runs, *_: thermal(runs),
        overlaid=True,
    ),
    "rails": Entry(
        "run",
        "highest and lowest voltage of the rails to earth along each line; where they are conductors of "
        "their own",
        lambda run, *_: rail_voltage(run),
    ),
    "energy": Entry(
        "run",
        "what the stations feed, what the network loses, and what the trains use the rest for",
        lambda run, *_: energy_flow(run),
    ),
    "effort": Entry(
        "train",
        "speed and force of a train, and the limits of its machine, its rails, and its resistance",
        lambda run, train, *_: effort(run, train),
    ),
}
"""Figures by their names."""

ALONG_A_CORRIDOR = ("time-distance", "journey", "voltage", "train-voltage")
"""Figures of a network that are drawn along a corridor; a journey only if one is chosen."""

OVERLAID = [name for name, figure in FIGURES.items() if figure.overlaid]
"""Figures that can show several results."""

OF_A_TRAIN = [name for name, figure in FIGURES.items() if figure.of == "train"]
"""Figures for which a train can be chosen."""

ENDED = {
    "collapsed": "collapsed",
    "stalled": "ended by a stalled train",
    "deadlocked": "ended by trains that wait for each other",
    "interrupted": "interrupted",
}


def draw(
    name: str,
    result: Result,
    train: str | None = None,
    against: Against = "distance",
    corridor: Sequence[str] = (),
    minutes: Minutes = (None, None),
) -> Figure:
    """Draw a figure with its title, which also says if the run ended early.

    Parameters
    ----------
    name : str
        One of `FIGURES`.
    result : Result
    train : str, optional
        The train of those of one train; the studied one, or the first on the line, by default.
    against : {"time", "distance"}
        Quantity of the horizontal axis of a journey.
    corridor : sequence of str
        Stations of a network over which a figure along a line is drawn, by default those on the way of
        the first service; or two stations of a single line.
    minutes : pair of float or None
        First and last minute that a time-distance graph shows; None: those of the run.

    Raises
    ------
    ResultError
        The audit failed, or there is no such figure, train, minute or quantity.
    NothingToDrawError
        No step was simulated, or no train was on the line.
    """
    return overlay(name, {"": result}, train, against, corridor, minutes)


def overlay(
    name: str,
    runs: Mapping[str, Result],
    train: str | None = None,
    against: Against = "distance",
    corridor: Sequence[str] = (),
    minutes: Minutes = (None, None),
) -> Figure:
    """`draw` a figure of one or several results, which it shows by their labels.

    Raises
    ------
    ResultError
        As `draw`, of any of them; or the figure shows a single result, and there are several.
    NothingToDrawError
        As `draw`.
    """
    demand_figure(name)
    if against not in get_args(Against):
        known = " or ".join(get_args(Against))
        raise ResultError(f"a journey is drawn against {known}, not {against!r}")
    if len(runs) > 1 and not FIGURES[name].overlaid:
        raise ResultError(f"{name} shows a single result; name one, or draw {', '.join(OVERLAID)}")
    for result in runs.values():
        _demand_drawable(result)
    entry = FIGURES[name]
    follows = name in ALONG_A_CORRIDOR and (corridor or name != "journey")
    seen = {label: along(run, corridor) if follows else run for label, run in runs.items()}
    first = next(iter(seen.values()))
    chosen = None if train is None and entry.of == "run" else chosen_train(first, train)
    asked = chosen if len(runs) == 1 else train  # of several each its own
    shown = seen if entry.overlaid else first
    figure = render(entry.describe(shown, asked, against, minutes))
    told = [chosen if entry.of == "train" else None, first.dataset.attrs.get(ALONG)]
    _entitle(figure, runs, [each for each in told if each])
    return figure


def _demand_drawable(result: Result) -> None:
    """Raise an error if the figures of a result cannot be trusted, or there is nothing in it."""
    if not result.audit["passed"]:
        raise ResultError(
            "the audit of the result failed, so its figures cannot be trusted and are not drawn: "
            + "; ".join(result.audit["failures"])
        )
    if result.dataset.sizes["time"] < 2:
        raise NothingToDrawError("no time step was simulated")


def _entitle(figure: Figure, runs: Mapping[str, Result], told: Sequence[str]) -> None:
    """Write above a figure what it shows, and which run ended early."""
    names = [result.scenario.name for result in runs.values()]
    whole = names[0] if len(runs) == 1 else " / ".join(runs)
    title = ": ".join([whole, *map(as_text, told)])
    figure.suptitle(title, fontsize="large")
    early = [(label, run) for label, run in runs.items() if run.status in ENDED]
    for label, run in early:
        which = f"{label} " if label else ""
        title += f"\n{which}{ENDED[run.status]} at {float(run.dataset.time[-1]) / 60.0:.1f} min"
    if early:
        figure.suptitle(title, fontsize="large", color=COLOURS[1], fontweight="bold")


def applies(name: str, result: Result) -> bool:
    """Whether a figure shows something that the scenario of a result describes."""
    if name == "unbalance":
        return len(result.standards.unbalance) > 0
    tables = {
        "converter-losses": "converter_losses", "braking": "regeneration", "storage": "storage",
        "rails": "rails",
    }  # fmt: skip
    return name not in tables or len(getattr(result, tables[name])) > 0


def demand_figure(name: str) -> None:
    """Raise a `ResultError` if there is no figure of that name."""
    if name not in FIGURES:
        raise ResultError(f"there is no figure {name!r}; {suggest(name, [*FIGURES, 'all'])}")
