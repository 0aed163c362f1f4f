"""The command ``tpss studio``: a scenario in the browser."""

from pathlib import Path

from tpss.cli.new import TEMPLATE, new_scenario
from tpss.extras import demand


def open_studio(file: Path, folder: Path | None, port: int, browse: bool, new: bool) -> None:
    """Serve a scenario to the browser until Ctrl-C.

    Raises
    ------
    ResultError
        Packages are missing, the port is taken, or the new folder has these files already.
    ScenarioError
        The file cannot be read.
    """
    demand("studio")
    if new:
        new_scenario(file)
        file = file / TEMPLATE[0]
    from tpss.studio.serve import serve

    def say(line: str) -> None:
        print(line, flush=True)

    serve(file, folder, port, browse, say)
