"""The commands ``tpss import ...``."""

from pathlib import Path

from rich.console import Console

from tpss.importers.ttobench import Imported, read
from tpss.importers.ttobench_files import files, scenario_name, sections, write


def import_ttobench(paths: list[Path], out: Path, force: bool) -> None:
    """Write what tracks and trains of TTOBench give into a folder, and print what was done."""
    tracks, trains = read(paths)
    written = write(files(tracks, trains), out, force)
    console = Console()

    def say(text: str) -> None:
        console.print(text, highlight=False, soft_wrap=True, markup=False)

    for part in (*tracks, *trains):
        say("\n".join(_account(part)))
    say("Written:")
    for path in written:
        say(f"  {path}")
    for track in tracks:
        for train in trains:
            say(f"Run it:  tpss run {out / scenario_name(track, train)}.toml")


def _account(part: Imported) -> list[str]:
    """What became of a file, as lines."""
    lines = [str(part.source)]
    for title, items in sections(part):
        lines += [f"  {title}:", *(f"    {item}" for item in items)]
    return lines
