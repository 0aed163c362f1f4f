"""What belongs together where contact line, rails and feeder are conductors of their own."""

from collections.abc import Sequence
from typing import Any

from tpss.scenario.fields import fault
from tpss.scenario.supply.catenary import Catenary
from tpss.scenario.supply.conductors import Autotransformers, Conductors

NEEDS = "add supply.conductors, or leave it out"


def demand_conductors(
    conductors: Conductors | None,
    catenaries: Sequence[Catenary],
    stations: Sequence[Any],
    autotransformers: Sequence[Autotransformers],
    is_direct: bool,
    has_high_voltage: bool,
) -> None:
    """Raise a fault for what a supply has of conductors of their own without the others.

    Parameters
    ----------
    conductors : Conductors, optional
    catenaries : sequence of Catenary
        That of the supply and those of stretches.
    stations : sequence of feeding stations
    autotransformers : sequence of Autotransformers
    is_direct : bool
        Whether the current is direct.
    has_high_voltage : bool
        Whether there is a high-voltage line.
    """
    halved = [each.name for each in stations if getattr(each, "secondary", "1x") == "2x"]
    if conductors is None:
        _demand_nothing(halved, stations, autotransformers)
        return
    if has_high_voltage:
        raise fault(
            "supply.conductors beside a high-voltage line, whose transformers are known between a "
            "single conductor and earth only",
            "leave one of them out",
        )
    for each in catenaries:
        _demand_described(each, is_direct)
    if conductors.leakage_s_per_km == 0.0 and all(s.rail_earthing_ohm is None for s in stations):
        raise fault(
            "nothing ties the rails to earth, so that their voltage is unknown",
            "give leakage_s_per_km of supply.conductors, or rail_earthing_ohm of a station",
        )
    for each in stations:
        if each.name in halved and each.transformer.short_circuit_percent == 0.0:
            raise fault(
                f"the transformer of {each.name} has no impedance to lie in the halves of its secondary",
                "give short_circuit_percent of the transformer",
            )
    feeders = ["feeder" in _kinds(each) for each in catenaries]
    if (halved or autotransformers) and not all(feeders):
        raise fault(
            f"{halved[0] if halved else 'autotransformers'} at a contact line without a feeder",
            "name a feeder among the conductors of every catenary, or leave the others out",
        )
    if any(feeders) and not (halved or autotransformers):
        raise fault(
            "a feeder that nothing feeds",
            'add autotransformers or a station with secondary = "2x", or take the feeder out',
        )


def _demand_nothing(
    halved: Sequence[str], stations: Sequence[Any], autotransformers: Sequence[Autotransformers]
) -> None:
    """Raise a fault for what only conductors of their own have."""
    if autotransformers:
        raise fault("autotransformers without conductors between which they stand", NEEDS)
    if halved:
        raise fault(f'secondary = "2x" of {halved[0]}, without rails and a feeder', NEEDS)
    earthed = [each.name for each in stations if each.rail_earthing_ohm is not None]
    if earthed:
        raise fault(f"rail_earthing_ohm of {earthed[0]}, without rails of their own", NEEDS)


def _demand_described(catenary: Catenary, is_direct: bool) -> None:
    """Raise a fault for a catenary whose conductors are not described."""
    if catenary.connection_r_ohm or catenary.connection_x_ohm:
        raise fault(
            "a connection impedance, which stands for autotransformers in a single conductor, beside "
            "supply.conductors",
            "leave connection_r_ohm and connection_x_ohm out, and describe the autotransformers",
        )
    if is_direct:
        if catenary.direct_conductors_ohm_per_km is None:
            raise fault(
                "supply.conductors, and the catenary does not tell contact line and rails apart",
                "give its contact_line and rails in place of r_ohm_per_km",
            )
        if catenary.conductors is not None:
            raise fault(
                "conductors with reactances, and the current is direct",
                "give contact_line and rails of the catenary instead",
            )
    elif catenary.conductors is None:
        raise fault(
            "supply.conductors, and the catenary has none",
            "give its conductors, which tpss line-constants writes from where they hang",
        )


def _kinds(catenary: Catenary) -> set[str]:
    """What there is among the conductors of a catenary."""
    if catenary.conductors is None:
        return {"contact", "rails"}
    return {name.partition(" ")[0] for name in catenary.conductors.names}
