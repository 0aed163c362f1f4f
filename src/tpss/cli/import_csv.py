"""The command ``tpss import csv``: shows how tables are understood, and writes them for a scenario."""

from collections.abc import Iterator
from pathlib import Path

from rich.markup import escape
from rich.table import Table as Grid

from tpss import units
from tpss.cli.terminal import Console, say
from tpss.importers.office_files import LINE, files
from tpss.importers.office_tables import (
    SHOWN,
    OfficeTable,
    decimal_named,
    demand_one_of_each,
    read_office_table,
)
from tpss.importers.texts import write
from tpss.tables.aliases import ALIASES
from tpss.tables.header import cell_of
from tpss.tables.kinds import KINDS
from tpss.tables.numbers import IN_WORDS


def import_tables(
    named: list[str], out: Path | None, decimal: str, smooth_over: float | None, force: bool
) -> None:
    """Print how tables are understood; with a folder, write what a scenario takes from them."""
    sign = decimal_named(decimal)
    tables = [read_office_table(each, sign, smooth_over) for each in named]
    demand_one_of_each(tables)
    texts = files(tables)
    written = [] if out is None else write(texts, out, force)
    console = Console()
    for each in tables:
        _show(each, console)
    if out is None:
        say(console, "Nothing is written; --out FOLDER writes:")
        for name in texts:
            say(console, f"  {name}")
        return
    say(console, "Written:")
    for path in written:
        say(console, f"  {path}")
    say(console, "Use it in a scenario:")
    for use in _uses(tables, out, LINE in texts):
        say(console, f"  {use}")


def _uses(tables: list[OfficeTable], out: Path, has_line: bool) -> Iterator[str]:
    """How a scenario names the files."""
    if has_line:
        yield f'line = "{out / LINE}"'
    for each in tables:
        if not has_line or " of the line" not in each.kind.used:
            yield each.kind.used.format(file=out / each.file)


def _show(each: OfficeTable, console: Console) -> None:
    """How a table is understood: its form, its columns, what is made of it, and notes."""
    table = each.table
    say(console, f"{table.path}: {each.kind.name}, {table.sheet.in_words}")
    grid = Grid(box=None, padding=(0, 2, 0, 0))
    for heading in ("  column", "meaning", "unit", "decimals", "lowest", "highest", "first"):
        grid.add_column(heading)
    for row in (*_columns(each), *_derived(each)):
        grid.add_row(*(escape(cell) for cell in row))
    console.print(grid, highlight=False)
    say(console, f"  {len(table)} rows, lines {table.rows[0].line} to {table.rows[-1].line}")
    for note in each.assumed:
        say(console, f"  Note: {note}")
    say(console, "")


def _columns(each: OfficeTable) -> Iterator[tuple[str, ...]]:
    """Cells of the rows that describe columns of the file."""
    table = each.table
    for name, column in table.header.columns.items():
        quantity = ALIASES[name]
        values = [value for value in table.values[name] if value is not None]
        texts = "".join(cell for row in table.rows if isinstance(cell := cell_of(row, column), str))
        shows = quantity.is_number and ("." in texts or "," in texts)
        decimals = IN_WORDS[table.signs[name]].removeprefix("decimal ") if shows else ""
        unit = units.label(quantity.key) if quantity.is_number else ""
        given = "" if column.meaning.factor == 1.0 else f", from {column.meaning.unit}"
        yield (
            f"  {column.heading}", quantity.words, f"{unit}{given}", decimals, *_ends(values),
        )  # fmt: skip
    for heading in table.header.passed_over:
        yield (f"  {heading}", "passed over", "", "", "", "", "")


def _derived(each: OfficeTable) -> Iterator[tuple[str, ...]]:
    """Cells of a row that describes gradients that are derived."""
    if "altitude" in each.table.values:
        values = each.made.columns["gradient_permille"]
        yield ("  derived", "gradient", "‰", "", *_ends(values))


def _ends(values: list[float | str]) -> tuple[str, str, str]:
    """Lowest, highest and first values in words."""
    first = ", ".join(_word(value) for value in values[:SHOWN])
    first += ", ..." if len(values) > SHOWN else ""
    numbers = [value for value in values if isinstance(value, float)]
    if not numbers:
        return "", "", first
    return _word(min(numbers)), _word(max(numbers)), first


def _word(value: float | str) -> str:
    return f"{value:.6g}" if isinstance(value, float) else value


def print_headings() -> None:
    """Print which headings are known, by kinds of tables."""
    console = Console()
    for kind in KINDS.values():
        say(console, f"{kind.name}: {kind.row}")
        for either in kind.needed:
            for name in either:
                _print_quantity(name, "needed" if len(either) == 1 else "one of these", console)
        for name in kind.further:
            _print_quantity(name, "may be there", console)
        say(console, "")


def _print_quantity(name: str, need: str, console: Console) -> None:
    quantity = ALIASES[name]
    written = ", ".join(each.split()[0] for each in quantity.units if each != "1")
    unit = f" [{written}]" if written else ""
    names = ", ".join(quantity.names)
    say(console, f"  {quantity.key} ({need}): {names}{unit}")
