"""The nomenclature, in which the tables of records and of the result follow from the program.

A table stands between a comment that names it and the next ``<!-- end -->``.
"""

import ast
import inspect
import re
import textwrap
from collections.abc import Iterator
from enum import IntEnum
from functools import cache
from inspect import get_annotations
from pathlib import Path
from typing import Any

from markdown_pieces import prose, table

from tpss.driving.data import Stop
from tpss.powerflow.network import Branch, Section
from tpss.powerflow.system import System
from tpss.record import Record
from tpss.sources.kinds import Source
from tpss.step.recorded import RECORDED, Recorded
from tpss.vehicle.terms import Demand
from tpss.vehicle.train import Decision, Forces, Motion, Passage, Plan, Timetable
from tpss.vehicle.train_type import TrainType

PAGE = Path(__file__).parents[1] / "nomenclature.md"
PART = re.compile(
    r"(?<=<!-- `python docs/generate`: )(\w+)( -->\n\n).*?(?=\n\n<!-- end -->)", re.DOTALL
)
HEAD = ("symbol", "name", "meaning", "unit")
RESULT_HEAD = (*HEAD, "kind", "dimensions")

RECORDS = (
    TrainType, Demand, Timetable, Motion, Plan, Decision, Forces, Passage, Stop, System, Section, Branch,
    Source,
)  # fmt: skip
"""Classes whose fields have a table of their own."""

SYMBOLS = {
    "TrainType.mass_kg": "m",
    "TrainType.adhesive_mass_kg": "m_{adh}",
    "TrainType.inertia_kg": "M",
    "TrainType.coasting_inertia_kg": "m (1 + H)",
    "TrainType.rotor_mass_kg": "c",
    "TrainType.slip_factor": r"\kappa + 1",
    "TrainType.resistance.a_n": "A",
    "TrainType.resistance.b_n_s_per_m": "B",
    "TrainType.resistance.c_n_s2_per_m2": "C",
    "TrainType.effort.highest_current_a": "I_{D,max}",
    "TrainType.effort.table.voltage_v": "U",
    "TrainType.line_current.highest_current_a": "I_{max}",
    "TrainType.line_current.auxiliary_current_a": "I_{aux}",
    "TrainType.line_current.no_traction_voltage_v": "U_{min2}",
    "TrainType.line_current.full_current_voltage_v": "a U_n",
    "TrainType.highest_acceleration_m_s2": "a_{max}",
    "TrainType.highest_retardation_m_s2": "b",
    "TrainType.highest_speed_m_s": "v_{max}",
    "TrainType.efficiency": r"\eta",
    "TrainType.power_factor": r"\lambda",
    "TrainType.auxiliary_power_w": "P_{aux}",
    "TrainType.auxiliary_reactive_power_var": "Q_{aux}",
    "TrainType.base_speed_m_s": "v_{base}",
    "TrainType.highest_motor_voltage_v": "E_{max}",
    "TrainType.transformer_ratio": "U_{b3} / U_{b2}",
    "TrainType.filter_susceptance_s": "1 / X_f",
    "Demand.force_cap_n": r"\min(F_{ideal}, F_{adh})",
    "Demand.adhesion_n": "F_{adh}",
    "Demand.resistance_n": "F_{res}",
    "Demand.speed_m_s": "v",
    "Demand.terms_speed_m_s": "v^*",
    "Demand.mean_speed_weight_s": "h / 2",
    "Demand.driven_share": r"\tau' / h",
    "Demand.per_efficiency": r"1 / \eta",
    "Demand.reactive_ratio": "Q / P",
    "Demand.cap_power_w": "P_{motor}",
    "Demand.cap_current_a": "4 I_D",
    "Demand.voltage_v": "U",
    "Demand.wheel_force_n": "F",
    "Demand.active_power_w": "P_D",
    "Demand.reactive_power_var": "Q_D",
    "Demand.machine_force_n": "F_{max}",
    "Demand.bridge_sine": r"\beta",
    "Motion.position_m": "x",
    "Motion.speed_m_s": "v",
    "Decision.hold_s": r"\tau'",
    "Decision.brake_s": r"\sigma'",
    "Decision.force_n": "F_{ideal}",
    "Decision.acceleration_m_s2": "a",
    "Decision.resistance_n": "F_{res}",
    "Decision.braking_square_m2_s2": "w^2 + 2 b d",
    "Forces.running_resistance_n": "A + B v + C v^2",
    "Forces.gradient_n": r"m g \alpha",
    "Forces.tractive_n": "F",
    "Forces.braking_n": "F_{brake}",
    "Forces.next_speed_m_s": "v'",
    "Passage.acceleration_m_s2": "a",
    "Passage.resistance_n": "F_{res}",
    "System.nominal_voltage_v": "U_n, U_{b2}",
    "System.base_voltage_v": "U_b",
    "System.base_power_va": "S_b",
    "System.frequency_hz": "f",
    "Section.impedance_ohm_per_m": "z",
    "Section.susceptance_s_per_m": r"2 \pi f c",
    "Branch.impedance_ohm": "Z",
    "Source.installed": "n_{installed}",
    "Source.rating_va": "S_{nom}",
    "Source.converter.no_load_voltage_v": "U_0",
    "Source.converter.droop_v_per_var": "k",
    "Source.converter.generator_reactance_ohm": "X_q^g",
    "Source.converter.motor_reactance_ohm": "X_q^m",
    "Source.converter.motor_voltage_v": "U_m",
    "Source.converter.grid_reactance_ohm": "X_{50}",
    "Source.converter.grid_reactive_power_var": "Q_{50}",
    "Source.converter.grid_angle_rad": r"\theta_{50}",
    "Source.grid.no_load_voltage_v": "E",
    "Source.grid.grid_impedance_ohm": r"\frac{2 E^2}{S_k} e^{j \varphi}",
    "Source.grid.transformer_impedance_ohm": "Z_t",
}
"""Symbols of the theory and of the thesis."""

MEANINGS = {
    "TrainType.inertia_kg": (
        r"inertia with rotating parts, $m_{adh} + (m - m_{adh})(1 + H)$ or $m (1 + \rho)$"
    ),
    "TrainType.coasting_inertia_kg": "inertia of a train that the aggressive driver lets coast",
    "TrainType.rotor_mass_kg": r"inertia of the motors as a mass at the wheel rim, $4 K_J (\kappa + 1)$",
    "TrainType.slip_factor": "circumferential speed of the driven wheels over speed",
    "Demand.per_efficiency": "reciprocal of the efficiency from pantograph to motor shaft",
    "Demand.bridge_sine": "sine of the bridges' firing angle, before it is limited to 0 to 1",
    "Demand.effort_shift_n": "added to what the motors give at that speed",
    "Demand.effort_growth": (
        "added to the sum, as a share of it: it is then what the motors give at the step's mean speed"
    ),
    "Decision.resistance_n": "resistances at the end of the step before",
    "Passage.braking_ns": "impulse of the brakes",
    "Passage.running_ns": "impulse of the running resistance",
    "Passage.gradient_ns": "impulse of the gradient force",
    "Passage.braking_j": "work of the brakes",
    "Passage.running_j": "work against the running resistance",
    "Passage.gradient_j": "work against the gradient force",
}
"""Meanings of fields that have a formula in them, or follow from the field before."""


def page() -> str:
    """Text of the page with the tables as they have to be."""
    tables = {kind.__name__: table(HEAD, _rows(kind, kind.__name__, "")) for kind in RECORDS}
    tables["RECORDED"] = table(RESULT_HEAD, map(_recorded, RECORDED))
    text = PAGE.read_text("utf-8")
    found = [name for name, _ in PART.findall(text)]
    if sorted(found) != sorted(tables):
        raise SystemExit(f"{PAGE.name}: tables missing or gone: {set(tables) ^ set(found)}")
    return PART.sub(lambda part: part[1] + part[2] + tables[part[1]], text)


def _rows(record: type[Any], path: str, prefix: str) -> Iterator[tuple[str, ...]]:
    """Rows of a record's fields and of those of the records in it, but for numerical ones."""
    for name, hint in get_annotations(record).items():
        if name == "dtype":
            continue
        key, shown = f"{path}.{name}", f"{prefix}{name}"
        words, units = _words(key, _docstrings(record).get(name, ""), hint)
        symbol = SYMBOLS.get(key, "")
        yield f"${symbol}$" if symbol else "", f"`{shown}`", words, units or _code(hint)
        inside = isinstance(hint, type) and issubclass(hint, Record)
        if inside and not hint.__module__.startswith("tpss.numerics"):
            yield from _rows(hint, key, f"{shown}.")


def _words(key: str, text: str, hint: Any) -> tuple[str, str]:
    """Meaning and units of a field, from its docstring or, without one, that of its type."""
    if not (text or key in MEANINGS) and isinstance(hint, type):
        text = (inspect.getdoc(hint) or "").partition("\n\n")[0]
    words = " ".join(text.split())
    units = ", ".join(re.findall(r"\[([^\[\]]+)\](?=$|, \[)", words))
    words = MEANINGS.get(key) or re.sub(r"(,? ?\[[^\[\]]+\])+$", "", words).removesuffix(".")
    if not words:
        raise SystemExit(f"{key} has no meaning: give it a docstring")
    if re.match(r"[A-Z]([a-z]| [a-z])", words):
        words = words[0].lower() + words[1:]
    return prose(words), units


def _code(hint: Any) -> str:
    """What stands for the unit of a field without one."""
    if hint is bool:
        return "flag"
    return "code" if isinstance(hint, type) and issubclass(hint, IntEnum) else ""


@cache
def _docstrings(record: type[Any]) -> dict[str, str]:
    """Docstrings of a class's fields: the strings that follow them."""
    (body,) = ast.parse(textwrap.dedent(inspect.getsource(record))).body
    assert isinstance(body, ast.ClassDef)
    found = {}
    for field, after in zip(body.body, body.body[1:], strict=False):
        if isinstance(field, ast.AnnAssign) and isinstance(after, ast.Expr):
            assert isinstance(field.target, ast.Name)
            found[field.target.id] = ast.literal_eval(after.value)
    return found


def _recorded(each: Recorded) -> tuple[str, ...]:
    flags = ", ".join(f"{value} {meaning}" for value, meaning in enumerate(each.flags))
    return (
        f"${each.symbol}$" if each.symbol else "",
        f"`{each.name}`",
        "; ".join(filter(None, (each.words, each.remark, flags))),
        "code" if each.flags else each.unit.replace("s2", "s²"),
        "state" if each.at_instant else "interval",
        ", ".join(each.dimensions),
    )
