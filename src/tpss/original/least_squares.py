r"""The clock with the load flow of the original program: least squares of the power mismatches.

.. math:: \min z, \quad z = \sum_n (\Delta P_n^2 + \Delta Q_n^2)

scipy's `least_squares` (a trust region with bounds, "dogbox") takes the place of GAMS; the band of
plausible voltages is its bounds, and the values of the time step before are its start.  A minimum is a
solution only if the largest mismatch there is below the network's tolerance; otherwise the load flow
is attempted from a flat start, and at last by load continuation, as `powerflow.solve` does.  Traffic,
drivers, converter control, motion and recording are the kernels of the usual clock.

References
----------
[Boullanger2009]_, eq. (3.3) and (3.4).
"""

import numpy as np
from scipy.optimize import least_squares

from tpss.kernel import plain
from tpss.original.grid import Complexes, Floats, Grid, lay_out
from tpss.original.mismatch import Mismatch
from tpss.powerflow.raising import FIRST_STEP, SHORTEST_STEP, STEP_GROWTH
from tpss.step.advance import (
    begin_step,
    change_length,
    end_step,
    prepare_step,
    step_to_arrival,
)
from tpss.step.coupling import apply_solutions, decide
from tpss.step.model import Model, driving_data, with_step
from tpss.step.record import record_instant
from tpss.step.recording import Recording
from tpss.step.sparing import allow_currents, heat_motors
from tpss.step.state import State, Status, loads_in_python

SHORTEST_MOVE = 1e-8
"""The minimum is reached where a step changes the unknowns by less than this share of them.  Close to a
solution steps shrink quadratically, so what is left then is a rounding. [1]"""

MOST_EVALUATIONS = 60


def advance_by_least_squares(
    first: int, last: int, model: Model, state: State, recording: Recording
) -> tuple[int, int]:
    """Run steps `first` to `last` - 1, as `step.advance.advance` does."""
    step, spares = first, model.control.spares_motors
    status: int = Status.RUNNING
    while step < last and status == Status.RUNNING:
        clock = state.clock[0]
        if spares:
            allow_currents(step, model.options.step_s, model, state)
        clock.on_line = begin_step(step, model, state, recording)
        evaluations, tries = 0, 0
        while True:
            now = plain(with_step)(model, clock.last_step_s)
            prepare_step(clock.on_line, now, state)
            share, more = solve_step(clock.on_line, step + tries > 0, now, state)
            evaluations, tries = evaluations + more, tries + 1
            wanted_s = plain(step_to_arrival)(tries, clock.last_step_s, model, state)
            if share < 1.0 or wanted_s == clock.last_step_s:
                break
            change_length(step, wanted_s, model, state, recording)
        status = end_step(step, clock.on_line, share, evaluations, now, state, recording)
        if status in (Status.RUNNING, Status.FINISHED):
            if spares:
                heat_motors(step, clock.last_step_s, model, state, recording)
            step += 1
    record_instant(step, state.trains, recording)
    return status, step


def solve_step(count: int, warm: bool, model: Model, state: State) -> tuple[float, int]:
    """Solve a step until every driver's decision stands; see `step.coupling.solve_step`."""
    evaluations = 0
    while True:
        decide(count, state.flow.standing, state.trains, plain(driving_data)(model), model.points)
        share, more = solve_network(count, warm, model, state)
        evaluations += more
        if share < 1.0 or apply_solutions(count, model, state):
            return share, evaluations
        warm = True


def solve_network(count: int, warm: bool, model: Model, state: State) -> tuple[float, int]:
    """Voltages at all nodes and pantographs, in the order of attempts of `powerflow.solve`.

    Returns
    -------
    share : float
        1.0, or the share of all loads beyond which no solution was found.
    evaluations : int
        Evaluations of the mismatches.
    """
    grid = lay_out(count, model.network, state.flow)
    search = Search(grid, count, model, state)
    if (warm and search.attempt(1.0, search.last())) or search.attempt(1.0, search.flat):
        return 1.0, search.evaluations
    share, step, solution = 0.0, FIRST_STEP, search.flat
    while share < 1.0 and step >= SHORTEST_STEP:
        target = min(1.0, share + step)
        if search.attempt(target, solution):
            share, step, solution = target, STEP_GROWTH * step, search.solution
        else:
            step /= 2.0
    return share, search.evaluations


class Search:
    """Search for the solution of one step; what it finds it writes into the state."""

    def __init__(self, grid: Grid, count: int, model: Model, state: State) -> None:
        self.grid, self.count, self.model, self.state = grid, count, model, state
        self.loads = loads_in_python(model, state)
        self.evaluations = 0
        self.base_v = model.network.system.base_voltage_v
        powers = np.zeros(2 * model.network.sources.size)
        self.flat = np.concatenate([np.zeros(grid.size), np.ones(grid.size), powers])
        """Unknowns without load."""
        self.stable_sign = np.linalg.slogdet(self.problem(0.0).jacobian(self.flat))[0]
        """Sign of the determinant there, which the stable branch keeps."""
        self.solution = self.flat

    def problem(self, share: float) -> Mismatch:
        """Mismatches at a share of the loads."""
        return Mismatch(self.grid, self.model.network, self.state.flow, self.loads, share)

    def last(self) -> Floats:
        """Unknowns of the step before; trains take the voltage between the nodes around them."""
        nodes, network = self.state.flow.nodes, self.model.network
        volts, standing = nodes["voltage_v"], self.state.flow.standing[: self.count]
        section = network.sections[standing["section"]]
        length_m = section["end_m"] - section["start_m"]
        share = (standing["place_m"] - section["start_m"]) / length_m
        start_v, end_v = volts[section["start_node"]], volts[section["end_node"]]
        trains_v = start_v + share * (end_v - start_v)
        phasor = np.concatenate([volts, trains_v]) / self.base_v
        fed_va = (volts * nodes["leaving_current_a"].conj())[network.sources["node"]]
        powers = np.concatenate([fed_va.real, fed_va.imag]) / network.system.base_power_va
        return np.concatenate([np.angle(phasor), np.abs(phasor), powers])

    def attempt(self, share: float, start: Floats) -> bool:
        """Whether there is a solution at a share of the loads, searched from given unknowns.

        References
        ----------
        [Boullanger2009]_, eq. (3.3) and (3.4).
        """
        problem = self.problem(share)
        low, high = np.full(start.size, -np.inf), np.full(start.size, np.inf)
        voltages = slice(self.grid.size, 2 * self.grid.size)
        system = self.model.network.system
        low[voltages] = system.lowest_voltage_v / self.base_v
        high[voltages] = system.highest_voltage_v / self.base_v
        minimum = least_squares(
            problem.residuals, np.clip(start, low, high), problem.jacobian, (low, high),
            method="dogbox", ftol=None, xtol=SHORTEST_MOVE, gtol=None, max_nfev=MOST_EVALUATIONS,
        )  # fmt: skip
        self.evaluations += minimum.nfev
        sign = np.linalg.slogdet(minimum.jac)[0]
        if np.abs(minimum.fun).max() >= self.model.network.tolerance or sign != self.stable_sign:
            return False
        self.solution = minimum.x
        solution = problem.split(minimum.x)
        problem.demand(solution.voltage)  # leaves the powers in the trains' records
        self._keep(solution.phasor * self.base_v)
        return True

    def _keep(self, voltage_v: Complexes) -> None:
        """Write the voltages of a solution, and the currents that belong to them, into the state."""
        flow = self.state.flow
        fixed = flow.nodes.size
        flow.nodes["voltage_v"] = voltage_v[:fixed]
        flow.nodes["leaving_current_a"] = (self.grid.admittance_matrix() @ voltage_v)[:fixed]
        entering_a, end_a = self.grid.section_currents_a(voltage_v)
        flow.sections["current_a"], flow.sections["end_current_a"] = entering_a, end_a
        flow.standing["voltage_v"][: self.count] = voltage_v[fixed:]
        if self.grid.coupled:
            flow.groups.lost_w[:] = self.grid.coupled_losses_w(voltage_v)
        trains = flow.standing["train"][: self.count]
        self.state.trains["demand"]["voltage_v"][trains] = np.abs(voltage_v[fixed:])
