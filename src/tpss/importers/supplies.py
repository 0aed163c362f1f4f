"""What is assumed of the power supply of an imported network, by its electrification system."""

from collections.abc import Iterable
from typing import NamedTuple

DEFAULT_SYSTEM = "15kV-16.7Hz"
"""System of a network of which none is known."""


class AssumedSupply(NamedTuple):
    """Contact line, feeding station and train of a system, as they are written into a scenario."""

    catenary: str
    station: str
    """Of a name and a place."""
    train: str
    reach_km: float
    """No station of a network is farther from a feeding station. [km]"""


_EMU = """
# ASSUMED, edit it: a multiple unit.
[trains.{key}]
tractive_effort = {{ max_force_kn = 200.0, max_power_kw = 5000.0 }}
mass_t = 250.0
adhesive_mass_t = 150.0
rotating_mass_factor = 0.06
resistance_a_n = 3000.0
resistance_b_n_s_per_m = 80.0
resistance_c_n_s2_per_m2 = 8.0
max_speed_kmh = 160.0
max_retardation_m_s2 = 0.8
efficiency = 0.85
power_factor = 1.0
auxiliary_power_kw = 200.0
"""

_MODEL = """
# ASSUMED, edit it: a train of the library.
[trains.{{key}}]
model = "{model}"
current_limitation = {{{{ max_current_a = {highest_a:.1f} }}}}
"""

_RECTIFIERS = """
[[supply.rectifier_stations]]
name = {{name}}
{{place}}
type = "{type}"
groups = {groups}
"""

SUPPLIES = {
    "25kV-50Hz": AssumedSupply(
        "catenary = { r_ohm_per_km = 0.169, x_ohm_per_km = 0.432 }",
        """
[[supply.transformer_stations]]
name = {name}
{place}
no_load_voltage_kv = 27.5
transformer = {{ rated_mva = 30.0, short_circuit_percent = 10.0 }}
""",
        _EMU,
        30.0,
    ),
    DEFAULT_SYSTEM: AssumedSupply(
        'catenary = "BT"                     # or "AT", a table, or a file of your own',
        """
[[supply.converter_stations]]
name = {name}
{place}
type = "Q48/Q49"
converters = 3
""",
        _EMU,
        30.0,
    ),
    "DC-3kV": AssumedSupply(
        'catenary = { contact_line = "C120-2C", rails = "60E1" }',
        _RECTIFIERS.format(type="3kV-6MW-12p", groups=2),
        _MODEL.format(model="MERVAL-SFE", highest_a=1_500.0),
        10.0,
    ),
    "DC-1.5kV": AssumedSupply(
        'catenary = { contact_line = "C150-2C150", rails = "60E1" }',
        _RECTIFIERS.format(type="1.5kV-1.25MW-6p", groups=4),
        _MODEL.format(model="VIRM-6", highest_a=2_500.0),
        3.0,
    ),
    "DC-0.75kV": AssumedSupply(
        'catenary = { contact_line = "third-rail-steel-74", rails = "54E1" }',
        _RECTIFIERS.format(type="750V-2MW", groups=2),
        _MODEL.format(model="metro-278t", highest_a=5_000.0),
        1.5,
    ),
}
"""Supplies by the names of systems."""


def supply_of(system: str) -> AssumedSupply:
    """What is assumed for a system, or where none is known."""
    return SUPPLIES[system or DEFAULT_SYSTEM]


def mixed_systems(systems: Iterable[str], separated: bool) -> list[str]:
    """What is told of a network with several systems: nothing, or a line.

    Parameters
    ----------
    systems : iterable of str
        Systems of its tracks, that of the most first; empty ones are not known.
    separated : bool
        Whether it has a neutral section at all.
    """
    first, *others = [*dict.fromkeys(filter(None, systems))] or [""]
    if not others:
        return []
    where = "" if separated else ", and no neutral section separates them"
    return [
        f"electrifications of other systems, {', '.join(others)}{where}: a scenario has one system, "
        f"here {first}; give the lines of each system a scenario of their own"
    ]
