"""The command ``tpss laws``: the laws of other packages that scenarios can name."""

from collections.abc import Sequence

from rich import box
from rich.markup import escape
from rich.table import Table

from tpss.cli.terminal import Console, say
from tpss.laws.kinds import KINDS
from tpss.laws.law import LawKind, Parameter, Quantity
from tpss.laws.registry import Registered, known_laws


def print_laws() -> None:
    """Print each kind of law with what it is given and finds, and the laws that there are.

    Raises
    ------
    LawError
        A package's laws cannot be imported, or two are of one name.
    """
    console = Console()
    laws = known_laws()
    for kind in KINDS.values():
        _print_kind(kind, [each for each in laws.values() if each.law.kind == kind], console)
    if not laws:
        say(console, 'No installed package offers laws, as entry points "tpss.laws".')


def _print_kind(kind: LawKind, laws: Sequence[Registered], console: Console) -> None:
    console.print(f"\n[bold]{kind.name}[/bold]  {kind.place}", highlight=False)
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False)
    for heading in ("", "name", "unit", "meaning"):
        table.add_column(heading, overflow="fold")
    for what, quantities in (("given", kind.given), ("found", kind.found)):
        for k, each in enumerate(quantities):
            table.add_row("" if k else what, *_row(each))
    console.print(table)
    for registered in laws:
        _print_law(registered, console)


def _row(quantity: Quantity) -> tuple[str, str, str]:
    return quantity.name, escape(quantity.unit), escape(quantity.describes)


def _print_law(registered: Registered, console: Console) -> None:
    law = registered.law
    console.print(f"\n  [bold]{escape(law.name)}[/bold]  {escape(law.describes)}", highlight=False)
    say(console, f"  of {registered.origin}, {law.digest}; {law.source}")
    for parameter in law.parameters:
        say(console, f"  {_in_words(parameter)}")


def _in_words(parameter: Parameter) -> str:
    """Name, meaning, range and default of a parameter."""
    default = "needed" if parameter.default is None else f"{parameter.default:g} if left out"
    reach = f"{parameter.least:g} to {parameter.most:g}"
    return f"{parameter.name}: {parameter.describes}; {reach}, {default}"
