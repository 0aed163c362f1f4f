"""The command ``tpss studio``: a scenario in the browser."""

from pathlib import Path

from tpss.extras import demand


def open_studio(file: Path, folder: Path | None, port: int, browse: bool) -> None:
    """Serve a scenario to the browser until Ctrl-C.

    Raises
    ------
    ResultError
        Packages are missing, or the port is taken.
    ScenarioError
        The file cannot be read.
    """
    demand("studio")
    from tpss.studio.serve import serve

    def say(line: str) -> None:
        print(line, flush=True)

    serve(file, folder, port, browse, say)
