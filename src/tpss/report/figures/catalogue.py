"""All figures by their names, with their titles."""

from collections.abc import Callable, Sequence
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
"""From a result, the name of a train or None, an `Against`, and `Minutes` or nothing."""


class Entry(NamedTuple):
    """A figure of a result."""

    of: Literal["run", "trains", "train"]
    """What it needs: a run, trains on the line, or one train, which can be chosen."""
    shows: str
    """What it shows, and of which runs, as the gallery of the documentation says it."""
    describe: Describe


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
        lambda run, train, against, *_: journey({"": run}, train, against, explained=True),
    ),
    "voltage": Entry(
        "run",
        "lowest, mean and highest voltage along the line, with the limits of EN 50163",
        lambda run, *_: voltage_envelope(run),
    ),
    "train-voltage": Entry(
        "train",
        "the voltage that one train met along the line, between the limits of EN 50163",
        lambda run, train, *_: voltage_along_line({"": run}, train, True),
    ),
    "stations": Entry(
        "run",
        "active and reactive power that each feeding station feeds",
        lambda run, *_: station_powers({"": run}),
    ),
    "converters": Entry(
        "run",
        "loading of the running converters or transformers, and how many run",
        lambda run, *_: station_loading(run),
    ),
    "converter-losses": Entry(
        "run",
        "what converter stations take from the 50 Hz grid and lose; where their types describe losses",
        lambda run, *_: converter_losses({"": run}),
    ),
    "unbalance": Entry(
        "run",
        "negative-sequence voltage at the busbars of the grid and its means over 10 min, currents of "
        "the phases; where phases are told",
        lambda run, *_: unbalance({"": run}),
    ),
    "braking": Entry(
        "run",
        "what each service brakes, and where it goes; where trains have electric brakes",
        lambda run, *_: braking({"": run}),
    ),
    "storage": Entry(
        "run",
        "charge and power of the stores of energy; where trains or stations have any",
        lambda run, *_: storage({"": run}),
    ),
    "thermal": Entry(
        "run",
        "thermal state of the equipment with a rating that comes closest to what it bears, and its "
        "temperature where that is known",
        lambda run, *_: thermal({"": run}),
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
    demand_figure(name)
    if against not in get_args(Against):
        known = " or ".join(get_args(Against))
        raise ResultError(f"a journey is drawn against {known}, not {against!r}")
    if not result.audit["passed"]:
        raise ResultError(
            "the audit of the result failed, so its figures cannot be trusted and are not drawn: "
            + "; ".join(result.audit["failures"])
        )
    if result.dataset.sizes["time"] < 2:
        raise NothingToDrawError("no time step was simulated")
    of, _, describe = FIGURES[name]
    follows = name in ALONG_A_CORRIDOR and (corridor or name != "journey")
    seen = along(result, corridor) if follows else result
    chosen = None if train is None and of == "run" else chosen_train(seen, train)
    figure = render(describe(seen, chosen, against, minutes))
    told = [chosen if of == "train" else None, seen.dataset.attrs.get(ALONG)]
    title = ": ".join([result.scenario.name, *(as_text(each) for each in told if each)])
    figure.suptitle(title, fontsize="large")
    if result.status in ENDED:
        title += f"\n{ENDED[result.status]} at {float(result.dataset.time[-1]) / 60.0:.1f} min"
        figure.suptitle(title, fontsize="large", color=COLOURS[1], fontweight="bold")
    return figure


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
