"""What a run of a model begins with."""

from tpss.errors import Finding, ScenarioError
from tpss.model.build import steps_of
from tpss.model.outages import service_of
from tpss.model.relays import with_relays
from tpss.model.supplements import with_supplements
from tpss.model.traffic import build_services
from tpss.run.dispatch import NoOrderError
from tpss.run.order import with_order
from tpss.run.start import Start, begin
from tpss.scenario.scenario import Scenario
from tpss.step.model import Model
from tpss.units import si


def given_steps(scenario: Scenario, model: Model) -> int | None:
    """Number of steps of the duration that a scenario gives; None: it ends with an arrival."""
    if scenario.simulation.duration_min is None:
        return None
    return steps_of(si(scenario.simulation, "duration_min"), model.options.step_s)


def start_of(scenario: Scenario, model: Model) -> Start:
    """Services, trains on the line and number of steps of a run, at the model's time step.

    Raises
    ------
    ScenarioError
        A train that the scenario places on the line could not stop or slow down in time, or trains
        that keep an order on single tracks cannot all come through.
    TooLargeError
        The recording would not fit into memory, or trains already running would take too long.
    """
    model, services = with_supplements(scenario, model, build_services(scenario, model))
    start = begin(model, services, given_steps(scenario, model), service_of(scenario).switchings)
    start = with_relays(start, scenario, scenario.outage)
    try:
        return with_order(start)
    except NoOrderError as error:
        one, other = (start.trains[i].name for i in (error.one, error.other))
        problem = f"{one} and {other} are in each other's way: not all trains come through"
        remedy = (
            "let trains on the way at the start stand so that they can cross, or give crossing stations "
            'more tracks; or write "free"'
        )
        source, key = scenario.given_source, "signalling.single_track"
        value = repr(scenario.signalling.single_track)
        raise ScenarioError([Finding(source, key, value, problem, remedy)]) from error
