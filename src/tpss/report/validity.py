"""Limits of validity of the figures of a run."""

from collections.abc import Iterable, Iterator

from tpss.model.phases import phases_of
from tpss.results.thermal.elements import has_ratings
from tpss.scenario.machine import EffortLimits, EffortTable
from tpss.scenario.own_laws import laws_of
from tpss.scenario.rolling_stock import Train
from tpss.scenario.scenario import Scenario

ALWAYS = (
    "Quasi-stationary: voltages and currents are phasors, forces and powers constant within a time "
    "step, or means of it. No transients, no harmonics.",
    "Results depend on the time step; run the scenario with half of it to see by how much.",
    "Drivers hold the speed limit and make no mistakes.",
)

NOTHING_TRIPS = (
    "Nothing trips: equipment without a limit of its own is shown with its loading, and above 100 % the "
    "model continues where it would not."
)

TRIPS = (
    "What passes an overload of its rating trips; equipment without overloads continues above 100 %. "
    "Before the run there was no load."
)

REFUSED = (
    "What trains feed back and the line refuses, friction brakes or resistors on the train take; motion "
    "does not depend on it."
)

SUPPLY = (
    "Between trains and feeding points the voltage is interpolated, which leaves out the contact "
    "line's capacitance. Voltages are judged at the pantograph.",
)

OF_RATINGS = (
    "Equipment with a rating is judged once a run has ended: what is too hot, and has not tripped, has "
    "carried its load all the same. How warm it was before is an assumption, which the table of thermal "
    "states tells."
)


OF_GRIDS = (
    "A three-phase grid is an ideal source behind one impedance for both sequences: what others draw "
    "from it, and the unbalance that it has already, are not described. The limit of unbalance is that "
    "of the scenario, by default an estimate."
)


OF_LAWS = "Not an equation of TPSS: {}. What it leaves out, its author knows."


OF_RAILS = (
    "Rails of all tracks are joined at each node and leak to an earth at zero voltage, in lumps; their "
    "voltage is the highest that can be touched, not what a person bridges. Its limits, and that of "
    "stray current, are those of the scenario, by default estimates."
)


def limits_of_validity(scenarios: Iterable[Scenario]) -> list[str]:
    """Sentences on the method, on the trains that ran, and on the supply, each once."""
    told = list(scenarios)
    sentences = [_of_traffic(scenario) for scenario in told]
    sentences += [
        sentence
        for scenario in told
        for name in dict.fromkeys(entry.train for entry in scenario.traffic)
        for sentence in _of_train(name, scenario.trains[name])
    ]
    sentences += [TRIPS if scenario.protection.trip else NOTHING_TRIPS for scenario in told]
    rated = [OF_RATINGS] if any(has_ratings(scenario) for scenario in told) else []
    phased = any(phases_of(each) for scenario in told for each in scenario.supply.stations)
    grids = [OF_GRIDS] if phased else []
    laws = [OF_LAWS.format(law) for scenario in told for law in laws_of(scenario)]
    rails = [OF_RAILS] if any(scenario.supply.conductors for scenario in told) else []
    return [
        *ALWAYS,
        *dict.fromkeys(laws),
        *dict.fromkeys(sentences),
        *SUPPLY,
        *rails,
        *grids,
        *rated,
    ]


def _of_traffic(scenario: Scenario) -> str:
    """Which trains see each other."""
    signalling = scenario.signalling
    if signalling.has_gates:
        return (
            "Trains see those ahead of them on their track, and wait where they meet on a single one or "
            "come together; those that cross each other's way on different tracks do not see each other."
        )
    if signalling.separation != "none":
        return (
            "Trains see those ahead of them on their track; those that meet do not see each other."
        )
    return "Trains that follow each other, or meet on one track, do not see each other."


def _of_train(name: str, train: Train) -> Iterator[str]:
    """What the description of a train leaves out."""
    if train.regeneration is not None:
        yield REFUSED
    effort = train.tractive_effort
    if isinstance(effort, EffortTable):
        low, high = effort.speed_kmh[0], effort.speed_kmh[-1]
        volts = ""
        if effort.voltage_kv is not None:
            volts = f" and {effort.voltage_kv[0]:g} to {effort.voltage_kv[-1]:g} kV"
        yield (
            f"The tractive effort of {name} is a table for {low:g} to {high:g} km/h{volts}; beyond it "
            "the outer values apply, and steps there are counted in the notes above."
        )
    elif isinstance(effort, EffortLimits):
        falls = effort.full_voltage_kv is not None or train.current_limitation is not None
        yield (
            f"The tractive effort of {name} is a highest force and a highest power, without the "
            f"details of its machine{'' if falls else ', and does not depend on the voltage'}."
        )
    else:
        monitored = train.motor_rating is not None
        yield (
            "Machine curves of the Rc4 locomotive hold at 10.5 to 16.5 kV; steps outside are counted "
            "in the notes above."
            + (
                ""
                if monitored
                else " Its motors may carry their highest current for a limited time only, which is not "
                "monitored without a motor_rating."
            )
        )
    if train.current_limitation is not None:
        yield (
            f"The current limitation of {name} counts motors and auxiliaries, not a filter; its "
            "auxiliaries are never shed."
        )
