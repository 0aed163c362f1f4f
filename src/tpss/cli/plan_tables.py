"""What ``tpss plan`` prints of an answer: sentences, decisions, first decisions, values."""

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

from rich.markup import escape
from rich.table import Table

from tpss.cli.terminal import Console, print_in_parts, say, width_of

if TYPE_CHECKING:
    import pandas as pd

    from tpss.planning.answer import Answer
    from tpss.planning.finer import Compared
    from tpss.planning.turning import Turn

MOST_WIDE = 20
"""Characters of a text in a line of a table that is too wide for the terminal."""

MOST_FIRSTS = 6
"""First decisions of an area that are printed."""


def print_answer(
    answer: "Answer",
    turns: Sequence["Turn"],
    finer: Sequence[Sequence["Compared"]],
    console: Console,
) -> None:
    """Print an answer: its sentences, what is done when, what else one could do, what it is worth."""
    from tpss.planning import tables
    from tpss.planning.finer import finer_sentences
    from tpss.planning.sentence import sentences
    from tpss.planning.uncounted import estimated, uncounted, unknown

    economics = answer.model.plan.file.economics
    unit = f"{economics.currency} of {economics.price_year}"
    for sentence in sentences(answer, turns):
        say(console, sentence)
    say(console, answer.claim)
    for line in (*finer_sentences(answer, finer), *unknown(answer.model)):
        say(console, line)
    if not answer.is_closed and answer.proof.holds:
        say(
            console,
            f"A better plan may cost {100 * answer.best.gap:.2g} % less: more time decides.",
        )
    decisions = tables.decisions(answer)
    several = decisions.area.nunique() > 1
    columns = {
        "area": "area", "ordered": "ordered", "in_service": "in service", "if": "if",
        "builds": "builds", "configuration": "configuration", "spent": "spent",
        "operation_per_year": "a year",
    }  # fmt: skip
    if not several:
        del columns["area"]
    print_frame(decisions, f"Decisions [{unit}]", columns, console)
    print_firsts(answer, console)
    values = tables.values(answer)[["meaning", "cost"]]
    print_frame(values, f"Values [{unit}, discounted]", {"meaning": "", "cost": ""}, console)
    if words := _mean_in_words(answer):
        say(console, words)
    if found := list(estimated(answer.model)):
        say(console, "By estimate: " + " ".join(found))
    say(console, "Not counted: " + " ".join(uncounted(answer.model)))


def _mean_in_words(answer: "Answer") -> str:
    """What the mean future is, if there is one."""
    from tpss.planning import tables
    from tpss.planning.wording import mean_in_words
    from tpss.planning.written import rows_of

    model = answer.model
    traffic = {
        area.name: {state.name: state for state in own.states.states}
        for area, own in zip(model.problem.areas, model.areas, strict=True)
    }
    return mean_in_words(rows_of(tables.mean_future(answer)), traffic)


def print_firsts(answer: "Answer", console: Console) -> None:
    """Print the best first decisions of each area."""
    from tpss.planning import tables

    firsts = tables.first_decisions(answer)
    columns = {"ordered": "ordered", "in_service": "in service", "configuration": "configuration",
               "cost": "cost", "surplus": "more"}  # fmt: skip
    if tables.KNOWN in firsts:
        columns[tables.KNOWN] = tables.KNOWN
    for (area, scenarios), group in firsts.groupby(["area", "if"], sort=False):
        title = f"First decisions of {area}"
        if firsts["if"].nunique() > 1:
            title += f", if {scenarios}"
        print_frame(group.head(MOST_FIRSTS), title, columns, console)


def print_frame(
    frame: "pd.DataFrame", title: str, columns: dict[str, str], console: Console
) -> None:
    """Print some columns of a table with their headings; in a narrow terminal, texts are broken."""
    first, *others = columns
    numeric = {
        name
        for name in columns
        if frame[name].map(lambda value: isinstance(value, int | float)).all()
    }

    def table_of(shown: Sequence[str], more: str, most_wide: int | None = None) -> Table:
        table = Table(title=escape(title + more), title_justify="left", box=None, pad_edge=False)
        for name in (first, *shown):
            if name in numeric:
                table.add_column(escape(columns[name]), justify="right", no_wrap=True)
            else:
                table.add_column(escape(columns[name]), overflow="fold", max_width=most_wide)
        for row in frame[[first, *shown]].itertuples(index=False):
            table.add_row(*(escape(_cell(value)) for value in row))
        return table

    if width_of(table_of(others, "")) <= console.width:
        console.print(table_of(others, ""))
    else:
        print_in_parts(others, partial(table_of, most_wide=MOST_WIDE), console)


def _cell(value: Any) -> str:
    if value is None or value != value:
        return "-"
    if isinstance(value, float) and not value.is_integer():
        return f"{value:,.1f}"
    is_year = isinstance(value, int | float) and 1900 <= value <= 2300 and float(value).is_integer()
    return (
        f"{int(value)}" if is_year else f"{value:,.1f}" if isinstance(value, float) else str(value)
    )
