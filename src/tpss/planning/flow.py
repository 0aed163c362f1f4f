"""A plan as a flow through its tree: columns and rows of a linear program, without a solver.

A column is a change into a group of decisions, from one configuration to another, and is 1 or 0.  What
flows into a configuration of a group flows on into each group after it.  Without budgets the linear
program has the optimum of the dynamic program: its costs of the rest of a plan are prices of these rows
at which no column is too cheap.  All corners are whole numbers then.  Budgets cut corners off, and make
it an integer program.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tpss.planning.decisions import Decisions, decisions_of
from tpss.planning.level_transitions import table_of
from tpss.planning.linear import LinearProgram, linear_program, moved
from tpss.planning.money import Array
from tpss.planning.problem import Problem
from tpss.planning.tree import NONE, Indices

Flags = npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Columns:
    """Changes of one area that are possible, each of shape (columns,)."""

    area: int
    decisions: Decisions
    group: Indices
    before: Indices
    after: Indices
    cost: Array
    """Expected discounted cost of the change and of operation in its group."""
    outlay: Array
    """What the change spends."""

    def __len__(self) -> int:
        return len(self.group)

    def used_by(self, configuration: Indices, initial: int) -> Flags:
        """Which are used if each node has some configuration, shape (nodes,)."""
        decisions = self.decisions
        first = np.unique(decisions.group_of_node, return_index=True)[1]
        of_group = configuration[first]
        parent = decisions.parent
        before = np.where(parent == NONE, initial, of_group[parent])
        used: Flags = before[self.group] == self.before
        used &= of_group[self.group] == self.after
        return used

    def policy(self, used: Flags) -> Indices:
        """Configuration of each node, shape (nodes,), of the columns that are used."""
        of_group = np.empty(self.decisions.groups, dtype=np.int64)
        of_group[self.group[used]] = self.after[used]
        return of_group[self.decisions.group_of_node]


def columns_of(problem: Problem, k: int, keep: Flags | None = None) -> Columns:
    """Possible changes of an area: those that can be reached, and from which its plan can go on.

    Parameters
    ----------
    problem : Problem
    k : int
        Number of the area.
    keep : array of bool, optional
        Those to be left in, shape (groups, from, to).
    """
    area, decisions = problem.areas[k], decisions_of(problem, k)
    table = table_of(area.transitions)
    change = table.cost[decisions.stage]
    possible = np.isfinite(change) & np.isfinite(decisions.cost)[:, np.newaxis, :]
    if keep is not None:
        possible &= keep
    for g in reversed(range(decisions.groups)):
        for h in decisions.children[g]:
            possible[g] &= possible[h].any(axis=1)
    for g, parent in enumerate(decisions.parent):
        start = np.arange(area.configurations) == area.transitions.initial
        from_ = start if parent == NONE else possible[parent].any(axis=0)
        possible[g] &= from_[:, np.newaxis]
    group, before, after = np.nonzero(possible)
    cost = decisions.weight[group] * change[group, before, after] + decisions.cost[group, after]
    spent = table.outlay[decisions.stage[group], before, after]
    return Columns(k, decisions, group, before, after, cost, spent)


@dataclass(frozen=True)
class Program:
    """A plan as a linear program."""

    columns: tuple[Columns, ...]
    """Of each area, one after the other."""
    linear: LinearProgram
    budget_nodes: Indices
    """A node for each of the last rows, which are budgets in a unit in which each is 1."""

    def policy(self, x: Array) -> Indices:
        """Configurations of each node, shape (areas, nodes), of a solution of whole numbers."""
        parts = np.split(x > 0.5, np.cumsum([len(each) for each in self.columns])[:-1])
        return np.array([one.policy(used) for one, used in zip(self.columns, parts, strict=True)])

    def values(self, problem: Problem, policy: Indices) -> Array:
        """Columns of a plan, 1 where it uses one."""
        parts = [
            one.used_by(row, problem.areas[one.area].transitions.initial)
            for one, row in zip(self.columns, policy, strict=True)
        ]
        return np.concatenate(parts).astype(np.float64)


def program_of(problem: Problem, keep: list[Flags] | None = None) -> Program:
    """Linear program of a plan.

    Parameters
    ----------
    problem : Problem
    keep : list of arrays of bool, optional
        Changes that are left in, for each area of the shape (groups, from, to).
    """
    columns = tuple(
        columns_of(problem, k, None if keep is None else keep[k]) for k in range(len(problem.areas))
    )
    entries, sides, offset, rows = [], [], 0, 0
    for one in columns:
        found, side = _balances(one)
        entries.append(moved(found, rows, offset))
        sides.append(side)
        rows, offset = rows + len(side), offset + len(one)
    spent, nodes, limit = _budgets(problem, columns)
    entries.append(moved(spent, rows, 0))
    side = np.concatenate(sides)
    low = np.concatenate([side, np.full(len(nodes), -np.inf)])
    high = np.concatenate([side, limit])
    cost = np.concatenate([one.cost for one in columns])
    linear = linear_program(cost, np.ones(offset), low, high, np.concatenate(entries, axis=1))
    return Program(columns, linear, nodes)


def _balances(one: Columns) -> tuple[Array, Array]:
    """Entries (row, column, value) of what flows on, and the right sides.

    Each group has a row for each configuration before it that can be reached.
    """
    decisions = one.decisions
    size = decisions.cost.shape[1]
    place = one.group * size + one.before
    used, row = np.unique(place, return_inverse=True)
    number = np.full(decisions.groups * size, NONE, dtype=np.int64)
    number[used] = np.arange(len(used))
    column = np.arange(len(one))
    entries = [np.stack([row, column, np.ones(len(one))])]
    for h in np.flatnonzero(decisions.parent != NONE):
        into = np.flatnonzero(one.group == decisions.parent[h])
        onward = number[h * size + one.after[into]]
        entries.append(np.stack([onward, into, np.full(len(into), -1.0)]))
    begins = decisions.parent[used // size] == NONE
    return np.concatenate(entries, axis=1), begins.astype(np.float64)


def _budgets(problem: Problem, columns: tuple[Columns, ...]) -> tuple[Array, Indices, Array]:
    """Entries of what is spent in each node with a budget, those nodes, and the right sides.

    Nodes in which all areas are in the same groups spend the same: the smallest budget is kept.
    """
    nothing = np.empty((3, 0)), np.empty(0, dtype=np.int64), np.empty(0)
    if problem.budget is None or not problem.is_limited:
        return nothing
    groups = np.stack([one.decisions.group_of_node for one in columns])
    tightest: dict[tuple[int, ...], int] = {}
    for n in np.flatnonzero(np.isfinite(problem.budget)):
        key = tuple(groups[:, n])
        other = tightest.get(key, n)
        tightest[key] = min(int(n), int(other), key=lambda node: problem.budget[node])  # type: ignore[index]
    nodes = np.array(sorted(tightest.values()), dtype=np.int64)
    limit = problem.budget[nodes]
    unit = np.where(limit > 0.0, limit, 1.0)
    entries, offset = [nothing[0]], 0
    for one in columns:
        for k, n in enumerate(nodes):
            spending = np.flatnonzero(
                (one.group == one.decisions.group_of_node[n]) & (one.outlay != 0.0)
            )
            rows = np.full(len(spending), k)
            entries.append(np.stack([rows, offset + spending, one.outlay[spending] / unit[k]]))
        offset += len(one)
    return np.concatenate(entries, axis=1), nodes, limit / unit
