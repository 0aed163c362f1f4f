"""The answer in a sentence: what to order now, what else costs, and where the choice turns."""

from collections.abc import Sequence

from tpss.planning.answer import Answer
from tpss.planning.configurations import Configuration
from tpss.planning.dynamic import FirstDecision
from tpss.planning.load import PlannedArea
from tpss.planning.plan_faults import PRICES
from tpss.planning.tables import built
from tpss.planning.turning import DISCOUNT_RATE, Turn, nearest
from tpss.planning.wording import number, varied_in_words

ALTERNATIVES = 2
"""Other first decisions that are named."""

WAITING = "waiting"
"""Names the first decision to build nothing."""

TIE = 1e-3
"""Share of the cost below which what one costs more is a tie: a time step moves energies as much. [1]"""


def sentences(answer: Answer, turns: Sequence[Turn]) -> list[str]:
    """A sentence for each first decision of each area: one, unless futures part at once.

    Parameters
    ----------
    answer : Answer
    turns : sequence of Turn
        Where first decisions turn; none where that is not known.
    """
    return [_sentence(answer, firsts, turns) for firsts in groups_of(answer)]


def groups_of(answer: Answer) -> list[list[FirstDecision]]:
    """First decisions by what they are alternatives to: one list for each area and its futures."""
    groups: dict[tuple[int, tuple[int, ...]], list[FirstDecision]] = {}
    for each in answer.firsts:
        groups.setdefault((each.area, tuple(each.nodes.tolist())), []).append(each)
    return list(groups.values())


def _sentence(answer: Answer, firsts: list[FirstDecision], turns: Sequence[Turn]) -> str:
    model = answer.model
    k, stage = firsts[0].area, int(model.tree.stage[firsts[0].nodes[0]])
    start, currency = model.plan.file.stages.start, model.plan.file.economics.currency
    order = model.problem.areas[k].ordered_at[stage]
    verb = "Build" if order == stage else "Order"
    names = [in_words(answer, each) for each in firsts]
    what = f"{verb} {names[0]} in {start[order]}"
    if not built(model, k, 0, firsts[0].configuration):
        what = f"{verb} nothing in {start[order]}"
    where = f"{model.areas[k].area.name}: " if model.areas[k].area.name else ""
    when = ""
    if len(firsts[0].nodes) < int((model.tree.stage == stage).sum()):
        through = dict.fromkeys(
            name for node in firsts[0].nodes for name in model.tree.scenarios_through(node)
        )
        when = f" if {' or '.join(through)}"
    others = ", ".join(
        _other(answer, name, each, is_first=i == 0)
        for i, (name, each) in enumerate(zip(names[1:], firsts[1:], strict=True))
        if i < ALTERNATIVES
    )
    together = " in all areas" if where else ""
    parts = [f"{where}{what}{when}: {money(firsts[0].cost)} {currency} expected{together}", others]
    parts.append(_turn_in_words(answer, [turn for turn in turns if turn.area == k]))
    return "; ".join(part for part in parts if part) + "."


def _other(answer: Answer, name: str, first: FirstDecision, is_first: bool) -> str:
    """What another first decision costs more."""
    instead = f"{name}{' instead costs' if is_first else ''}"
    if answer.is_bound(first.policy):
        return f"{instead} at least {money(first.surplus)} more"
    tie = ", which is a tie" if first.is_tie(TIE) else ""
    return f"{instead} {money(first.surplus)} more{tie}"


def in_words(answer: Answer, first: FirstDecision) -> str:
    """What is built in a first decision; waiting, if nothing is."""
    return " and ".join(built(answer.model, first.area, 0, first.configuration)) or WAITING


def _turn_in_words(answer: Answer, turns: list[Turn]) -> str:
    """The nearest value at which the choice turns."""
    turn = nearest(turns)
    if turn is None:
        return ""
    found = turn.found
    ends = [
        (end, to)
        for end, to in ((found.below, found.below_to), (found.above, found.above_to))
        if end is not None and to is not None
    ]
    value, to = min(ends, key=lambda end: abs(end[0] - found.now))
    configurations = answer.model.areas[turn.area].configurations
    names = [each.name if each.size else WAITING for each in configurations]
    what = varied_in_words(turn.key)
    if turn.key.startswith(f"{PRICES}.") and turn.key != DISCOUNT_RATE:
        what = f"price of {what}"
    now = number(found.now)
    return f"the choice turns to {names[to]} if the {what} is {number(value)} (now {now})"


def money(amount: float) -> str:
    """An amount of the plan's currency, as it is printed."""
    return f"{amount:,.1f}"


def measure_names(area: PlannedArea, configuration: Configuration) -> list[str]:
    """Measures that stand in a configuration."""
    return [name for name, level in zip(area.measures, configuration.levels, strict=True) if level]
