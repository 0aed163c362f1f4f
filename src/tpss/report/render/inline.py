"""Drawings as pictures within a page: SVG whose text is text, in the colours of the page.

Such a picture needs no script.  Its words are found, read aloud and copied as others of the page are,
and it is light or dark with it.
"""

import io
import re
from xml.etree import ElementTree

from matplotlib import rc_context

from tpss.report.drawings.parts import Drawing
from tpss.report.render import static

INK, PAPER = "#1a1a1a", "#ffffff"
"""Colours of what is written beside what is drawn, and of the gaps between areas."""

OF_PAGE = {
    INK: "var(--ink)",
    "#dddddd": "var(--rule)",
    "#444444": "var(--ink)",
    "#999999": "var(--soft)",
}
"""Colours of the page's style sheet that take the place of those of print."""

OF_TEXT = OF_PAGE | {"#0072b2": "var(--blue)", "#a63d00": "var(--red)"}
"""The same of text and of lines, which must stand out from the page; areas carry white words."""

STYLE = {
    "svg.fonttype": "none",
    "svg.hashsalt": "tpss",
    "figure.facecolor": "none",
    "axes.facecolor": "none",
    "savefig.facecolor": "none",
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
}

PX_PER_PT = 96.0 / 72.0

SMALLEST = 0.8
"""Share of its width to which a picture shrinks on a narrow screen, which scrolls then."""

NO_METADATA = dict.fromkeys(("Date", "Creator", "Format", "Type"))

SVG, XLINK = "http://www.w3.org/2000/svg", "http://www.w3.org/1999/xlink"
HREF = f"{{{XLINK}}}href"

NO_TURN = re.compile(r"rotate\(-?0 .*\)")
LONG = re.compile(r"(\d\.\d\d)\d+")
FAMILIES = re.compile(r"font-family: [^;]*(; |$)")
"""What a page does not need: turns by nothing, more than two decimals, and fonts of its own."""


def inline(drawing: Drawing, name: str, words: str) -> str:
    """Picture of a drawing as an element of a page.

    Parameters
    ----------
    drawing : Drawing
    name : str
        Tells its elements from those of other pictures of the page.
    words : str
        What it shows, for those who do not see it.
    """
    file = io.BytesIO()
    with rc_context(STYLE):  # type: ignore[arg-type]
        static.render(drawing).savefig(file, format="svg", metadata=NO_METADATA)
    root = ElementTree.fromstring(file.getvalue())
    root.remove(root[0])  # a style for all elements, which that of the page says too
    for element in root.iter():
        element.tag = element.tag.removeprefix(f"{{{SVG}}}")
        _rename(element, name)
        _shorten(element)
        if "style" in element.attrib:
            element.set("style", _of_page(element.attrib["style"], element.tag == "text"))
    width_px = float(root.attrib.pop("width").removesuffix("pt")) * PX_PER_PT
    del root.attrib["height"]
    size = f"width: {width_px:.0f}px; min-width: {SMALLEST * width_px:.0f}px"
    root.attrib |= {"role": "img", "aria-label": words, "style": size}
    return ElementTree.tostring(root, encoding="unicode", short_empty_elements=True)


def _rename(element: ElementTree.Element, name: str) -> None:
    """Make the names of elements those of one picture among several."""
    own = element.attrib
    if element.tag == "g":  # nothing refers to these
        own.pop("id", None)
    if "id" in own:
        own["id"] = f"{name}-{own['id']}"
    if HREF in own:
        own["href"] = own.pop(HREF).replace("#", f"#{name}-")
    for key in ("clip-path", "style"):
        if key in own:
            own[key] = own[key].replace("url(#", f"url(#{name}-")


def _shorten(element: ElementTree.Element) -> None:
    own = element.attrib
    if NO_TURN.fullmatch(own.get("transform", "")):
        del own["transform"]
    for key in ("d", "x", "y", "transform"):
        if key in own:
            own[key] = LONG.sub(r"\1", own[key])


def _of_page(style: str, is_text: bool) -> str:
    """A style with the colours and the font of the page."""
    style = FAMILIES.sub("", style)
    stands_out = is_text or "fill: none" in style
    for print_colour, page_colour in (OF_TEXT if stands_out else OF_PAGE).items():
        style = style.replace(print_colour, page_colour)
    return style.replace(f"stroke: {PAPER}", "stroke: var(--page)")
