"""Everything that stays as it is during a run."""

from typing import NamedTuple

from tpss.driving.data import DrivingData, Options, Profiles, Stop
from tpss.kernel import inlined
from tpss.numerics.curve import Points
from tpss.powerflow.network import Network
from tpss.record import Records
from tpss.step.halts import Halts
from tpss.step.separation import Signalling
from tpss.step.turns import Gates
from tpss.track.leg import Leg
from tpss.vehicle.train_type import TrainType


class RunControl(NamedTuple):
    """How a run differs from that of the coupled simulation of all its traffic."""

    fixed_voltage_v: float = 0.0
    """Voltage at every pantograph without a load flow, or 0 for the coupled simulation. [V]"""
    studied_train: int = -1
    """The run ends with its arrival; -1: it does not."""
    spares_motors: bool = False
    """Whether there are drivers who spare hot motors."""
    has_stores: bool = False
    """Whether trains have stores of energy on board."""


class Model(NamedTuple):
    """Everything that stays as it is during a run."""

    options: Options
    control: RunControl
    gradients: Profiles
    """Rise over run, as trains of each length feel it. [1]"""
    limits: Profiles
    """Speed limits, as trains of each length have to keep them. [m/s]"""
    neutral: Profiles
    """In neutral sections how long power stays off behind them; see `driving.neutral`. [s]"""
    coasting: Profiles
    """Speed down to which trains coast; infinite: they do not.  See `driving.coasting`. [m/s]"""
    stops: Records[Stop]
    """Shape (routes, most stops)."""
    types: Records[TrainType]
    points: Points
    """Of all curves of the trains."""
    network: Network
    legs: Records[Leg]
    """Shape (routes, most legs); what is left of a row begins nowhere."""
    signalling: Signalling
    rules: Gates
    """Gates of all routes; a route ends with one that is infinite."""
    halts: Halts


@inlined
def with_step(model: Model, step_s: float) -> Model:
    """A model with another time step. [s]"""
    options = model.options
    return Model(
        Options(
            step_s,
            options.mean_power,
            options.mean_gradient,
            options.adhesion_in_km_h,
            options.rail,
            options.driver,
            options.braking,
            options.motion,
            options.slope_change,
        ),
        model.control,
        model.gradients,
        model.limits,
        model.neutral,
        model.coasting,
        model.stops,
        model.types,
        model.points,
        model.network,
        model.legs,
        model.signalling,
        model.rules,
        model.halts,
    )


@inlined
def driving_data(model: Model) -> DrivingData:
    """The part of a model that drivers know."""
    return DrivingData(
        model.options,
        model.gradients,
        model.limits,
        model.neutral,
        model.coasting,
        model.stops,
        model.types,
    )
