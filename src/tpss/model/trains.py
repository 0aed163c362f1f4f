"""Trains and machines of a scenario as arrays."""

import math
from functools import cache
from typing import Any

import numpy as np

from tpss import library
from tpss.kernel import plain
from tpss.model.curves import CurveBook, interpolate
from tpss.model.own_laws import own_law
from tpss.model.profiles import row_seen, rows_seen
from tpss.model.routes import Running
from tpss.model.stores import store_of
from tpss.numerics.curve import Curve as CurvePlace
from tpss.numerics.curve import Points
from tpss.numerics.neural_network import FeedForwardNetwork, build_network
from tpss.physics.motor import MotorModel
from tpss.physics.reactive_power import ReactiveModel, reactive_ratio
from tpss.physics.running_resistance import DavisCoefficients
from tpss.physics.thermal import time_to_rated_s
from tpss.record import Records
from tpss.scenario.machine import Curve, EffortLimits, EffortTable, RetardationBands
from tpss.scenario.over_load import EfficiencyOverLoad
from tpss.scenario.rolling_stock import Train
from tpss.scenario.standards import VoltageLimits, limits_of_system
from tpss.scenario.supply.system import DEFAULT_SYSTEM, system_named
from tpss.storage.on_board import OnBoard
from tpss.units import si, si_list
from tpss.vehicle.braking import lay_out_bands
from tpss.vehicle.effort.kinds import EffortKind, TractiveEffort
from tpss.vehicle.effort.limits import EffortLimits as Limits
from tpss.vehicle.effort.table import MOST_VOLTAGES
from tpss.vehicle.effort.table import EffortTable as Table
from tpss.vehicle.part_load import LoadCurve, lay_out_loads
from tpss.vehicle.regeneration import ROUNDED_V, Regeneration
from tpss.vehicle.spared_motors import SparedMotors
from tpss.vehicle.train_type import LineCurrentLimit, Networks, TrainType

KM_H = 1.0 / 3.6
KV = 1e3

_NETWORK_INPUTS = {
    "tractive_effort": (KM_H, KV, 1.0),
    "bridge_sine": (1.0, 1.0),
    "power_factor": (KM_H,),
}
"""What one printed unit of each input of the library's networks is in SI units."""


@cache
def _rc4() -> Any:
    """The networks of the Rc4, a row of `Networks`."""
    coefficients = library.networks()
    built = {
        name: build_network(coefficients[name], to_si) for name, to_si in _NETWORK_INPUTS.items()
    }
    return Networks.row(**{name: network.tolist() for name, network in built.items()})  # type: ignore[attr-defined]


@cache
def _no_networks() -> Any:
    """Networks of a train whose machine is described otherwise."""
    return (FeedForwardNetwork.blank(1)[0].tolist(),) * len(_NETWORK_INPUTS)  # type: ignore[attr-defined]


def build_train_types(
    running: list[Running], limits: VoltageLimits | None = None
) -> tuple[Records[TrainType], Points]:
    """The types in the order of the trains, and the points of their curves.

    Parameters
    ----------
    running : list of Running
    limits : VoltageLimits
        Of the system, between whose highest voltages the line stops taking what trains feed back, unless
        they say otherwise; by default those of the default system, where no train feeds back.
    """
    limits = limits or limits_of_system(DEFAULT_SYSTEM)
    book, seen = CurveBook(), rows_seen(running)
    rows = [_train_type(each.train, seen.index(row_seen(each)), book, limits) for each in running]
    return TrainType.array(rows), book.points()


def _train_type(train: Train, profile: int, book: CurveBook, limits: VoltageLimits) -> Any:
    mass, adhesive = si(train, "mass_t"), si(train, "adhesive_mass_t")
    return TrainType.row(
        mass_kg=mass,
        adhesive_mass_kg=adhesive,
        **_inertias(train, mass, adhesive),
        rotor_mass_kg=si(train, "motor_inertia_kg") * (1.0 + train.slip),
        slip_factor=1.0 + train.slip,
        resistance=DavisCoefficients.row(
            a_n=si(train, "resistance_a_n"),
            b_n_s_per_m=si(train, "resistance_b_n_s_per_m"),
            c_n_s2_per_m2=si(train, "resistance_c_n_s2_per_m2"),
        ),
        own_resistance=own_law(train.resistance_law),
        driver=own_law(train.driver),
        highest_acceleration_m_s2=_si_or(train, "max_acceleration_m_s2", math.inf),
        **_braking(train),
        highest_speed_m_s=si(train, "max_speed_kmh"),
        length_m=si(train, "length_m"),
        profile=profile,
        adhesion=CurvePlace.row() if train.adhesion is None else _over_speed(train.adhesion, book),
        efficiency=_over_speed(train.efficiency, book),
        effort=_effort(train, book),
        line_current=_line_current(train),
        regeneration=_regeneration(train, book, limits),
        pulls_at_any_voltage=_pulls_at_any_voltage(train),
        spared=_spared_motors(train),
        on_board=_on_board(train),
        over_load=_over_load(train.efficiency_over_load, _rated_power_kw(train)),
        **_electric(train, book),
    )


def _inertias(train: Train, mass_kg: float, adhesive_kg: float) -> dict[str, float]:
    """Fields of `TrainType` that add the rotating parts to the mass."""
    if train.rotating_mass_share is not None:
        inertia_kg = mass_kg * (1.0 + train.rotating_mass_share)
        return {"inertia_kg": inertia_kg, "coasting_inertia_kg": inertia_kg}
    with_rotating = 1.0 + train.rotating_mass_factor
    return {
        "inertia_kg": adhesive_kg + (mass_kg - adhesive_kg) * with_rotating,
        "coasting_inertia_kg": mass_kg * with_rotating,
    }


def _braking(train: Train) -> dict[str, Any]:
    """Fields of `TrainType` for the highest retardation."""
    given = train.max_retardation_m_s2
    if isinstance(given, RetardationBands):
        from_m_s, values = si_list(given, "from_speed_kmh"), si_list(given, "retardation_m_s2")
    else:
        from_m_s, values = [0.0], [given]
    return {
        "highest_retardation_m_s2": max(values),
        "braking": lay_out_bands(from_m_s, values),
    }


def _effort(train: Train, book: CurveBook) -> Any:
    """A row of `TractiveEffort`."""
    effort = train.tractive_effort
    if isinstance(effort, EffortTable):
        return TractiveEffort.row(kind=EffortKind.TABLE, table=_effort_table(train, effort, book))
    if isinstance(effort, EffortLimits):
        limits = Limits.row(
            highest_force_n=si(effort, "max_force_kn"),
            highest_power_w=si(effort, "max_power_kw"),
            limit_speed_m_s=_si_or(effort, "limit_speed_kmh", math.inf),
            zero_voltage_v=_si_or(effort, "zero_voltage_kv", 0.0),
            full_voltage_v=_si_or(effort, "full_voltage_kv", 0.0),
        )
        return TractiveEffort.row(kind=EffortKind.LIMITS, limits=limits)
    current_a = si(train, "max_motor_current_a")
    return TractiveEffort.row(kind=EffortKind.NETWORK, highest_current_a=current_a)


def _pulls_at_any_voltage(train: Train) -> bool:
    """Whether the motors' force and power have nothing to do with the line voltage."""
    effort = train.tractive_effort
    if not isinstance(effort, EffortLimits) or effort.full_voltage_kv is not None:
        return False
    limited = train.current_limitation is not None
    return not limited and train.reactive_power != "double-bridge" and train.motor_voltage == "new"


def _effort_table(train: Train, effort: EffortTable, book: CurveBook) -> Any:
    """A table at the train's current limit: rows over speed, one a voltage."""
    force_n = np.array(effort.force_kn) * 1e3
    if effort.motor_current_a is not None:
        currents = np.array(effort.motor_current_a)
        force_n = interpolate(si(train, "max_motor_current_a"), currents, force_n)
    voltages = [0.0] if effort.voltage_kv is None else si_list(effort, "voltage_kv")
    speeds = si_list(effort, "speed_kmh")
    places = [book.add(speeds, row) for row in np.atleast_2d(force_n)]
    return Table.row(
        first_row=places[0],
        rows=len(voltages),
        voltage_v=voltages + [math.inf] * (MOST_VOLTAGES - len(voltages)),
    )


def _regeneration(train: Train, book: CurveBook, limits: VoltageLimits) -> Any:
    """A row of `Regeneration`."""
    own = train.regeneration
    if own is None:
        return Regeneration.row()
    return Regeneration.row(
        highest_force_n=si(own, "max_force_kn"),
        highest_power_w=si(own, "max_power_kw"),
        none_up_to_m_s=si(own, "fade_to_kmh"),
        whole_from_m_s=si(own, "fade_from_kmh"),
        reactive_ratio=plain(reactive_ratio)(own.power_factor),
        whole_up_to_v=_si_or(own, "full_until_kv", si(limits, "umax1_kv")),
        none_from_v=_si_or(own, "zero_from_kv", si(limits, "umax2_kv")),
        efficiency=_over_speed(own.efficiency or train.efficiency, book),
        rounded_v=0.0 if system_named(limits.system).is_direct else ROUNDED_V,
        over_load=_over_load(own.efficiency_over_load, own.max_power_kw)
        if own.efficiency_over_load
        else _over_load(train.efficiency_over_load, _rated_power_kw(train)),
    )


def _rated_power_kw(train: Train) -> float:
    """Highest power of a machine that states it; else NaN: its curve over load does. [kW]"""
    effort = train.tractive_effort
    return effort.max_power_kw if isinstance(effort, EffortLimits) else math.nan


def _over_load(curve: EfficiencyOverLoad | None, rated_kw: float) -> Any:
    """A row of `LoadCurve` for loads of a power, unless the curve states another. [kW]"""
    if curve is None:
        return LoadCurve.row()
    rated_w = _si_or(curve, "rated_power_kw", rated_kw * 1e3)
    shares = si_list(curve, "load_percent")
    return lay_out_loads([share * rated_w for share in shares], list(curve.value))


def _spared_motors(train: Train) -> Any:
    """A row of `SparedMotors`."""
    rating = train.motor_rating
    if rating is None or not rating.spared:
        return SparedMotors.row()
    load = rating.short_time_a / rating.continuous_a
    return SparedMotors.row(
        continuous_a=si(rating, "continuous_a"),
        short_time_load=load,
        time_constant_s=time_to_rated_s(load, si(rating, "short_time_min")),
        initial_state=si(rating, "preload_percent") ** 2,
    )


def _on_board(train: Train) -> Any:
    """A row of `OnBoard`."""
    own = train.storage
    if own is None:
        return OnBoard.row()
    return OnBoard.row(
        store=store_of(own),
        start_j=own.soc_start * own.capacity_j,
        line_cap_w=_si_or(own, "line_power_cap_kw", math.inf),
        standing_current_a=_si_or(own, "standing_current_a", 0.0),
    )


def _line_current(train: Train) -> Any:
    """A row of `LineCurrentLimit`."""
    limit = train.current_limitation
    if limit is None:
        return LineCurrentLimit.row()
    return LineCurrentLimit.row(
        highest_current_a=si(limit, "max_current_a"),
        auxiliary_current_a=train.auxiliary_current_a,
        no_traction_voltage_v=si(limit, "umin2_kv"),
        full_current_voltage_v=limit.knee_factor * si(limit, "un_kv"),
        auxiliary_power_va=train.auxiliary_kva * 1e3 if limit.auxiliaries == "power" else 0.0,
    )


def _electric(train: Train, book: CurveBook) -> dict[str, Any]:
    """Fields of `TrainType` that describe auxiliaries, transformer, reactive power and motors."""
    auxiliary_w = si(train, "auxiliary_power_kw")
    ratio = si(train, "transformer_secondary_v") / si(train, "transformer_primary_kv")
    model, curve = ReactiveModel.POWER_FACTOR, CurvePlace.row()
    if train.reactive_power == "double-bridge":
        model = ReactiveModel.DOUBLE_BRIDGE
    elif train.power_factor is not None:
        model, curve = ReactiveModel.POWER_FACTOR_CURVE, _over_speed(train.power_factor, book)
    by_network = train.tractive_effort == "Rc4" or model != ReactiveModel.POWER_FACTOR_CURVE
    return {
        "power_factor": curve,
        "auxiliary_power_w": auxiliary_w,
        "auxiliary_reactive_power_var": auxiliary_w
        * plain(reactive_ratio)(train.auxiliary_power_factor),
        "base_speed_m_s": _si_or(train, "base_speed_kmh", math.nan),
        "highest_motor_voltage_v": _si_or(train, "max_motor_voltage_v", math.nan),
        "transformer_ratio": ratio,
        "filter_susceptance_s": ratio * ratio / _si_or(train, "filter_reactance_ohm", math.inf),
        "reactive_model": model,
        "voltage_model": MotorModel[train.motor_voltage.upper()],
        "current_model": MotorModel[train.motor_current.upper()],
        "networks": _rc4() if by_network else _no_networks(),
    }


def _over_speed(value: float | Curve, book: CurveBook) -> tuple[int, int]:
    if isinstance(value, Curve):
        return book.add(si_list(value, "speed_kmh"), value.value)
    return book.add_constant(value)


def _si_or(source: object, name: str, default: float) -> float:
    """Value of a field in SI units, or what stands for one that is left out."""
    return default if getattr(source, name) is None else si(source, name)
