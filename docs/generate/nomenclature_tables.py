"""The nomenclature, in which the table of the result's variables follows from the program."""

import re
from pathlib import Path

from markdown_pieces import table

from tpss.step.recorded import RECORDED, Recorded

PAGE = Path(__file__).parents[1] / "nomenclature.md"
PART = re.compile(r"(?<=<!-- `python docs/generate` -->\n\n).*?(?=\n\n<!-- end -->)", re.DOTALL)
HEAD = ("symbol", "name", "meaning", "unit", "kind", "dimensions")


def page() -> str:
    """Text of the page with the table as it has to be."""
    variables = table(HEAD, map(_row, RECORDED))
    return PART.sub(lambda _: variables, PAGE.read_text("utf-8"))


def _row(each: Recorded) -> tuple[str, ...]:
    flags = ", ".join(f"{value} {meaning}" for value, meaning in enumerate(each.flags))
    return (
        f"${each.symbol}$" if each.symbol else "",
        f"`{each.name}`",
        "; ".join(filter(None, (each.words, each.remark, flags))),
        "code" if each.flags else each.unit.replace("s2", "s²"),
        "state" if each.at_instant else "interval",
        ", ".join(each.dimensions),
    )
