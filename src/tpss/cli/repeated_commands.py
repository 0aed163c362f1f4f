"""The commands that run a scenario several times, to say what a change of it does."""

from pathlib import Path
from typing import Annotated

import typer

from tpss.cli.arguments import Assignments, Force, Library, Quiet, ScenarioFile, flag, option


def outages(
    file: ScenarioFile,
    n_1: Annotated[
        bool,
        flag(
            "--n-1",
            help="Also take out each single element: every station, every station with one unit fewer, "
            "every transformer of the high-voltage line, every autotransformer, every store at the "
            "line, every closed post and section break, every feed of a station with several. Not the "
            "contact line, which rules of n-1 exempt: sections of it are outages of the scenario.",
        ),
    ] = False,
    set_: Assignments = None,
    _library: Library = None,
    jobs: Annotated[
        int | None, option(min=1, help="Runs at a time; by default one per core.")
    ] = None,
    out: Annotated[
        Path | None,
        option(help="CSV file to write; by default results/NAME-outages-NNN.csv."),
    ] = None,
    report: Annotated[
        bool,
        flag("--report", help="Also write a report with the table, beside the CSV file, in HTML."),
    ] = False,
    force: Force = False,
    quiet: Quiet = False,
) -> None:
    """Run a scenario with each of its outages, and rank what they do in one table.

    An outage is a table `[[outages]]` of the scenario: stations, units, transformers or sections of
    contact line that are out of service, and switches that are open, throughout the run or from
    `from_min` to `to_min`. The first row is the intact supply; the outages follow, those that do not
    solve first, then by the limits that they violate, then by their mean useful voltage. In brackets
    stands what differs from the intact supply; late and lost count against it too. The CSV file holds
    more: trains, times, windows of loading, differences.

    Exit codes: 0 done, 2 bad input, 3 a run did not solve, a train stalled or trains deadlocked, 4 the
    audit of a run failed, 130 interrupted (the table holds the runs that were done).
    """
    from tpss.cli.outages import run_outages

    raise typer.Exit(run_outages(file, n_1, set_ or [], jobs, out, force, quiet, report))


def converters(
    file: ScenarioFile,
    set_: Assignments = None,
    _library: Library = None,
    out: Annotated[Path | None, option(help="CSV file to write.")] = None,
    plot: Annotated[
        Path | None,
        option(
            help="Picture of the losses over time to write, of which the end says the kind: png, svg, "
            "pdf."
        ),
    ] = None,
    force: Force = False,
) -> None:
    """Tell what switching converters by their loading saves, against leaving all of them on.

    The scenario is run twice, with `control = "all-on"` and with `control = "loading"` at every
    converter station. The table has the losses of each station in a day of this traffic, what is saved,
    and how often converters start. A second one, which follows from the losses alone, says up to which
    power a station loses less with one converter less. The types of converters need `losses`.

    Exit codes: 0 done, 2 bad input, 3 a run did not solve or a train stalled, 4 the audit of a run
    failed, 130 interrupted.
    """
    from tpss.cli.converters import run_converters

    raise typer.Exit(run_converters(file, set_ or [], out, plot, force))


def spare_time(
    file: ScenarioFile,
    percent: Annotated[
        list[float] | None,
        option(
            min=0,
            max=200,
            help="Time to spare, in percent of the technical running time; repeatable. By default 2, "
            "5, 10, 15 and 20.",
        ),
    ] = None,
    set_: Assignments = None,
    _library: Library = None,
    out: Annotated[Path | None, option(help="CSV file to write.")] = None,
    plot: Annotated[
        Path | None, option(help="Picture to write, of which the end says the kind: png, svg, pdf.")
    ] = None,
    force: Force = False,
) -> None:
    """Print how much energy trains save by using time that they have to spare.

    A train that has more time from stop to stop than it needs can hold a lower speed, coast before it
    brakes, or do both with the least energy. Each service is tried alone and at nominal voltage; the
    key `spare_time` of a service lets its trains drive so in a run.
    """
    from tpss.cli.spare_time import print_savings

    print_savings(file, percent or [], set_ or [], out, plot, force)
