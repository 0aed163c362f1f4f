"""Load a geometry from its file."""

from pathlib import Path
from typing import Any

from tpss.conductors.faults import geometry_faults
from tpss.conductors.geometry import Geometry
from tpss.errors import Finding, ScenarioError
from tpss.scenario.files import read_toml
from tpss.scenario.validate import validate


def load_geometry(path: str | Path) -> Geometry:
    """Conductors of a line, from a TOML file.

    Raises
    ------
    ScenarioError
        The file cannot be read or has faults; all are listed.
    """
    source = Path(path)
    document = read_toml(source)
    if {"trains", "traffic"} <= document.keys():
        remedy = "run it with tpss run, or give the file with the conductors"
        raise ScenarioError([Finding(str(source), "", "", "a scenario, not conductors", remedy)])
    return geometry_of(document, source)


def geometry_of(document: dict[str, Any], source: Path) -> Geometry:
    """Geometry of a document with the keys of its file.

    Raises
    ------
    ScenarioError
        As `load_geometry`.
    """
    geometry = validate(Geometry, document, source)
    geometry._source = source
    findings = geometry_faults(geometry, str(source))
    if findings:
        raise ScenarioError(findings)
    return geometry
