"""Load a scenario from its file."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from tpss.errors import Finding, ScenarioError
from tpss.scenario.files import read_toml
from tpss.scenario.override import override
from tpss.scenario.own_library import using
from tpss.scenario.scenario import Scenario


def demand_no_scenario(document: Mapping[str, Any], source: Path, what: str) -> None:
    """Refuse a scenario where a document that starts from one is asked for.

    Parameters
    ----------
    document : mapping
        As it was written.
    source : Path
        Its file.
    what : str
        What is asked for, such as a study.

    Raises
    ------
    ScenarioError
    """
    if {"trains", "traffic"} <= document.keys():
        remedy = f"run it with tpss run, or name it in {what}"
        raise ScenarioError([Finding(str(source), "", "", f"a scenario, not {what}", remedy)])


def load_scenario(
    path: str | Path,
    changes: Mapping[str, Any] | None = None,
    *,
    library: str | Path | None = None,
) -> Scenario:
    """Scenario of a TOML file, with the CSV files that it names.

    Parameters
    ----------
    path : path
        The scenario file.
    changes : mapping of str to value, optional
        Values to set by key path before validation, as in `Scenario.with_`.
    library : path, optional
        Folder with a library of one's own, which changed copies of the scenario use too; by default
        that of ``TPSS_LIBRARY``, or else the user's.

    Raises
    ------
    ScenarioError
        The file, or a file that it names, cannot be read or has faults; all are listed.
    """
    if library is not None:
        with using(library):
            return load_scenario(path, changes)
    source = Path(path)
    document = read_toml(source)
    if {"scenario", "design"} <= document.keys():
        remedy = "run it with tpss sweep, or name the scenario that it varies"
        raise ScenarioError([Finding(str(source), "", "", "a study, not a scenario", remedy)])
    if {"stages", "economics"} <= document.keys():
        remedy = "run it with tpss plan, or name the scenario that it starts from"
        raise ScenarioError([Finding(str(source), "", "", "a plan, not a scenario", remedy)])
    if "conductors" in document:
        remedy = "make a catenary of them: tpss line-constants FILE --out catenary.toml"
        raise ScenarioError([Finding(str(source), "", "", "conductors, not a scenario", remedy)])
    return Scenario.from_own_document(override(document, changes or {}, source), source)
