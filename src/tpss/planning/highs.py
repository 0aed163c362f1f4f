"""HiGHS, the solver of linear and integer programs, behind one function."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tpss.errors import PlanError
from tpss.extras import demand
from tpss.planning.linear import LinearProgram
from tpss.planning.money import Array

if TYPE_CHECKING:
    import highspy

FEASIBILITY = 1e-9
"""By how much a row may be missed; each is scaled to 1."""


@dataclass(frozen=True)
class Answer:
    """What HiGHS found."""

    x: Array | None
    """Best columns found, if any were."""
    bound: float
    """Nothing costs less; infinite if nothing meets the rows."""
    price: Array
    """How much the cost rises with each row's limit, of a linear program, shape (rows,)."""


def run_highs(
    program: LinearProgram,
    whole: int = 0,
    gap: float = 0.0,
    time_limit_s: float = np.inf,
    begin: Array | None = None,
) -> Answer:
    """Solve a linear program.

    Parameters
    ----------
    program : LinearProgram
    whole : int
        How many columns, from the first on, are whole numbers.
    gap : float
        Share of the cost within which a better solution is not looked for.
    time_limit_s : float
        Time after which the best so far is taken. [s]
    begin : array, optional
        Columns of a solution to begin with.

    Raises
    ------
    PlanError
        ``highspy`` is not installed, or HiGHS fails.
    """
    demand("budget")
    import highspy

    solver = _quiet(highspy.Highs)
    options = {
        "mip_rel_gap": gap, "mip_abs_gap": 0.0, "time_limit": time_limit_s,
        "primal_feasibility_tolerance": FEASIBILITY, "dual_feasibility_tolerance": FEASIBILITY,
        "mip_feasibility_tolerance": FEASIBILITY,
    }  # fmt: skip
    for name, value in options.items():
        _expect_ok(solver.setOptionValue(name, value), f"the option {name} = {value}")
    _expect_ok(solver.passModel(_model(program, whole)), "the program")
    if begin is not None:
        _expect_ok(solver.setSolution(len(begin), np.arange(len(begin)), begin), "the first plan")
    solver.run()
    return _answer(solver, whole > 0)


def _quiet(kind: "type[highspy.Highs]") -> "highspy.Highs":
    """A solver that prints nothing, not even its name, which 1.16 does as soon as it is made."""

    class Quiet(kind):  # type: ignore[misc, valid-type]
        def enableCallbacks(self) -> None:  # noqa: N802
            self.setOptionValue("output_flag", False)
            super().enableCallbacks()

    solver: highspy.Highs = Quiet()
    solver.setOptionValue("output_flag", False)
    return solver


def _model(program: LinearProgram, whole: int) -> "highspy.HighsLp":
    import highspy

    lp = highspy.HighsLp()
    lp.num_col_, lp.num_row_ = len(program.cost), len(program.low)
    lp.col_cost_ = program.cost
    lp.col_lower_, lp.col_upper_ = np.zeros(len(program.cost)), program.upper
    lp.row_lower_, lp.row_upper_ = program.low, program.high
    lp.a_matrix_.format_ = highspy.MatrixFormat.kColwise
    lp.a_matrix_.num_col_, lp.a_matrix_.num_row_ = lp.num_col_, lp.num_row_
    lp.a_matrix_.start_ = program.start
    lp.a_matrix_.index_ = program.row
    lp.a_matrix_.value_ = program.value
    if whole:
        kinds = highspy.HighsVarType
        others = len(program.cost) - whole
        lp.integrality_ = [kinds.kInteger] * whole + [kinds.kContinuous] * others
    return lp


def _answer(solver: "highspy.Highs", integer: bool) -> Answer:
    import highspy

    status, info = solver.getModelStatus(), solver.getInfo()
    kinds = highspy.HighsModelStatus
    if status == kinds.kInfeasible:
        return Answer(None, np.inf, np.empty(0))
    if status not in (kinds.kOptimal, kinds.kTimeLimit):
        raise PlanError(f"HiGHS stops: {solver.modelStatusToString(status)}")
    found = info.primal_solution_status == highspy.SolutionStatus.kSolutionStatusFeasible
    solution = solver.getSolution()
    if integer:
        bound = info.mip_dual_bound
    else:
        bound = info.objective_function_value if status == kinds.kOptimal else -np.inf
    x = np.asarray(solution.col_value) if found else None
    return Answer(x, float(bound), np.asarray(solution.row_dual))


def _expect_ok(status: "highspy.HighsStatus", what: str) -> None:
    import highspy

    if status != highspy.HighsStatus.kOk:
        raise PlanError(f"HiGHS does not take {what}")
