"""The command ``tpss new``: a scenario to start from, small and commented, or one of the examples."""

import shlex
import tomllib
from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path

from tpss import examples
from tpss.cli.terminal import tell
from tpss.errors import ResultError
from tpss.files.refusals import reason

TEMPLATE = ("scenario.toml", "gradients.csv")

LIST = "list"
"""Name in place of that of an example that lists all."""

NEXT = {
    "conductors": ("tpss line-constants {file}",),
    "measures": ("tpss plan check {file}", "tpss plan run {file} --out {name}"),
    "vary": ("tpss sweep {file} --dry-run", "tpss sweep {file} --out {name}"),
    "": ("tpss check {file}", "tpss run {file}"),
}
"""What to do next with a file by a table that tells its kind; last what is of scenarios."""


def list_examples() -> None:
    """Print the names of all examples, and what each is."""
    from tpss.cli.terminal import Console, say

    console = Console()
    known = examples.names()
    width = max(map(len, known))
    for name, sentence in known.items():
        say(console, f"{name:{width}}  {sentence}")


def new_scenario(folder: Path, example: str | None = None) -> None:
    """Write a scenario, or an example with the files that it refers to, and print what to do with it.

    Parameters
    ----------
    folder : Path
    example : str, optional
        Name of an example; by default a line of 60 km with comments.

    Raises
    ------
    ResultError
        There is no such example, one of the files exists already, or the folder cannot be written;
        nothing is written then.
    """
    if example is None:
        template = files("tpss.cli").joinpath("template")
        contents = {name: template.joinpath(name).read_bytes() for name in TEMPLATE}
    else:
        contents = {place: file.read_bytes() for place, file in examples.files_of(example).items()}
    _write({folder / place: content for place, content in contents.items()}, folder)
    first = next(iter(contents))
    listed = " and ".join(str(folder / place) for place in contents)
    tell(f"Wrote {listed}.  Edit {'it' if len(contents) == 1 else 'them'}, then run:\n")
    document = tomllib.loads(contents[first].decode())
    calls = next(calls for kind, calls in NEXT.items() if kind in document or not kind)
    for call in calls:
        print("  " + call.format(file=shlex.quote(str(folder / first)), name=Path(first).stem))


def _write(contents: Mapping[Path, bytes], folder: Path) -> None:
    """Write new files, all of them or none."""
    written: list[Path] = []
    try:
        for file, content in contents.items():
            file.parent.mkdir(parents=True, exist_ok=True)
            with file.open("xb") as opened:  # never over a file that is there
                written.append(file)
                opened.write(content)
    except OSError as error:
        for file in written:
            file.unlink(missing_ok=True)
        if isinstance(error, FileExistsError):
            message = f"{error.filename} exists already and is not changed; name another folder"
        else:
            message = f"{folder} cannot be written: {reason(error)}; name another folder"
        raise ResultError(message) from error
