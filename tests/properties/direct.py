"""Random supplies of direct current: rectifiers of every description, with inverters or none."""

from typing import Any

from hypothesis import strategies as st

from .machines import EMUS
from .ranges import numbers

Draw = Any
Document = dict[str, Any]

NOMINAL_KV = {"DC-0.75kV": 0.75, "DC-1.5kV": 1.5, "DC-3kV": 3.0, "DC-0.6kV": 0.6}

PLACE = ("name", "line", "position_km", "feeds")
"""What a station says of its place, whatever kind it is."""


@st.composite
def rectifiers(draw: Draw, nominal_kv: float) -> Document:
    """A type of rectifiers, by one of its descriptions, of 1 to 1.2 times the nominal voltage."""
    unloaded_kv = nominal_kv * draw(numbers(1.0, 1.2))
    rated_a = draw(numbers(500.0, 6_000.0))
    falls = draw(numbers(0.01, 0.15))
    kind: Document = {"rated_current_a": rated_a}
    description = draw(st.sampled_from(["line", "curve", "transformer"]))
    if description == "line":
        ohm = falls * unloaded_kv * 1e3 / rated_a
        kind |= {"no_load_voltage_kv": unloaded_kv, "resistance_ohm": ohm}
    elif description == "curve":
        shares = sorted(draw(st.lists(numbers(0.01, 1.5), min_size=1, max_size=4, unique=True)))
        points = [{"current_a": 0.0, "voltage_kv": unloaded_kv}]
        for k, share in enumerate(shares):
            voltage_kv = unloaded_kv * (1.0 - falls * (k + 1) / len(shares))
            points.append({"current_a": share * rated_a, "voltage_kv": voltage_kv})
        kind["curve"] = points
    else:
        kind["transformer"] = {
            "rated_kva": unloaded_kv * rated_a,
            "secondary_v": unloaded_kv * 1e3 / 1.35,
            "short_circuit_percent": draw(numbers(4.0, 15.0)),
            "load_loss_kw": draw(numbers(0.0, 20.0)),
        }
    if description == "transformer" and draw(st.booleans()):
        kind["transformer"] |= {"no_load_loss_kw": 5.0, "diode_loss_kw": draw(numbers(0.0, 10.0))}
    elif draw(st.integers(0, 3)) == 3:
        kind["losses"] = {"idle_kw": 3.0, "quadratic_percent": draw(numbers(0.0, 3.0))}
    if draw(st.integers(0, 3)) == 3:
        overloads = [{"percent": 150.0, "minutes": 30.0}, {"percent": 300.0, "minutes": 1.0}]
        kind["rating"] = {"time_constant_min": draw(numbers(1.0, 150.0)), "overloads": overloads}
    if description == "line" and draw(st.integers(0, 3)) == 3:
        held = {"voltage_kv": 0.98 * unloaded_kv, "droop_ohm": 0.1 * kind["resistance_ohm"]}
        kind["controlled"] = held
    return kind


@st.composite
def stations(draw: Draw, nominal_kv: float) -> Document:
    """What a station says of itself, but for its place and the number of its groups."""
    found: Document = {"type": draw(rectifiers(nominal_kv))}
    if draw(st.integers(0, 2)) == 2:
        found["inverter"] = {
            "starts_at_kv": nominal_kv * draw(numbers(1.21, 1.28)),
            "resistance_ohm": draw(numbers(0.005, 0.1)),
        }
        if draw(st.booleans()):
            found["inverter"]["max_power_kw"] = draw(numbers(100.0, 5_000.0))
    return found


@st.composite
def trains(draw: Draw, nominal_kv: float, feeds_back: bool) -> Document:
    """A train with converters, of which the line takes what it brakes up to 1.3 times the voltage."""
    train = {key: value for key, value in draw(EMUS).items() if key != "power_factor"}
    if "current_limitation" in train:
        train["current_limitation"] |= {
            "un_kv": nominal_kv,
            "umin2_kv": nominal_kv * 2.0 / 3.0,
            "max_current_a": draw(numbers(1_500.0, 6_000.0)),
            "auxiliaries": draw(st.sampled_from(["current", "power"])),
        }
        train["auxiliary_power_kw"] = min(train["auxiliary_power_kw"], 200.0)
    if feeds_back:
        width = draw(st.sampled_from([0.005, 0.02, 0.05]))
        train["regeneration"] = {
            "max_force_kn": draw(numbers(10.0, 400.0)),
            "max_power_kw": draw(numbers(100.0, 6_000.0)),
            "full_until_kv": 1.25 * nominal_kv,
            "zero_from_kv": (1.25 + width) * nominal_kv,
            "rest": draw(st.sampled_from(["friction", "rheostat"])),
        }
    return train


def into_direct_current(draw: Draw, document: Document) -> None:
    """Give a scenario the supply and the trains of a railway of direct current."""
    supply = document["supply"]
    system = draw(st.sampled_from(list(NOMINAL_KV)))
    nominal_kv = NOMINAL_KV[system]
    catenary = {"r_ohm_per_km": draw(numbers(0.002, 0.06)) * nominal_kv / 0.75}
    former = [
        *supply.pop("converter_stations", ()),
        *supply.pop("transformer_stations", ()),
    ]
    for key in ("frequency_hz", "high_voltage_line", "system"):
        supply.pop(key, None)
    supply |= {"system": system, "catenary": catenary}
    supply["rectifier_stations"] = [
        {
            **{key: station[key] for key in PLACE if key in station},
            "groups": station.get("converters", station.get("transformers", 1)),
            **draw(stations(nominal_kv)),
        }
        for station in former
    ]
    for stretch in supply.get("contact_lines", ()):
        if "catenary" in stretch:
            stretch["catenary"] = dict(catenary)
    for outage in document.get("outages", ()):
        outage.pop("transformers_km", None)
    continuous = document["simulation"].get("motion", "continuous") == "continuous"
    for name in document["trains"]:
        feeds_back = continuous and draw(st.booleans())
        document["trains"][name] = draw(trains(nominal_kv, feeds_back))
        if not continuous and isinstance(document["trains"][name]["max_retardation_m_s2"], dict):
            document["trains"][name]["max_retardation_m_s2"] = 0.7
