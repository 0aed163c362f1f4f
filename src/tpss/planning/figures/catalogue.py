"""All figures of a plan by their names, with their titles and what they show."""

from collections.abc import Callable
from dataclasses import dataclass

from tpss.planning.figures.carried import carried
from tpss.planning.figures.decision_tree import decision_tree
from tpss.planning.figures.first_costs import first_costs
from tpss.planning.figures.regret import regret
from tpss.planning.figures.switching_values import switching_values
from tpss.planning.written import Written
from tpss.report.drawings.parts import Drawing


@dataclass(frozen=True)
class Figure:
    """A figure of a plan, or of each of its areas."""

    title: str
    text: str
    describe: Callable[[Written, str], Drawing | None]
    """By a plan and an area; gives None where there is nothing to draw."""
    otherwise: str
    """What the page says where there is nothing to draw."""
    of_area: bool = True


FIGURES: dict[str, Figure] = {
    "decision-tree": Figure(
        "Decision tree",
        "Above a branch: what comes into service at the beginning of a stage. Below: the traffic that "
        "the stage asks for, and how likely that is; the wider a branch, the likelier. A supply that "
        "does not carry the traffic runs less of it.",
        decision_tree,
        "The tree has too many ends to be drawn; the table of decisions has them all.",
    ),
    "first-costs": Figure(
        "Costs of the best first decisions",
        "Each with the best plan that contains it: the expected discounted cost of the whole plan, and "
        "what it costs more than the best one.",
        first_costs,
        "There is no first decision: nothing can be in service in time.",
    ),
    "switching-values": Figure(
        "Where the first decision turns",
        "How far each number may go, alone, before another first decision is the best one; which one "
        "stands behind the bar.",
        switching_values,
        "It is not known where the first decision turns: that is told where one decision is the same "
        "for all scenarios, all cases were simulated, and configurations are not very many. tpss plan "
        "price with --sweep or --set looks for it.",
    ),
    "regret": Figure(
        "Regret",
        "What a plan costs more, if a scenario comes, than the best plan for that scenario alone.",
        regret,
        "There are too many scenarios to be drawn, and the table of regrets has them all; or the best "
        "plans of single scenarios were not simulated.",
        of_area=False,
    ),
    "carried": Figure(
        "What each configuration carries",
        "In a cell stands the lowest voltage, or what is not kept; with * only with an outage that the "
        "supply must stand.",
        carried,
        "Nothing was simulated.",
    ),
}
"""Figures in the order of the page."""
