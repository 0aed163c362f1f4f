"""The command ``tpss new``: an example scenario to start from."""

import shlex
from importlib.resources import files
from pathlib import Path

from tpss.errors import ResultError
from tpss.files.refusals import reason

TEMPLATE = ("scenario.toml", "gradients.csv")


def new_scenario(folder: Path) -> None:
    """Write the example into a folder, and print what to do with it.

    Raises
    ------
    ResultError
        One of its files exists already, or the folder cannot be written; nothing is written then.
    """
    template = files("tpss.cli").joinpath("template")
    texts = {folder / name: template.joinpath(name).read_bytes() for name in TEMPLATE}
    written: list[Path] = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for file, text in texts.items():
            with file.open("xb") as opened:  # never over a file that is there
                written.append(file)
                opened.write(text)
    except OSError as error:
        for file in written:
            file.unlink(missing_ok=True)
        if isinstance(error, FileExistsError):
            message = f"{error.filename} exists already and is not changed; name another folder"
        else:
            message = f"{folder} cannot be written: {reason(error)}; name another folder"
        raise ResultError(message) from error
    scenario = shlex.quote(str(folder / TEMPLATE[0]))
    print(f"Wrote {' and '.join(str(file) for file in texts)}.  Edit them, then run:\n")
    print(f"  tpss check {scenario}\n  tpss run {scenario}")
