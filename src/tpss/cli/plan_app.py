"""Arguments and options of ``tpss plan``."""

from pathlib import Path
from typing import Annotated

import typer

from tpss.cli.arguments import Force, Library, Quiet, argument, option
from tpss.cli.commands import Commands

app = typer.Typer(
    cls=Commands,
    help="Plan investments in the power supply: what to build, where and when, under uncertain traffic.",
    no_args_is_help=True,
    rich_markup_mode="markdown",
)

PlanToml = Annotated[Path, argument(metavar="PLAN", help="Plan file (TOML).")]

PlanFolder = Annotated[Path, argument(metavar="DIR", help="Folder written by tpss plan run.")]

Changes = Annotated[
    list[str] | None,
    option(
        "--set",
        metavar="KEY=VALUE",
        help="Set one value of the plan, such as economics.energy_per_kwh=1e-6; repeatable.",
    ),
]

Gap = Annotated[
    float,
    typer.Option(
        min=0.0,
        max=1.0,
        help="With a budget: share of the cost within which a better plan is not looked for.",
    ),
]

TimeLimit = Annotated[
    float | None,
    option(
        "--time-limit",
        min=0.1,
        metavar="S",
        help="With a budget: seconds for each search of a plan.",
    ),
]


@app.command(
    epilog="Example:  tpss plan check plan_320km.toml (after tpss new . --from plan-320km)"
)
def check(file: PlanToml, _library: Library = None) -> None:
    """List every fault of a plan, or print what it consists of, without simulating its cases.

    Every configuration is built. What is printed: the scenarios and when they part, the number of
    configurations, cases and plans, the time that the cases take, and prices without a source.

    Exit codes: 0 the plan has no fault, 2 it has some; each is listed with its place and its remedy.
    """
    from tpss.cli.plan import check_plan

    raise typer.Exit(check_plan(file))


@app.command(epilog="Example:  tpss plan run plan_320km.toml --out ore-line")
def run(
    file: PlanToml,
    out: Annotated[
        Path,
        typer.Option(help="Folder for cases and answer; what it holds is not simulated again."),
    ],
    workers: Annotated[
        int | None, option(min=1, help="Cases at a time; by default one per core.")
    ] = None,
    scheduler: Annotated[
        str | None,
        option(
            metavar="ADDRESS",
            help="Dask scheduler whose workers simulate, such as tcp://10.0.0.1:8786; by default this "
            "computer does.",
        ),
    ] = None,
    gap: Gap = 1e-9,
    time_limit: TimeLimit = None,
    all_: Annotated[
        bool,
        option(
            "--all",
            help='Simulate every case, also of a plan that is proved by bounds (by = "bounds" or '
            '"approximator").',
        ),
    ] = False,
    _library: Library = None,
    quiet: Quiet = False,
) -> None:
    """Simulate the cases of a plan, find the best plan of all, and write it with its tables.

    Of a plan with `by = "bounds"` or `"approximator"` only those cases are simulated that prove it to be
    the best one, if no case costs less than its bound. That is tested on every simulated case.

    After an interruption of any kind the same command continues, and simulates no case twice; so it
    does after a change of the plan.

    Exit codes: 0 done, 2 bad input, or no plan meets the budget, 3 no plan meets the requirements,
    4 the audit of a case failed, 5 a better plan may exist: the time was over, or a bound did not hold,
    130 interrupted (finished cases are kept).
    """
    from tpss.cli.plan import run_plan

    raise typer.Exit(run_plan(file, out, workers, scheduler, gap, time_limit, all_, quiet))


@app.command(
    epilog="Examples:  tpss plan price ore-line --set economics.energy_per_kwh=1e-6, then "
    "tpss plan price ore-line --sweep measures.AT.cost=800:1200"
)
def price(
    folder: PlanFolder,
    set_: Changes = None,
    sweep: Annotated[
        list[str] | None,
        option(
            metavar="KEY=LOW:HIGH",
            help="Print where the first decision turns between two values of a price, of the cost of a "
            "measure, of the discount rate or of a probability; repeatable.",
        ),
    ] = None,
    gap: Gap = 1e-9,
    time_limit: TimeLimit = None,
    _library: Library = None,
) -> None:
    """Price a plan anew, without a simulation, and print its best first decisions.

    Nothing is written.

    Exit codes: 0 done, 2 bad input, 5 a better plan may exist: the time was over.
    """
    from tpss.cli.plan_questions import price_plan

    raise typer.Exit(price_plan(folder, set_ or [], sweep or [], gap, time_limit))


@app.command(epilog="Example:  tpss plan why ore-line 'AT in 2030'")
def why(
    folder: PlanFolder,
    question: Annotated[
        str,
        argument(
            metavar="QUESTION",
            help="Measures and the year in which they are ordered, such as 'AT in 2030', 'B+D in 2030', "
            "or of several areas 'north: AT in 2030'.",
        ),
    ],
    set_: Changes = None,
    _library: Library = None,
) -> None:
    """Print what the best plan costs that contains some measures, and where the difference comes from.

    Also which traffic they do not carry alone, and which requirement that is due to.

    Exit codes: 0 done, 2 bad input, 3 there is no such plan.
    """
    from tpss.cli.plan_questions import why_not

    raise typer.Exit(why_not(folder, question, set_ or []))


@app.command(epilog="Example:  tpss plan report ore-line")
def report(
    folder: PlanFolder,
    out: Annotated[
        Path | None,
        typer.Option(
            help="HTML file to write; by default report.html in the folder.", metavar="FILE"
        ),
    ] = None,
    force: Force = False,
) -> None:
    """Write a report of a plan that was solved into one HTML file, as of its results.

    It opens with the answer in one sentence, what may be claimed of it, and what is not counted;
    then come figures and tables. Nothing is simulated or solved, and the plan's own files are not read.

    Exit codes: 0 done, 2 no folder of a solved plan, or the file exists.
    """
    from tpss.cli.plan_report import report_plan

    report_plan(folder, out, force)
