"""XML documents of other formats, read without what makes XML dangerous."""

from pathlib import Path
from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

from tpss.errors import Finding, ScenarioError
from tpss.files.read import MEGABYTE, demand_readable
from tpss.files.refusals import reason

REMEDY = "correct the file, or name another one"

MOST_XML = 500 * MEGABYTE
"""Longest document that is read: networks of whole countries are shorter. [byte]"""

DEEPEST = 200
"""Elements within elements; no format has more."""


class _RefusedError(ValueError):
    """What is not read."""


def read_xml(path: Path) -> Element:
    """Root of an XML document; names of elements are without their namespaces.

    A document with a DOCTYPE is refused: it may define entities that grow, or lead to other files.

    Raises
    ------
    ScenarioError
        The file cannot be read, is not XML, or has a DOCTYPE.
    """
    builder = TreeBuilder()
    parser = expat.ParserCreate(namespace_separator=" ")
    depth = 0

    def start(name: str, attributes: dict[str, str]) -> None:
        nonlocal depth
        depth += 1
        if depth > DEEPEST:
            raise _RefusedError(f"more than {DEEPEST} elements within each other")
        builder.start(_local(name), {_local(key): value for key, value in attributes.items()})

    def end(name: str) -> None:
        nonlocal depth
        depth -= 1
        builder.end(_local(name))

    def doctype(*_: object) -> None:
        raise _RefusedError("it has a DOCTYPE, which is not read")

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.StartDoctypeDeclHandler = doctype
    parser.CharacterDataHandler = builder.data
    try:
        demand_readable(path, MOST_XML)
        with path.open("rb") as file:
            parser.ParseFile(file)
        return builder.close()
    except OSError as error:
        problem, place = f"the file cannot be read: {reason(error)}", ""
    except (expat.ExpatError, LookupError, _RefusedError) as error:  # of the encoding, the second
        problem, place = f"not XML as expected: {error}", f"line {parser.CurrentLineNumber}"
    raise ScenarioError([Finding(str(path), place, "", problem, REMEDY)])


def _local(name: str) -> str:
    return name.rpartition(" ")[2]
