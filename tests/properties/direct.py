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
    rated_a = draw(numbers(1_500.0, 8_000.0))
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


@st.composite
def stores(draw: Draw, place: Document, nominal_kv: float, lowest_kv: float) -> Document:
    """A store of energy at a place, small ones too, which a step makes full or empty."""
    found: Document = {**place, **draw(energy_stores())}
    return found | {
        "charges_above_kv": nominal_kv * draw(numbers(1.205, 1.245)),
        "discharges_below_kv": lowest_kv * draw(numbers(0.85, 0.999)),
        "charge_kw_per_v": draw(numbers(0.0, 200.0)),
        "discharge_kw_per_v": draw(numbers(0.0, 200.0)),
    }


@st.composite
def energy_stores(draw: Draw) -> Document:
    """What every store says of itself."""
    kind = draw(st.sampled_from(["supercapacitor", "battery", "flywheel"]))
    found: Document = {"kind": kind, "power_kw": draw(numbers(1.0, 4_000.0))}
    found["soc_start"] = draw(numbers(0.0, 1.0))
    if kind == "supercapacitor":
        full_v = draw(numbers(100.0, 1_000.0))
        found |= {
            "capacitance_f": draw(numbers(1.0, 300.0)),
            "max_voltage_v": full_v,
            "min_voltage_v": full_v * draw(numbers(0.2, 0.8)),
            "max_current_a": draw(numbers(100.0, 4_000.0)),
        }
    else:
        found["capacity_kwh"] = draw(numbers(0.05, 50.0))
        found["standby_kw"] = draw(st.sampled_from([0.0, 2.0, 200.0]))
    if draw(st.booleans()):
        found["efficiency"] = draw(numbers(0.5, 1.0))
    else:
        found["charge_efficiency"] = draw(numbers(0.5, 1.0))
        found["discharge_efficiency"] = draw(numbers(0.5, 1.0))
    return found


@st.composite
def on_board(draw: Draw) -> Document:
    """A store of a train, which may help beyond a cap, and charge at stops."""
    found: Document = draw(energy_stores())
    if draw(st.booleans()):
        found["line_power_cap_kw"] = draw(numbers(50.0, 3_000.0))
    if draw(st.booleans()):
        found["standing_current_a"] = draw(numbers(10.0, 1_000.0))
    return found


def _without_contact_line(draw: Draw, document: Document) -> None:
    """Take the contact line away along a part of a line, perhaps where it is fed: then it is a fault."""
    lines = {"": document["line"]} if "line" in document else document["lines"]
    name = draw(st.sampled_from(list(lines)))
    line = lines[name]
    length_km = min(line["length_km"] / 4.0, draw(st.sampled_from([0.2, 0.8, 3.0])))
    begin_km = line.get("begins_at_km", 0.0)
    from_km = draw(numbers(begin_km, begin_km + line["length_km"] - length_km))
    stretch = {"from_km": from_km, "to_km": from_km + length_km}
    document["supply"]["without_contact_line"] = [stretch | ({"line": name} if name else {})]


def _unloaded_kv(kind: Document) -> float:
    """Voltage of a type of rectifiers without load, or a little less. [kV]"""
    if "controlled" in kind:
        return float(kind["controlled"]["voltage_kv"])
    if "curve" in kind:
        return float(kind["curve"][0]["voltage_kv"])
    transformer_kv = 1.35 * kind.get("transformer", {}).get("secondary_v", 0.0) / 1e3
    return float(kind.get("no_load_voltage_kv", transformer_kv))


def _add_stores(draw: Draw, supply: Document, nominal_kv: float) -> None:
    """Give a supply stores of energy, at its stations or beside them, or none."""
    stations = supply["rectifier_stations"]
    lowest_kv = min(_unloaded_kv(station["type"]) for station in stations)
    chosen = draw(st.lists(st.sampled_from(range(len(stations))), max_size=2, unique=True))
    placed = []
    for k in chosen:
        place = {key: stations[k][key] for key in ("line", "position_km") if key in stations[k]}
        place["name"] = f"store {k}"
        placed.append(draw(stores(place, nominal_kv, lowest_kv)))
    if placed:
        supply["storage"] = placed


def into_direct_current(draw: Draw, document: Document) -> None:
    """Give a scenario the supply and the trains of a railway of direct current."""
    supply = document["supply"]
    system = draw(st.sampled_from(list(NOMINAL_KV)))
    nominal_kv = NOMINAL_KV[system]
    catenary = {"r_ohm_per_km": draw(numbers(0.0015, 0.02)) * nominal_kv / 0.75}
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
    _add_stores(draw, supply, nominal_kv)
    for stretch in supply.get("contact_lines", ()):
        if "catenary" in stretch:
            stretch["catenary"] = dict(catenary)
    for outage in document.get("outages", ()):
        outage.pop("transformers_km", None)
    continuous = document["simulation"].get("motion", "continuous") == "continuous"
    for name in document["trains"]:
        feeds_back = continuous and draw(st.booleans())
        document["trains"][name] = draw(trains(nominal_kv, feeds_back))
        if continuous and draw(st.integers(0, 2)) == 2:
            document["trains"][name]["storage"] = draw(on_board())
        if not continuous and isinstance(document["trains"][name]["max_retardation_m_s2"], dict):
            document["trains"][name]["max_retardation_m_s2"] = 0.7
    if continuous and "neutral_sections" not in supply and draw(st.integers(0, 4)) == 4:
        _without_contact_line(draw, document)
