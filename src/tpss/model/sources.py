"""Feeding stations of a scenario as sources in SI units: one builder a kind of station."""

import math
from collections.abc import Callable, Sequence
from typing import Any

from tpss.model.own_laws import own_law
from tpss.record import Records
from tpss.scenario.supply import (
    ConverterStation,
    ConverterType,
    ConverterUnits,
    MixedStation,
    RectifierStation,
    Station,
    TransformerStation,
)
from tpss.sources.bounded import WIDTH, Bounds
from tpss.sources.converter import ConverterLaw
from tpss.sources.grid import GridLaw
from tpss.sources.kinds import Source, SourceKind
from tpss.sources.mixed import TYPES, MixedLaw
from tpss.sources.own import OwnStationLaw
from tpss.sources.rectifier import MOST_POINTS, RectifierLaw
from tpss.units import si


def _converter_station(node: int, station: ConverterStation) -> Any:
    kind = station.type
    return Source.row(
        node=node,
        kind=_converter_kind(station),
        installed=station.converters,
        controlled=station.control == "loading",
        rating_va=si(kind, "rating_mva"),
        converter=ConverterLaw.row(
            **_of_type(kind),
            grid_reactance_ohm=si(station, "grid_reactance_ohm"),
            grid_reactive_power_var=si(station, "grid_reactive_power_mvar"),
            grid_angle_rad=si(station, "grid_angle_deg"),
        ),
        bounds=_bounds(station),
        own=OwnStationLaw.row(voltage=own_law(station.law), turn_rad=si(station, "grid_angle_deg")),
    )


def _converter_kind(station: ConverterStation) -> SourceKind:
    if station.law is not None:
        return SourceKind.OWN
    return SourceKind.BOUNDED if station.has_bounds else SourceKind.CONVERTER


def _bounds(station: ConverterStation) -> Any:
    """Highest current of a converter, of that at rated power and no-load voltage; power back."""
    kind = station.type
    rated_a = si(kind, "rating_mva") / si(kind, "no_load_voltage_kv")
    percent = kind.current_limit_percent
    return Bounds.row(
        highest_current_a=math.inf if percent is None else percent / 100.0 * rated_a,
        blocked_from_w=WIDTH * si(kind, "rating_mva") if station.feedback == "none" else math.inf,
    )


def _of_type(kind: ConverterType) -> dict[str, float]:
    """What the law of converters has of their type."""
    base_ohm_va = si(kind, "base_voltage_kv") ** 2
    return {
        "no_load_voltage_v": si(kind, "no_load_voltage_kv"),
        "droop_v_per_var": si(kind, "droop_kv_per_mvar"),
        "generator_reactance_ohm": kind.generator_reactance_pu
        * base_ohm_va
        / si(kind, "generator_base_mva"),
        "motor_reactance_ohm": kind.motor_reactance_pu * base_ohm_va / si(kind, "motor_base_mva"),
        "motor_voltage_v": si(kind, "base_voltage_kv"),
    }


def _mixed_station(node: int, station: MixedStation) -> Any:
    return Source.row(
        node=node,
        kind=SourceKind.MIXED,
        installed=station.installed,
        controlled=False,
        rating_va=si(station, "unit_mva"),
        mixed=mixed_law(station.units, si(station, "grid_angle_deg")),
    )


def mixed_law(units: Sequence[ConverterUnits], grid_angle_rad: float = 0.0) -> Any:
    """Row of the law of converters of several types at one busbar."""
    fields: dict[str, Any] = {}
    whole_mva = sum(each.rated_mva for each in units)
    for name, each in zip(TYPES, units, strict=False):
        fields[name] = ConverterLaw.row(
            **_of_type(each.type),
            grid_reactance_ohm=0.0,
            grid_reactive_power_var=0.0,
            grid_angle_rad=grid_angle_rad,
        )
        fields[f"{name}_units"] = each.converters
        fields[f"{name}_share"] = each.rated_mva / whole_mva
    return MixedLaw.row(**fields)


def _transformer_station(node: int, station: TransformerStation) -> Any:
    voltage_v, unit = si(station, "no_load_voltage_kv"), station.transformer
    base_ohm = voltage_v**2 / si(unit, "rated_mva")
    reactance_pu = math.sqrt(unit.z_pu**2 - unit.r_pu**2)
    grid_ohm = 0j
    if station.grid_short_circuit_mva is not None:
        # A transformer between two phases sees the impedance of both.
        size_ohm = 2.0 * voltage_v**2 / si(station, "grid_short_circuit_mva")
        direction = complex(station.grid_r_over_x, 1.0)
        grid_ohm = size_ohm * direction / abs(direction)
    # What lies in the halves of a secondary of two windings is a part of the line's links.
    in_law = 1.0 - station.share_in_halves if station.secondary == "2x" else 1.0
    return Source.row(
        node=node,
        kind=SourceKind.GRID,
        installed=station.transformers,
        controlled=False,
        rating_va=si(unit, "rated_mva"),
        grid=GridLaw.row(
            no_load_voltage_v=voltage_v,
            grid_impedance_ohm=grid_ohm,
            transformer_impedance_ohm=complex(unit.r_pu, reactance_pu) * base_ohm * in_law,
        ),
    )


def _rectifier_station(node: int, station: RectifierStation) -> Any:
    current_a, voltage_kv = zip(*station.type.points, strict=True)
    points, inverter = len(current_a), station.inverter
    law: dict[str, Any] = {}
    if inverter is not None:
        law["inverter_from_v"] = si(inverter, "starts_at_kv")
        law["inverter_ohm"] = si(inverter, "resistance_ohm")
        if inverter.max_power_kw is not None:
            law["inverter_power_w"] = si(inverter, "max_power_kw")
    unused = (0.0,) * (MOST_POINTS - points)
    return Source.row(
        node=node,
        kind=SourceKind.RECTIFIER,
        installed=station.groups,
        controlled=False,
        rating_va=si(station, "unit_mva"),
        rectifier=RectifierLaw.row(
            points=points,
            current_a=(*current_a, *unused),
            voltage_v=(*(kv * 1e3 for kv in voltage_kv), *unused),
            **law,
        ),
    )


BUILDERS: dict[type, Callable[[int, Any], Any]] = {
    ConverterStation: _converter_station,
    TransformerStation: _transformer_station,
    MixedStation: _mixed_station,
    RectifierStation: _rectifier_station,
}
"""What makes a row of `Source` of a station, by its kind."""


def build_sources(nodes: list[int], stations: tuple[Station, ...]) -> Records[Source]:
    """Sources at their nodes, in the order of the stations."""
    rows = [BUILDERS[type(s)](node, s) for node, s in zip(nodes, stations, strict=True)]
    return Source.array(rows)
