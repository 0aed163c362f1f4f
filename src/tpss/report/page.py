"""What all pages share: templates that escape every text, style and script, and data for the script.

Jinja2 fills a page, because it escapes every name and text of a scenario; plotly draws, and its script
is part of the file, packed: as it is, it would be four fifths of it.  A page blocks all access to the
network.
"""

import base64
import json
from collections.abc import Mapping, Sequence
from functools import cache
from importlib.metadata import version
from importlib.resources import files
from typing import Any

import jinja2
from plotly.graph_objects import Figure

from tpss.printable import printable
from tpss.results.contents import REPORT_MARK
from tpss.units import kilometres


def fill(
    template: str,
    title: str,
    figures: Mapping[str, Figure],
    data: Mapping[str, Any],
    *,
    scripts: Sequence[str] = ("report.js",),
    **parts: Any,
) -> str:
    """Page of a template.

    Parameters
    ----------
    template : str
        File of the template.
    title : str
    figures : mapping of str to Figure
        Plots by the names of their elements.
    data : mapping
        What the scripts have to know besides.
    scripts : sequence of str
        Files of the scripts, in the order in which they run.
    **parts
        What else the template shows.
    """
    return (
        templates()
        .get_template(template)
        .render(
            generator=REPORT_MARK,
            version=version("tpss"),
            title=title,
            figures=figures,
            data=data,
            style=_part("report.css"),
            script="\n".join(map(_part, scripts)),
            plotly=_plotly() if figures else "",
            unpack=_part("unpack.js"),
            report_data=_for_script(figures, data),
            **parts,
        )
    )


def templates() -> jinja2.Environment:
    """Templates of pages, in which every text is escaped."""
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("tpss.report", "template"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        finalize=_shown,
    )
    environment.filters["kilometres"] = kilometres
    return environment


def _shown(value: Any) -> Any:
    """A value as a page shows it: of texts of others, what turns lines round is shown as its code."""
    is_of_others = isinstance(value, str) and not hasattr(value, "__html__")
    return printable(value, "\n\t") if is_of_others else value


@cache
def _plotly() -> str:
    """The script of the plots, packed by gzip, as base64."""
    packed = files("tpss.report") / "vendor" / "plotly.js.gz"
    return base64.b64encode(packed.read_bytes()).decode("ascii")


def _part(name: str) -> str:
    return (files("tpss.report") / "template" / name).read_text(encoding="utf-8")


def _for_script(figures: Mapping[str, Figure], data: Mapping[str, Any]) -> str:
    """The page's data as JSON that cannot end the script element which holds it."""
    drawn = ",".join(f"{json.dumps(key)}:{figure.to_json()}" for key, figure in figures.items())
    text = f'{{"plots":{{{drawn}}},"run":{json.dumps(data, separators=(",", ":"))}}}'
    return text.replace("<", "\\u003c")
