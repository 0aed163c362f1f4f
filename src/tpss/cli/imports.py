"""The commands ``tpss import ...``."""

from pathlib import Path

from rich.console import Console

from tpss.cli.terminal import say
from tpss.importers.ttobench import Imported, read
from tpss.importers.ttobench_files import files, scenario_name, sections, write


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


def _report(part: Imported) -> list[str]:
    """Report on an imported file, as lines."""
    lines = [str(part.source)]
    for title, items in sections(part):
        lines += [f"  {title}:", *(f"    {item}" for item in items)]
    return lines
