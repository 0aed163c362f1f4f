"""Run a scenario with each of its outages, in threads, and rank what they come to."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import pandas as pd

from tpss.api import Prepared, prepare
from tpss.errors import ScenarioError
from tpss.extras import demand
from tpss.many import in_threads
from tpss.model.legs import build_legs
from tpss.model.outages import layout_of, service_of
from tpss.model.relays import with_relays
from tpss.outages.cases import outages_of
from tpss.outages.row import FIGURES, Row, Verdict, lost_against, row_of
from tpss.run.run import INTERRUPTED
from tpss.scenario.outages import Outage
from tpss.scenario.scenario import Scenario

INTACT = "intact"
"""Names the supply with all in service, in a table of outages."""


@dataclass(frozen=True)
class Comparison:
    """Rows of a table of outages: the intact supply first, then the outages, the gravest first."""

    rows: tuple[Row, ...]
    cases: int
    """How many there are if it was not interrupted."""
    scenario: Scenario
    """With the step that was chosen, if it gave none."""

    @property
    def intact(self) -> Row:
        """The row to which the others are compared."""
        return self.rows[0]

    def table(self) -> pd.DataFrame:
        """One row per case: verdict, figures, and their differences to those of the intact supply."""
        return pd.DataFrame([_flat(row, self.intact) for row in self.rows])

    def write_report(self, file: str | Path, *, force: bool = False) -> Path:
        """Write a report into one HTML file, and return the file.

        Parameters
        ----------
        file : path
            File to write.
        force : bool
            Whether a report that is there may be replaced.

        Raises
        ------
        ResultError
            The file exists, or cannot be written.
        """
        demand("report")
        from tpss.outages.report import write_outages_report  # which takes long to import

        return write_outages_report(self, file, force=force)


def compare_outages(
    scenario: Scenario,
    *,
    every: bool = False,
    threads: int | None = None,
    report: Callable[[int, int], None] | None = None,
    interrupted: Sequence[int] | None = None,
) -> Comparison:
    """Run a scenario with the intact supply and with each of its outages.

    Parameters
    ----------
    scenario : Scenario
        Without a time step, that of the intact supply is chosen for all.
    every : bool
        Whether each single element is taken out too, see `outages.cases.single_outages`.
    threads : int, optional
        Number of threads; by default one for each core.
    report : callable, optional
        Called after each run with the number of those that are done, and of all.
    interrupted : sequence of int, optional
        Runs end early once it is filled; the rows of those that are done are given.

    Raises
    ------
    ScenarioError
        There is no outage.
    """
    outages: list[Outage | None] = [None, *outages_of(scenario, every)]
    prepared = prepare(scenario.with_({"simulation.outage": None}))
    rows: list[Row] = []

    def work(outage: Outage | None) -> Row | None:
        return None if interrupted else _run(prepared, outage, interrupted)

    for done, row in enumerate(in_threads(work, outages, threads), start=1):
        if row is not None:
            rows.append(row)
        elif done == 1:  # there is nothing to compare with
            break
        if report is not None:
            report(done, len(outages))
    ranked = sorted(rows[1:], key=lambda row: row.rank)
    lost = [replace(row, lost=lost_against(row, rows[0])) for row in (*rows[:1], *ranked)]
    return Comparison(tuple(lost), len(outages), prepared.scenario)


def _run(
    prepared: Prepared, outage: Outage | None, interrupted: Sequence[int] | None
) -> Row | None:
    """Row of a run, None of one that was interrupted."""
    if outage is None:
        name, out, case = INTACT, "", prepared
    else:
        name, out = outage.name, outage.in_words
        try:
            case = with_outage(prepared, outage)
        except ScenarioError:
            return Row(name, out, Verdict.NOT_FED, ended_min=0.0)
    result = case.run(interrupted=interrupted)
    return None if result.status == INTERRUPTED else row_of(name, out, result)


def with_outage(prepared: Prepared, outage: Outage) -> Prepared:
    """A run of the same trains, in the same steps, with an outage.

    Raises
    ------
    ScenarioError
        As `service_of`.
    """
    scenario, layout, start = prepared.scenario, prepared.layout, prepared.start
    service, plan = service_of(scenario, outage), layout_of(scenario, outage).plan
    legs = layout.legs
    if plan is not layout.supply:  # a network with other sections above the trains
        legs = build_legs(layout.routes, scenario.lines_by_name, plan.runs)
    model = start.model._replace(network=service.network, legs=legs)
    start = replace(start, model=model, switchings=service.switchings)
    return replace(
        prepared,
        layout=replace(layout, supply=plan, legs=legs),
        start=with_relays(start, scenario, outage),
    )


def _flat(row: Row, intact: Row) -> dict[str, object]:
    """A row of the table."""
    changes = {
        f"{figure}_change": row.figures[figure] - intact.figures[figure]
        for figure in FIGURES
        if figure in row.figures
    }
    named = {"outage": row.outage, "out": row.out, "verdict": row.verdict_in_words}
    return {**named, "ended_min": row.ended_min, **row.lost, **row.figures, **changes}
