r"""The least energy of a train from stop to stop, by a slow dynamic program over place and speed.

A train of the mass m (with rotating parts) has the energy E = v²/2 a kilogram.  On a way ds with the
force f a kilogram, of which resistances take r(v) + g α,

.. math:: dE/ds = f - r(v) - g \alpha, \qquad dt = ds / v .

For a price λ of time the cost of the rest of the way, from stop to stop, is

.. math:: W(s, E) = \min_f \; (\max(f, 0) / \eta) \, ds + \lambda \, dt + W(s + ds, E + dE),

with W = 0 at the stop for a train that stands, and no way on for one that does not.  For each λ,
W(0, 0) - λ T bounds the energy of each way that takes the time T from below, whatever it is; the highest
of these bounds is the least energy, as far as that falls evenly with the time.
"""

from dataclasses import dataclass

import numpy as np

G = 9.81

FORBIDDEN = 1e6
"""Cost of what leads nowhere. [J/kg]"""


@dataclass(frozen=True)
class Vehicle:
    """A train by a kilogram: forces [N/kg], power [W/kg], resistance a + b v + c v² [N/kg]."""

    highest_force: float
    highest_power: float
    braking: float
    resistance: tuple[float, float, float]
    efficiency: float


def least_cost(
    vehicle: Vehicle, way_m: float, slope: float, fastest_m_s: float, price: float,
    places: int = 1500, levels: int = 1200, last_m: float = 50.0,
) -> float:  # fmt: skip
    """W(0, 0): energy at the pantograph and price of the time, from stop to stop. [J/kg]

    On the last metres a train holds its speed, and then brakes with all it may.
    """
    ds = (way_m - last_m) / places
    # Speeds lie evenly: there the time changes most with the energy where that is low.
    speed = np.linspace(0.0, fastest_m_s, levels)
    energy = speed**2 / 2.0
    a, b, c = vehicle.resistance
    against = a + b * speed + c * speed**2 + G * slope
    pull = np.minimum(vehicle.highest_force, vehicle.highest_power / np.maximum(speed, 1e-9))
    # What a train may do: a share of its pull, hold its speed, coast, brake.
    forces = [share * pull for share in np.linspace(0.0, 1.0, 11)]
    forces += [np.clip(against, 0.0, pull)]
    forces += [against - share * vehicle.braking for share in np.linspace(0.1, 1.0, 10)]
    held_m = np.maximum(last_m - energy / vehicle.braking, 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        time = held_m / speed + speed / vehicle.braking
        work = held_m * np.maximum(against, 0.0) / vehicle.efficiency
        cost_to_go = np.where(speed > 0.0, price * time + work, FORBIDDEN)
    for place in range(places - 1, -1, -1):
        allowed = vehicle.braking * (way_m - (place + 1) * ds) * (1.0 + 1e-9)
        best = np.full(levels, FORBIDDEN)
        for force in forces:
            after = energy + (force - against) * ds
            mean = (speed + np.sqrt(2.0 * np.maximum(after, 0.0))) / 2.0
            valid = (after >= 0.0) & (after <= min(energy[-1], allowed)) & (mean > 0.0)
            time = ds / np.where(valid, mean, 1.0)
            own = np.maximum(force, 0.0) / vehicle.efficiency * ds + price * time
            cost = own + np.interp(after, energy, cost_to_go)
            best = np.minimum(best, np.where(valid, cost, FORBIDDEN))
        cost_to_go = best
    return float(cost_to_go[0])
