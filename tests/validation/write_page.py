"""Write ``docs/validation.md`` and its figures from the case folders and a run of all of them.

``python tests/validation/write_page.py`` writes; with ``--check`` nothing is written, and the exit code
is 1 if the page is out of date or a figure is missing.
"""

import re
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from string import Template

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from cases import Case, Drawing, Quantity, load_cases
from drawings import DRAWINGS, overview
from outcomes import Outcome, compare_all, result_of

DOCS = Path(__file__).parents[2] / "docs"
PAGE = DOCS / "validation.md"
IMAGES = DOCS / "validation"
LARGEST_IMAGE = 100_000
TEMPLATE = Path(__file__).parent / "page.md"
GROUPS = {
    "Table": "Published tables",
    "Figure": "Published figures",
    "Closed form": "Closed forms and hand calculations",
}


def main() -> int:
    """Write or check the page; return the exit code."""
    cases = load_cases()
    outcomes = {case.name: compare_all(case) for case in cases}
    text = page(cases, outcomes)
    if sys.argv[1:] == ["--check"]:
        faults = stale(text, cases)
        print("\n".join(faults))
        return int(bool(faults))
    PAGE.write_text(text, "utf-8")
    draw(cases, outcomes)
    return 0


def stale(text: str, cases: Sequence[Case]) -> list[str]:
    """What of the committed page is out of date."""
    remedy = "run python tests/validation/write_page.py"
    faults = []
    if not PAGE.exists() or PAGE.read_text("utf-8") != text:
        faults.append(f"{PAGE.name} is out of date; {remedy}")
    wanted = {"overview.png"} | {name for case in cases for name, _ in images(case)}
    there = {file.name for file in IMAGES.glob("*")}
    faults += [f"validation/{name} is missing; {remedy}" for name in sorted(wanted - there)]
    faults += [f"validation/{name} belongs to no case; delete it" for name in there - wanted]
    large = [file.name for file in IMAGES.glob("*") if file.stat().st_size > LARGEST_IMAGE]
    faults += [f"validation/{name} is larger than {LARGEST_IMAGE} bytes" for name in large]
    return faults


def images(case: Case) -> Iterable[tuple[str, Drawing]]:
    """File name and drawing of each figure of a case."""
    stem = case.name.removeprefix("Boullanger_2009_").lower()
    for k, drawing in enumerate(case.expected.figures):
        yield f"{stem}{f'_{k + 1}' if k else ''}.png", drawing


def draw(cases: Sequence[Case], outcomes: dict[str, list[Outcome]]) -> None:
    """Write all figures."""
    IMAGES.mkdir(exist_ok=True)
    tables = [o for case in cases for o in outcomes[case.name] if kind(case) == "Table"]
    save(overview(tables), "overview.png")
    for case in cases:
        for name, drawing in images(case):
            runs = {
                run if len(drawing.variants) == 1 else f"{run}, {variant}": result_of(
                    case, run, variant
                )
                for run in drawing.runs
                for variant in drawing.variants
            }
            save(DRAWINGS[drawing.draw](runs, **drawing.arguments), name)


def save(figure: Figure, name: str) -> None:
    """Write a figure in 64 colours, which are enough for lines and halve its file."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    picture = Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB")
    picture.quantize(64).save(IMAGES / name, optimize=True)


def kind(case: Case) -> str:
    """Group to which a case belongs."""
    return next(word for word in GROUPS if word in case.name.replace("_", " "))


def page(cases: Sequence[Case], outcomes: dict[str, list[Outcome]]) -> str:
    """The page's text."""
    every = [outcome for case in cases for outcome in outcomes[case.name]]
    parts = []
    for word, heading in GROUPS.items():
        parts.append(f"## {heading}\n")
        parts += [section(case, outcomes[case.name]) for case in cases if kind(case) == word]
    template = Template(TEMPLATE.read_text("utf-8"))
    return template.substitute(totals=totals(every), sections="\n".join(parts).strip())


def totals(outcomes: Sequence[Outcome]) -> str:
    """How many values agree, and which do not."""
    judged = [outcome for outcome in outcomes if outcome.agrees is not None]
    missed = [outcome for outcome in judged if not outcome.agrees]
    shown = len(outcomes) - len(judged)
    lines = [
        f"**{len(judged) - len(missed)} of {len(judged)} values agree** within their tolerances; "
        f"{shown} more are shown only. The {len(missed)} that miss:",
        "",
    ]
    for outcome in missed:
        quantity, case = outcome.quantity, outcome.case
        lines.append(
            f"- [{case.title}](#{anchor(case.title)}): {quantity.name}, "
            f"{where(case, outcome.run, [outcome.variant])}: {with_unit(outcome.ours, quantity)} "
            f"where {stated(outcome.published, quantity)} is published"
        )
    return "\n".join(lines)


def where(case: Case, run: str, variants: Sequence[str]) -> str:
    """Run and, if there are several, variants."""
    return run if len(case.plan.variants) == 1 else f"{run}, profile {' and '.join(variants)}"


def section(case: Case, outcomes: Sequence[Outcome]) -> str:
    """Section of a case: provenance, table, reasons, misses, figures."""
    parts = [f"### {case.title}\n", f"{case.text}\n", table(case, outcomes), ""]
    parts += [f"- *{', '.join(names)}*, {rule}: {why}" for (rule, why), names in reasons(case)]
    parts.append("")
    for miss in case.expected.misses:
        place = where(case, miss.run, miss.variants)
        parts.append(f"**Miss** ({miss.quantity}, {place}). {miss.explanation}\n")
    for name, drawing in images(case):
        parts.append(f"![{case.title}](validation/{name})\n\n*{drawing.caption}*\n")
    return "\n".join(parts)


def table(case: Case, outcomes: Sequence[Outcome]) -> str:
    """Table of a case: a row for each quantity and run, a column for each variant."""
    variants = list(case.plan.variants)
    ours = [f"ours, {name}" for name in variants] if len(variants) > 1 else ["ours"]
    source = "by hand" if kind(case) == "Closed form" else "published"
    rows: dict[tuple[int, str], list[str]] = {}
    for outcome in outcomes:
        quantity = outcome.quantity
        start = [quantity.name, outcome.run, stated(outcome.published, quantity), rule(quantity)]
        row = rows.setdefault((id(quantity), outcome.run), [*start[:2], *map(unbroken, start[2:])])
        row.append(unbroken(cell(outcome)))
    head = ["quantity", "run", source, "tolerance", *ours]
    lines = [f"| {' | '.join(row)} |" for row in [head, *rows.values()]]
    return "\n".join([lines[0], f"|{'---|' * len(head)}", *lines[1:]])


def unbroken(text: str) -> str:
    """A text that stays on one line."""
    return text.replace(" ", "\N{NO-BREAK SPACE}")


def cell(outcome: Outcome) -> str:
    """Our value, its difference, and whether it agrees."""
    quantity = outcome.quantity
    text = number(outcome.ours, quantity)
    if quantity.bound is None:
        percent = quantity.in_percent
        text += f" ({signed(outcome.difference, 2 if percent else quantity.decimals)}"
        text += " %)" if percent else ")"
    return text + {True: " ✓", False: " **✗**", None: ""}[outcome.agrees]


def reasons(case: Case) -> Iterable[tuple[tuple[str, str], list[str]]]:
    """Every rule with its reason, and the quantities for which it stands."""
    grouped: dict[tuple[str, str], list[str]] = {}
    for quantity in case.expected.quantities:
        names = grouped.setdefault((rule(quantity), quantity.reason), [])
        if quantity.name not in names:
            names.append(quantity.name)
    return grouped.items()


def rule(quantity: Quantity) -> str:
    """The rule by which a quantity agrees, in a few characters."""
    if quantity.within is not None:
        return f"± {quantity.within:g} {unit(quantity)}".strip()
    if quantity.within_percent is not None:
        return f"± {quantity.within_percent:g} %"
    return {"at least": "not below", "at most": "not above"}.get(quantity.bound, "shown only")


def stated(published: float, quantity: Quantity) -> str:
    """The published value with its unit, and the sign of a bound."""
    sign = {"at least": "≥ ", "at most": "≤ "}.get(quantity.bound, "")
    return sign + with_unit(published, quantity)


def with_unit(value: float, quantity: Quantity) -> str:
    """A value with its unit."""
    return f"{number(value, quantity)} {unit(quantity)}".strip()


def number(value: float, quantity: Quantity) -> str:
    """A value with the quantity's decimals, never a negative zero."""
    return f"{round(value, quantity.decimals) + 0.0:.{quantity.decimals}f}"


def signed(value: float, decimals: int) -> str:
    """A difference with its sign."""
    return f"{round(value, decimals) + 0.0:+.{decimals}f}"


def unit(quantity: Quantity) -> str:
    """A quantity's unit as it is printed; empty for a pure number."""
    return "" if quantity.unit == "1" else quantity.unit


def anchor(heading: str) -> str:
    """Anchor that Markdown gives a heading."""
    return re.sub(r"\s+", "-", re.sub(r"[^\w\s-]", "", heading).strip().lower())


if __name__ == "__main__":
    sys.exit(main())
