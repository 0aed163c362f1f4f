"""The commands ``tpss import ...``."""

from datetime import date
from pathlib import Path

from tpss.cli.terminal import Console, say
from tpss.importers.network import ImportedNetwork
from tpss.importers.network_files import SCENARIO, TIMETABLE
from tpss.importers.network_files import files as network_texts
from tpss.importers.railml2 import ImportedTrains
from tpss.importers.texts import Told, comments, sections, write
from tpss.importers.timetable import csv_text
from tpss.importers.ttobench import Imported, read
from tpss.importers.ttobench_files import files, scenario_name


def import_ttobench(paths: list[Path], out: Path, force: bool) -> None:
    """Write scenario files from tracks and trains of TTOBench, and print what was done."""
    tracks, trains = read(paths)
    written = write(files(tracks, trains), out, force)
    console = Console()

    for part in (*tracks, *trains):
        say(console, "\n".join(_report(part)))
    say(console, "Written:")
    for path in written:
        say(console, f"  {path}")
    for track in tracks:
        for train in trains:
            say(console, f"Run it:  tpss run {out / scenario_name(track, train)}.toml")


def _report(part: Imported | ImportedTrains) -> list[str]:
    """Report on an imported file, as lines."""
    return [str(part.source), *_told(part)]


def _told(told: Told) -> list[str]:
    """What was taken, left out and assumed, as lines."""
    lines = []
    for title, items in sections(told):
        lines += [f"  {title}:", *(f"    {item}" for item in items)]
    return lines


def import_osrd(
    infra: Path, trains: Path | None, stock: list[Path], out: Path, force: bool
) -> None:
    """Write lines, a timetable and a scenario from files of OSRD, and print what was done."""
    from tpss.importers.osrd import read as read_osrd

    _write_network(read_osrd(infra, trains, stock), out, force)


def import_gtfs(feed: Path, routes: list[str], day: date | None, out: Path, force: bool) -> None:
    """Write lines, a timetable and a scenario from routes of a GTFS feed, and print what was done."""
    from tpss.importers.gtfs import read as read_gtfs

    _write_network(read_gtfs(feed, routes, day), out, force)


def import_railml(file: Path, out: Path, force: bool) -> None:
    """Write lines, a timetable, or both, from a file of railML, and print what was done."""
    from tpss.importers.railml import read as read_railml

    found = read_railml(file)
    if isinstance(found, ImportedNetwork):
        _write_network(found, out, force)
        return
    head = comments(f"Imported from {file.name} of railML 2.", found).rstrip("\n") + "\n"
    written = write({TIMETABLE: csv_text(found.trains, head)}, out, force)
    console = Console()
    say(console, "\n".join(_report(found)))
    say(console, "Written:")
    for path in written:
        say(console, f"  {path}")


def _write_network(network: ImportedNetwork, out: Path, force: bool) -> None:
    written = write(network_texts(network), out, force)
    console = Console()
    lines = [", ".join(str(path) for path in network.sources)]
    say(console, "\n".join([*lines, *_told(network)]))
    say(console, "Written:")
    for path in written:
        say(console, f"  {path}")
    say(console, f"Complete it, then check it:  tpss check {out / SCENARIO}")
