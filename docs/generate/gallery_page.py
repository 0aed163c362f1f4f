"""The page of the gallery: every figure with the commands that draw it.

`docs/pictures.py` runs the same commands to draw the pictures.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

from tpss import examples
from tpss.planning.figures.catalogue import FIGURES as OF_A_PLAN
from tpss.report.figures import FIGURES as OF_A_RESULT
from tpss.sweep.figures import FIGURES as OF_A_STUDY

USUAL_EXAMPLE = "thesis-3-7-2"
EXAMPLES = {
    "network": "network",
    "train-voltage": "emu-25kv",
    "converter-losses": "line-320km-losses",
    "unbalance": "neutral-section-25kv",
    "braking": "metro-750v",
    "storage": "tram-750v",
    "thermal": "freight-3kv",
    "rails": "hs-2x25kv",
}
"""Scenarios of the figures that show more, or anything at all, of another one than the usual one."""

STUDY, PLAN = "study-converters", "plan-320km"

INTRODUCTION = """# Gallery

Every figure that TPSS draws, and what draws it, from the examples that come with it.
[Draw figures](how-to/draw-figures.md) says what can be chosen: a train, a stretch, a format;
[read the report](how-to/read-the-report.md) shows them as one page on which trains move."""

FROM_PYTHON = """## From Python

`draw` makes any figure of a result by its name, as a matplotlib figure:

```python
import tpss
from tpss.report.figures import draw

result = tpss.simulate(tpss.load_scenario(tpss.examples.path("thesis-3-7-2")))
draw("journey", result).savefig("journey.png")
```"""


class Shown(NamedTuple):
    """A figure of the gallery."""

    name: str
    shows: str
    calls: tuple[str, ...]
    """Commands that draw it, or write the report in which it stands."""

    @property
    def picture(self) -> str:
        """Its picture, from the folder of the documentation."""
        return f"gallery/{self.name}.png"


def of_results() -> list[Shown]:
    """Figures of results."""
    return [
        Shown(name, figure.shows, _drawn(name, EXAMPLES.get(name, USUAL_EXAMPLE), "run"))
        for name, figure in OF_A_RESULT.items()
    ]


def of_studies() -> list[Shown]:
    """Figures of studies."""
    return [
        Shown(name, _first_line(describe), _drawn(name, STUDY, "sweep"))
        for name, describe in OF_A_STUDY.items()
    ]


def of_plans() -> list[Shown]:
    """Figures of plans, which stand in a report."""
    calls = (*_made(PLAN, "plan run"), f"tpss plan report {result_of(PLAN)}")
    return [Shown(name, figure.text, calls) for name, figure in OF_A_PLAN.items()]


def result_of(example: str) -> str:
    """Folder into which the commands write what comes of an example."""
    return f"{example}/result"


def _drawn(name: str, example: str, command: str) -> tuple[str, ...]:
    plot = f"tpss plot {result_of(example)} --figure {name} --out {name}.png"
    return (*_made(example, command), plot)


def _made(example: str, command: str) -> tuple[str, str]:
    file = f"{example}/{examples.path(example).name}"
    new = f"tpss new {example} --from {example}"
    return new, f"tpss {command} {file} --out {result_of(example)}"


def _first_line(function: Callable[..., Any]) -> str:
    return (function.__doc__ or "").partition("\n")[0]


KINDS = {
    "Of a result": of_results,
    "Of a study": of_studies,
    "Of a plan": of_plans,
}
"""Headings of the page, and the figures below them."""


def page() -> str:
    """Text of the page."""
    blocks = [INTRODUCTION]
    for heading, figures in KINDS.items():
        blocks.append(f"## {heading}")
        for figure in figures():
            shows = figure.shows[0].upper() + figure.shows[1:].rstrip(".")
            calls = "\n".join(figure.calls)
            picture = f"![Example of the figure {figure.name}]({figure.picture})"
            blocks += [f"### {figure.name}", f"{shows}.", picture, f"```bash\n{calls}\n```"]
    return "\n\n".join([*blocks, FROM_PYTHON])
