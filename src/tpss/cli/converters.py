"""The command ``tpss converters``: switching converters by loading against all on."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tpss.cli.columns import Column, named_rows
from tpss.cli.run import DONE, PROGRESS, SEVERITY, exit_code
from tpss.cli.table_and_picture import demand_room, write_picture, write_table
from tpss.cli.tables import print_table
from tpss.cli.terminal import Console, announce_compilation, progress_bar, say

if TYPE_CHECKING:
    from tpss.converter_control.compare import Comparison
    from tpss.run.run import Progress


def run_converters(
    file: Path, assignments: list[str], out: Path | None, plot: Path | None, force: bool
) -> int:
    """Run a scenario with both controls; print and write what differs; return the exit code.

    Raises
    ------
    ScenarioError
        The scenario has faults, or describes no losses.
    ResultError
        A file cannot be written.
    """
    from tpss.converter_control.compare import compare_controls
    from tpss.report.drawings.converter_losses import losses_by_control
    from tpss.run.interrupt import interruptible
    from tpss.scenario import load_scenario
    from tpss.scenario.override import parse_assignment

    scenario = load_scenario(file, dict(parse_assignment(text) for text in assignments))
    demand_room(out, plot, force)
    console = Console(stderr=True)
    announce_compilation(console)
    with (
        interruptible() as interrupted,
        progress_bar(scenario.name, PROGRESS, _progress, console) as progress,
    ):
        found = compare_controls(scenario, progress, interrupted)
    codes = [exit_code(run) for run in found.runs.values()]
    if any(code != DONE for code in codes):
        for control, run in found.runs.items():
            told = run.summary.get("problem") or "; ".join(run.audit["failures"]) or run.status
            print(f'control = "{control}": {told}', file=sys.stderr)
        print("Both runs have to finish to be compared.", file=sys.stderr)
        return max(codes, key=SEVERITY.index)
    print_comparison(found, Console())
    if out is not None:
        write_table(out, found.table)
    if plot is not None:
        write_picture(plot, losses_by_control(found.runs))
    return DONE


def _progress(state: "Progress") -> dict[str, Any]:
    detail = f"{state.time_s / 60:.1f} min simulated, {state.trains} trains on the line"
    return {"completed": state.share, "total": 1.0, "detail": detail}


def print_comparison(found: "Comparison", console: Console) -> None:
    """Print both tables, and what all stations save."""
    rows = named_rows(found.table, "station")
    print_table("Losses of converter stations", "station", _STATIONS, rows, console)
    table, origins = found.table, found.by_loading.summary["converter_losses"]["origins"]
    saved, before = table.saved_mwh.sum(), table.all_on_mwh.sum()
    share = f" ({100.0 * saved / before:.1f} %)" if before > 0.0 else ""
    starts = f"{table.starts.sum():.0f} starts a day"
    by = f"; losses by {' and by '.join(origins)}" if origins else ""
    say(console, f"Converters lose {saved:.3f} MWh a day less{share}, with {starts}{by}")
    say(console, f"From the 50 Hz grid: {found.saved_at_the_grid_mwh:.3f} MWh a day less")
    if len(found.break_even):
        title = "One converter less loses less"
        print_table(title, "type", _BREAK_EVEN, named_rows(found.break_even, "type"), console)


_STATIONS = (
    Column("converters", "converters", "", 0),
    Column("all_on_mwh", "all on", "MWh/d", 3),
    Column("by_loading_mwh", "by loading", "MWh/d", 3),
    Column("saved_mwh", "saved", "MWh/d", 3),
    Column("starts", "starts", "1/d", 0),
    Column("peak_loading", "peak load", "%", 1, 100.0),
)

_BREAK_EVEN = (
    Column("converters", "converters", "", 0),
    Column("power_mva", "up to", "MVA", 2),
    Column("loading", "load of all", "%", 1, 100.0),
    Column("loading_of_one_less", "of one less", "%", 1, 100.0),
)
