"""The command ``tpss plan report``."""

from pathlib import Path

from tpss.cli.terminal import tell
from tpss.extras import demand


def report_plan(folder: Path, out: Path | None, force: bool) -> None:
    """Write a report of a plan that was solved, and print where it is.

    Raises
    ------
    PlanError
        It is no folder of a plan that was solved, or something in it is missing or damaged.
    ResultError
        The file exists, or cannot be written.
    """
    demand("plan report", "plan")
    from tpss.planning.report import write_plan_report

    tell(f"Wrote {write_plan_report(folder, out, force=force)}")
