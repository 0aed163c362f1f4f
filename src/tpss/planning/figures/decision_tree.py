"""Decision tree: what is built on its branches, beside it the traffic, and how likely that is."""

import textwrap
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from tpss.planning.plan_faults import PRICES
from tpss.planning.served import NO_TRAFFIC
from tpss.planning.states import at_stage
from tpss.planning.wording import number, traffic_in_words, varied_in_words
from tpss.planning.written import Written
from tpss.report.drawings.parts import (
    ABOVE,
    BELOW,
    CROSS,
    RING,
    SQUARE,
    Curve,
    Drawing,
    Panel,
    Places,
    Words,
)
from tpss.report.palette import GREY, STRONG_GREY

WIDTH_INCH, STAGE_INCH = 9.0, 2.2
"""Width of a tree, and the least of one of its stages."""

LINE_INCH, BETWEEN_INCH = 0.17, 0.16
"""Height of a line of text, and what is between the branches besides."""

LETTERS_AN_INCH = 12.0
"""Letters that fit."""

MOST_ENDS = 100
"""Ends of a tree that is drawn; a larger one is in the table of decisions."""

BEGIN, END = -0.46, 0.42
"""Where a branch begins, and where its node is, from the middle of its stage."""

RUN = {
    "the traffic asked for runs": (RING, "#009E73"),
    "a part of it runs": (SQUARE, "#E69F00"),
    "no train runs": (CROSS, "#D55E00"),
}
"""What is run in a node, with its symbol and colour."""

BUILT, LIMITED = "#0072B2", "#A63D00"


@dataclass(frozen=True)
class Node:
    """A node of the tree, with what is written at its branch."""

    stage: int
    futures: tuple[str, ...]
    built: str
    """Above its branch: what comes into service; empty if nothing does."""
    otherwise: str
    """What stands there in its place."""
    below: tuple[str, ...]
    run: str
    """What is run, a key of `RUN`."""
    missed: bool
    probability: float


def decision_tree(written: Written, area: str) -> Drawing | None:
    """Decision tree of an area; none if it has too many ends to be read."""
    nodes = list(_nodes(written, area))
    years = [str(year) for year in written.file.stages.start]
    parents = [_parent(node, nodes) for node in nodes]
    heights = _heights(nodes, parents)
    ends = sum(node.stage == len(years) - 1 for node in nodes)
    if ends > MOST_ENDS:
        return None
    width_inch = max(WIDTH_INCH, STAGE_INCH * len(years))
    letters = int((END - BEGIN) * width_inch / len(years) * LETTERS_AN_INCH)
    texts = [_wrapped(node, letters) for node in nodes]
    lines = sum(max(len(each) for each in side) for side in zip(*texts, strict=True))
    items: list[Any] = []
    for node, y, parent, (above, below) in zip(nodes, heights, parents, texts, strict=True):
        items += _branch(node, y, None if parent is None else heights[parent])
        items += _written_at(node, y, above, below)
    items += list(_marks(nodes, heights))
    low, high = min(heights), max(heights)
    panel = Panel("", items, span=(high + 0.62, low - 0.5), bare=True)
    row_inch = LINE_INCH * lines + BETWEEN_INCH
    return Drawing(
        "in service from", [panel], (-0.5, len(years) - 0.42 + 0.12 * WIDTH_INCH / width_inch),
        panel_inch=row_inch * (high - low + 1.12), columns=years, width_inch=width_inch,
    )  # fmt: skip


def _branch(node: Node, y: float, before: float | None) -> Iterator[Curve]:
    """The way to a node, from the one before it if there is one."""
    width = 1.0 + 2.5 * node.probability
    begin, end = node.stage + BEGIN, node.stage + END
    yield Curve(np.array([begin, end]), np.array([y, y]), width=width)
    if before is not None:
        yield Curve(np.array([node.stage - 1 + END, begin]), np.array([before, y]), width=width)


def _written_at(node: Node, y: float, above: list[str], below: list[str]) -> Iterator[Words]:
    """What is written above and below the way to a node."""
    begin, built = node.stage + BEGIN, bool(node.built)
    yield Words(begin, y, "\n".join(above), ABOVE, BUILT if built else GREY, bold=built)
    yield Words(begin, y, "\n".join(below), BELOW, LIMITED if node.missed else STRONG_GREY)


def _marks(nodes: list[Node], heights: list[float]) -> Iterator[Any]:
    """A symbol at each node, and the futures at the ends."""
    for name, (symbol, colour) in RUN.items():
        own = [k for k, node in enumerate(nodes) if node.run == name]
        if own:
            x = np.array([nodes[k].stage + END for k in own])
            yield Places(x, np.array([heights[k] for k in own]), name, symbol, colour, ())
    last = max(node.stage for node in nodes)
    for node, y in zip(nodes, heights, strict=True):
        if node.stage == last:
            yield Words(node.stage + END + 0.02, y, "\n".join(node.futures), bold=True)


def _nodes(written: Written, area: str) -> Iterator[Node]:
    words = traffic_in_words(written.traffic[area]).full
    start = written.file.stages.start
    varied = _varied_prices(written)
    for row in written.rows("decisions", area):
        stage = start.index(int(row["in_service"]))
        asked, run = row["traffic_asked_for"], row["traffic_run"]
        futures = tuple(row["if"].split(" or "))
        chance = 100.0 * row["probability"]
        below = [f"{chance:.3g} %: {words.get(asked, asked)}"]
        own = written.futures[futures[0]].values
        below += [
            f"{varied_in_words(key)} {number(float(at_stage(own[key], stage)))}"
            for key in varied
            if key in own
        ]
        if run != asked:
            below.append(f"runs {words.get(run, run)}")
        ordered = row["ordered"]
        when = f" (ordered {int(ordered)})" if ordered == ordered and ordered < start[stage] else ""
        how = list(RUN)[0 if run == asked else 2 if run == NO_TRAFFIC else 1]
        yield Node(
            stage, futures, f"{row['builds']}{when}" if row["builds"] else "",
            row["configuration"], tuple(below), how, run != asked, row["probability"],
        )  # fmt: skip


def _varied_prices(written: Written) -> list[str]:
    """Prices that scenarios give values of their own."""
    keys = {key for future in written.futures.values() for key in future.values}
    return sorted(key for key in keys if key.split(".")[0] == PRICES)


def _parent(node: Node, nodes: list[Node]) -> int | None:
    """The node before a node: that of its futures, one stage earlier."""
    before = (k for k, each in enumerate(nodes) if each.stage == node.stage - 1)
    return next((k for k in before if node.futures[0] in nodes[k].futures), None)


def _heights(nodes: list[Node], parents: list[int | None]) -> list[float]:
    """Places of the nodes from above: ends in the order of their branches, others amid their own."""
    heights = [0.0] * len(nodes)
    children: dict[int | None, list[int]] = {}
    for k, parent in enumerate(parents):
        children.setdefault(parent, []).append(k)
    ends = iter(range(len(nodes)))

    def place(k: int) -> float:
        own = [place(child) for child in children.get(k, ())]
        heights[k] = 0.5 * (own[0] + own[-1]) if own else float(next(ends))
        return heights[k]

    for root in children[None]:
        place(root)
    return heights


def _wrapped(node: Node, letters: int) -> tuple[list[str], list[str]]:
    """Lines above and below a branch."""
    above = textwrap.wrap(node.built or f"stays {node.otherwise}", letters)
    below = [line for each in node.below for line in textwrap.wrap(each, letters)]
    return above, below
