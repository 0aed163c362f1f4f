"""Files of railML: infrastructure of versions 2 and 3, trains of version 2."""

from pathlib import Path

from tpss.errors import Finding, ScenarioError
from tpss.importers import railml2_network, railml3
from tpss.importers.network import ImportedNetwork
from tpss.importers.railml2 import ImportedTrains, trains_of
from tpss.importers.railml2_topology import tracks_with_topology
from tpss.importers.railml_file import RailmlFile


def read(path: Path) -> ImportedNetwork | ImportedTrains:
    """Lines of a file, with its trains; or its trains alone if its tracks have no beginnings and ends.

    Raises
    ------
    ScenarioError
        The file cannot be read, is of another format, is empty, or has faults.
    """
    file = RailmlFile(path)
    if file.version.startswith("3"):
        return railml3.network_from(file)
    if tracks_with_topology(file):
        return railml2_network.network_from(file)
    if file.count("trainPart", "train"):
        return trains_of(file)
    problem = "the infrastructure is empty: there is no track with a trackBegin and a trackEnd"
    remedy = "export the infrastructure with the topology of its tracks, or a timetable"
    raise ScenarioError([Finding(str(path), "infrastructure, tracks", "", problem, remedy)])
