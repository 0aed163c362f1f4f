"""The way of a train through a run, held against the rules of driving and the laws of motion."""

import math
from typing import Any

import numpy as np
import pytest

from tpss import Result, library
from tpss.model.build import steps_of
from tpss.scenario.machine import RetardationBands
from tpss.step.state import TrainState

from .roundings import excess_of_braking
from .ways import along_way

ROUNDING_M_S = 2e-9
ROUNDING_M = 1e-6
STOP_ERROR_M = 1e-3


def motor_force_n(speed_kmh: float, voltage_kv: float, current_a: float) -> float:
    """Largest force of all motors: the network as it is printed, (C.1)-(C.17)."""
    net = library.networks()["tractive_effort"]
    low, high = np.array(net["input_min"]), np.array(net["input_max"])
    scaled = 2.0 * (np.array([speed_kmh, voltage_kv, current_a]) - low) / (high - low) - 1.0
    hidden = np.tanh(np.array(net["b1"]) + np.array(net["W1"]) @ scaled)
    output = net["b2"] + np.array(net["w2"]) @ hidden
    return float(net["output_min"] + (output + 1.0) / 2.0 * (net["output_max"] - net["output_min"]))


class Journey:
    """The way of one train, and the rules that it has to keep."""

    def __init__(self, result: Result, name: str) -> None:
        data = result.dataset
        i = data.train.to_numpy().tolist().index(name)
        self.name = name
        self.step_s = float(data.attrs["time_step_s"])
        self.driver = result.scenario.simulation.driver
        self.kept_apart = result.scenario.signalling.separation != "none"
        self.continuous = result.scenario.simulation.how_trains_move == "continuous"
        self.brakes_within_steps = result.scenario.simulation.braking == "within-step"
        calls = data.isel(train=i)
        self.arrived_s = calls.call_arrival_time.to_numpy()
        self.went_on_s = calls.call_departure_time.to_numpy()
        # Where trains may be late, their times stay those of the schedule.
        self.departed_s = float(calls.departure_time - calls.departure_delay)
        rows = np.flatnonzero(np.isfinite(data.position.to_numpy()[:, i]))
        assert (np.diff(rows) == 1).all(), f"{self.name} is away for a while"
        self.time_s = data.time.to_numpy()[rows]
        self.x, self.v, self.braking, self.a, self.state = (
            data[name].to_numpy()[rows, i]
            for name in ("route_position", "speed", "braking_force", "acceleration", "train_state")
        )
        service = str(data.service.to_numpy()[i])
        self.entry = next(entry for entry in result.scenario.traffic if entry.name == service)
        self.train = result.scenario.trains[self.entry.train]
        way = along_way(result.scenario, self.entry)
        self.stops_m, self.end_m = way.stops_m, way.end_m
        self.limit_m = np.array([from_m for from_m, _ in way.limits])
        limits = [min(speed_kmh, self.train.max_speed_kmh) for _, speed_kmh in way.limits]
        self.limit = np.array(limits) / 3.6
        self.keep_limits_until_the_tail_has_passed()
        self.force, self.volts, resistance, climb = (
            data[name].to_numpy()[rows, i]
            for name in (
                "tractive_force", "pantograph_voltage", "running_resistance", "gradient_force"
            )
        )  # fmt: skip
        self.opposing = resistance + climb
        self.lines = list(result.scenario.lines_by_name.values())
        self.line_names = list(result.scenario.lines_by_name)
        self.neutral_sections = result.scenario.supply.neutral_sections
        self.length_km = self.train.length_m / 1e3
        self.km = data["position"].to_numpy()[rows, i] / 1e3
        told = (
            data["train_line"].to_numpy()[rows, i] if "train_line" in data else np.zeros(rows.size)
        )
        self.on_line = told.astype(int)
        self.wet = result.scenario.simulation.rail == "wet"
        self.adhesion_in_km_h = result.scenario.simulation.adhesion_speed_unit == "km/h"

    def keep_limits_until_the_tail_has_passed(self) -> None:
        """Replace the limits by the lowest ones under the train."""
        length_m = self.train.length_m
        if length_m == 0.0:
            return
        ends_m = [*(self.limit_m[1:] + length_m), math.inf]
        limits = list(zip(self.limit_m, ends_m, self.limit, strict=True))
        self.limit_m = np.array(sorted({*self.limit_m.tolist(), *ends_m[:-1]}))
        self.limit = np.array(
            [min(limit for begin, end, limit in limits if begin <= x < end) for x in self.limit_m]
        )

    def judge(self) -> None:
        """All rules; the aggressive driver does not keep to limits, nor aims at them.

        Full effort is known here for the network's machine; tables and limits have closed forms in
        their own tests.
        """
        regulated = self.driver == "regulated"
        if regulated:
            self.keeps_to_the_limits()
        self.moves_forwards()
        self.brakes_no_harder_than_it_may()
        free = self.train.tractive_effort == "Rc4" and self.train.current_limitation is None
        rating = self.train.motor_rating
        free &= self.train.driver is None  # who may want less than the limits
        free &= not self.kept_apart and not (rating is not None and rating.spared)
        if regulated and free and self.continuous:
            self.gives_all_it_can_between_two_speeds()
        elif regulated and free:
            self.gives_all_it_can()
        if self.continuous:
            self.stops_and_dwells_to_the_second()
        else:
            self.stops_and_dwells()

    def keeps_to_the_limits(self) -> None:
        """At every instant; a step that passes a limit's position begins and ends at or below it.

        In continuous motion a train brakes to a limit, and goes on from it, within a step.
        """
        holds = self.limit[np.searchsorted(self.limit_m, self.x, side="right") - 1]
        excess = (self.v - holds).max()
        assert excess <= ROUNDING_M_S, f"{self.name} is {excess} m/s above its limit"
        if self.continuous:
            return
        for place, limit in zip(self.limit_m, self.limit, strict=True):
            passes = (self.x[:-1] < place - ROUNDING_M) & (self.x[1:] > place + ROUNDING_M)
            speeds = np.maximum(self.v[:-1], self.v[1:])[passes]
            assert speeds.max(initial=0.0) <= limit + ROUNDING_M_S, (
                f"{self.name} passes {place} m, limited to {limit} m/s, at {speeds} m/s"
            )

    def moves_forwards(self) -> None:
        """No reversal."""
        assert self.v.min() >= 0.0, f"{self.name} runs backwards"
        assert np.diff(self.x).min(initial=0.0) >= 0.0, f"{self.name} moves backwards"

    def brakes_no_harder_than_it_may(self) -> None:
        """Where its brakes act; a gradient may be steeper than they are strong."""
        from_m_s, retardation = self.retardation
        brakes, excess = self.braking[:-1] > 0.0, np.zeros(self.x.size)
        if self.brakes_within_steps and not self.continuous:
            excess = excess_of_braking(self.x, np.array([*self.stops_m, self.end_m]), brakes)
        for k in np.flatnonzero(brakes):
            hardest = -self.a[k]
            slower = min(
                self.v[k], self.v[k + 1]
            )  # within a long step it may be faster than at its ends
            highest = retardation[np.append(from_m_s[1:], np.inf) >= slower].max()
            assert hardest <= highest * (1.0 + 1e-9 + excess[k]) + 1e-12, (
                f"{self.name} brakes by {hardest} m/s²"
            )

    @property
    def retardation(self) -> tuple[Any, Any]:
        """Speeds from which its highest retardations hold, and these. [m/s], [m/s²]"""
        given = self.train.max_retardation_m_s2
        if isinstance(given, RetardationBands):
            return np.array(given.from_speed_kmh) / 3.6, np.array(given.retardation_m_s2)
        return np.zeros(1), np.array([given])

    def gives_all_it_can(self) -> None:
        """Well before its next stop and lower limits, a train reaches its limit, or gives all it can.

        That is what adhesion allows at its speed, and the machine at its voltage.
        """
        ends = [*self.stops_m, self.end_m]
        for k in np.flatnonzero((self.state[:-1] >= 0) & (self.state[:-1] != TrainState.DWELLING)):
            limit = self.limit[np.searchsorted(self.limit_m, self.x[k], side="right") - 1]
            if abs(self.v[k + 1] - limit) < ROUNDING_M_S:
                continue
            well_m = limit * (8.0 * self.step_s + 2.0 * limit / self.retardation[1].min())
            ahead = (self.limit_m > self.x[k]) & (self.limit_m < self.x[k] + well_m)
            # A train may begin within a rounding of its last stop.
            to_stop_m = min((end for end in ends if end > self.x[k]), default=self.x[k]) - self.x[k]
            if to_stop_m < well_m or (self.limit[ahead] < limit).any():
                continue
            most = self.largest_force_n(k)
            assert self.force[k] == pytest.approx(most, rel=1e-9, abs=1e-6), (
                f"{self.name} gives {self.force[k]} N of {most} N at {self.x[k]} m"
            )

    def gives_all_it_can_between_two_speeds(self) -> None:
        """In a step that accelerates below the limit, the mean force is one that belongs to its speeds.

        Adhesion and machine fall with the speed, but for the ripples of the network; resistances, which
        the rotors add a little of, change too.  Where the gradient changes, the train may have been
        faster or slower on the way.
        """
        for k in np.flatnonzero(self.state[:-1] == TrainState.MOTORING):
            here = np.searchsorted(self.limit_m, self.x[k : k + 2], side="right") - 1
            v, after = self.v[k], self.v[k + 1]
            if (
                not 0.0 < v < after
                or here[0] != here[1]
                or after >= self.limit[here[0]] - ROUNDING_M_S
            ):
                continue
            if self.near_a_stop(k) or self.braking[k] > 0.0 or self.meets_a_neutral_section(k):
                continue
            if self.spares_time and not self.goes_on_accelerating(k):
                continue
            beyond = self.beyond_both_ends_m_s(k)
            slowest, fastest = max(0.0, v - beyond), min(after + beyond, self.limit[here[0]])
            speeds = np.linspace(slowest, fastest, 21)
            most = [self.largest_force_n(k, speed) for speed in speeds]
            slack = 1e-3 * max(most) + 1.0
            assert min(most) - slack <= self.force[k] <= max(most) + slack, (
                f"{self.name} gives {self.force[k]} N of {min(most)} to {max(most)} N at {self.x[k]} m"
            )

    @property
    def spares_time(self) -> bool:
        """Whether it may hold less speed than the limit, or coast."""
        given = self.entry.supplement_percent, self.entry.supplement_min_per_100km
        return self.entry.spare_time is not None or any(given)

    def goes_on_accelerating(self, k: int) -> bool:
        """Whether it does so in the step after step `k`: it has not come to a speed that it holds."""
        again = k + 2 < len(self.v) and self.v[k + 2] > self.v[k + 1] + ROUNDING_M_S
        return bool(again and self.state[k + 1] == TrainState.MOTORING)

    def beyond_both_ends_m_s(self, k: int) -> float:
        """How far its speed may pass those at both ends of step `k`: no further than by a quarter of
        its length times the range of the accelerations, which gradients differ by."""
        line, ends_km = self.lines[self.on_line[k]], sorted(self.km[k : k + 2])
        if self.on_line[k] != self.on_line[k + 1]:  # over the whole of all of them
            gradients = [each.permille for other in self.lines for each in other.gradients]
        else:
            begin_km, end_km = ends_km[0] - self.length_km, ends_km[1] + self.length_km
            ends = [*(each.from_km for each in line.gradients[1:]), math.inf]
            gradients = [
                each.permille
                for each, until_km in zip(line.gradients, ends, strict=True)
                if each.from_km < end_km and until_km > begin_km
            ]
        range_m_s2 = 9.81e-3 * (max(gradients) - min(gradients))
        return float(range_m_s2 * (self.time_s[k + 1] - self.time_s[k]) / 4.0)

    def meets_a_neutral_section(self, k: int) -> bool:
        """Whether its power may be off in a part of step `k`: in a neutral section, or behind it."""
        begin_km, end_km = sorted(self.km[k : k + 2])
        names = (None, self.line_names[self.on_line[k]], self.line_names[self.on_line[k + 1]])
        return any(
            section.line in names
            and begin_km < section.to_km + (fastest_km := self.limit.max() * section.raise_s / 1e3)
            and end_km > section.from_km - fastest_km
            for section in self.neutral_sections
        )

    def near_a_stop(self, k: int) -> bool:
        """Whether a train may brake for a stop or limit, or have stood at one, in step `k`."""
        ends = [*self.stops_m, self.end_m]
        fastest = self.limit.max()
        room_m = fastest * (2.0 * self.step_s + fastest / self.retardation[1].min())
        ahead = (self.limit_m > self.x[k]) & (self.limit_m < self.x[k] + room_m)
        at_stop = any(self.x[k] <= end <= self.x[k] + room_m for end in ends)
        return at_stop or bool((self.limit[ahead] < fastest).any())

    def largest_force_n(self, k: int, speed_m_s: float | None = None) -> float:
        """Force at the wheel rim in step `k` with full effort: adhesion, machine, never negative."""
        speed_m_s = self.v[k] if speed_m_s is None else speed_m_s
        train, v = self.train, speed_m_s * (3.6 if self.adhesion_in_km_h else 1.0)
        share = 3.78 / (23.6 + v) if self.wet else 0.161 + 7.5 / (44.0 + 3.6 * v)
        if isinstance(train.adhesion, float):
            share = train.adhesion
        elif train.adhesion is not None:  # through two points it is a line
            share = np.interp(3.6 * speed_m_s, train.adhesion.speed_kmh, train.adhesion.value)
        motors = motor_force_n(3.6 * speed_m_s, self.volts[k] / 1e3, train.max_motor_current_a)
        hauled_kg = 1e3 * (train.mass_t - train.adhesive_mass_t)
        inertia_kg = 1e3 * train.adhesive_mass_t + hauled_kg * (1.0 + train.rotating_mass_factor)
        if train.rotating_mass_share is not None:
            inertia_kg = 1e3 * train.mass_t * (1.0 + train.rotating_mass_share)
        rotors = train.motor_inertia_kg * (1.0 + train.slip) / inertia_kg
        machine = (max(0.0, motors) + rotors * self.opposing[k]) / (1.0 + rotors)
        return max(0.0, min(1e3 * train.adhesive_mass_t * 9.81 * share, machine))

    def stops_and_dwells_to_the_second(self) -> None:
        """At each stop it meets: within a millimetre at the instants, and for its dwell."""
        for call, stop in enumerate(self.entry.stops):
            place, dwell_s = self.stops_m[call], 60.0 * max(stop.dwell_min, stop.turn_min or 0.0)
            if self.x[0] >= place - ROUNDING_M or self.x[-1] <= place + STOP_ERROR_M:
                continue
            stood_s = self.went_on_s[call] - self.arrived_s[call]
            if stop.depart_after_min is not None:
                if math.isnan(self.departed_s):  # it was on the line at the start
                    assert stood_s >= dwell_s - 1e-6, f"{self.name} dwells {stood_s} s at {place} m"
                    continue
                leaves_s = self.departed_s + 60.0 * stop.depart_after_min
                dwell_s = max(dwell_s, leaves_s - self.arrived_s[call])
            assert stood_s == pytest.approx(dwell_s, rel=1e-9, abs=1e-6), (
                f"{self.name} dwells {stood_s} s at {place} m"
            )
        dwelling = (self.state == TrainState.DWELLING) & (not self.kept_apart)
        dwelling &= self.volts != 0.0
        places = np.array(self.stops_m)
        for x in self.x[dwelling]:
            assert np.abs(places - x).min(initial=math.inf) < STOP_ERROR_M, (
                f"{self.name} stands at {x}"
            )

    def stops_and_dwells(self) -> None:
        """At each stop it meets: within a millimetre, for the steps of its dwell."""
        stops = [
            (
                place_m,
                steps_of(60.0 * max(stop.dwell_min, stop.turn_min or 0.0), self.step_s),
                60.0 * (stop.depart_after_min or 0.0),
            )
            for stop, place_m in zip(self.entry.stops, self.stops_m, strict=True)
        ]
        for place, dwell, leaves_s in [*stops, (self.end_m, 0, 0.0)]:
            stood = (np.abs(self.x - place) < STOP_ERROR_M) & (self.v == 0.0)
            left = self.x[-1] > place + STOP_ERROR_M
            if self.x[0] >= place - ROUNDING_M or not (left or stood.any()):
                continue
            assert stood.any(), f"{self.name} runs through its stop at {place} m"
            if left:
                dwelled = int((self.state[stood] == TrainState.DWELLING).sum())
                if leaves_s > 0.0:
                    if math.isnan(self.departed_s):
                        assert dwelled >= dwell, f"{self.name} dwells {dwelled} steps at {place} m"
                        continue
                    arrived_s = float(self.time_s[np.flatnonzero(stood)[0]])
                    early_s = self.departed_s + leaves_s - arrived_s
                    dwell = max(dwell, steps_of(early_s, self.step_s))
                assert dwelled == dwell, f"{self.name} dwells {dwelled} steps at {place} m"
