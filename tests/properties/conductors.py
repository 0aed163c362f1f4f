"""Random lines whose rails, and perhaps feeders, are conductors of their own."""

from random import Random
from typing import Any

from hypothesis import strategies as st

from .ranges import numbers

Draw = Any
Document = dict[str, Any]


def matrices(draw: Draw, with_feeder: bool) -> Document:
    """Conductors of a track: each has its own impedance, and any two the same in common."""
    names = ["contact", "rails", *(["feeder"] if with_feeder else [])]
    common_r, common_x = draw(numbers(0.0, 0.06)), draw(numbers(0.1, 0.4))
    own = [(draw(numbers(0.05, 0.2)), draw(numbers(0.05, 0.4))) for _ in names]
    size = range(len(names))
    table: Document = {
        "names": names,
        "r_ohm_per_km": [[common_r + own[i][0] * (i == j) for j in size] for i in size],
        "x_ohm_per_km": [[common_x + own[i][1] * (i == j) for j in size] for i in size],
    }
    if draw(st.booleans()):
        table["b_us_per_km"] = [[3.0 if i == j else -0.5 for j in size] for i in size]
    return table


def take_apart(draw: Draw, document: Document) -> None:
    """Give a scenario's supply of direct current, or of 25 kV, conductors of their own."""
    supply = document["supply"]
    direct = supply["system"].startswith("DC")
    leaks = draw(st.sampled_from([0.1, 0.01, 2.0, 0.0]))
    supply["conductors"] = {
        "leakage_s_per_km": leaks,
        "nodes_every_km": draw(st.sampled_from([5.0, 100.0, 1.0])),
    }
    with_feeder = not direct and draw(st.booleans())
    owners = [supply, *(each for each in supply.get("contact_lines", ()) if "catenary" in each)]
    conductors = None if direct else matrices(draw, with_feeder)
    for owner in owners:
        if direct:
            ohm = owner["catenary"]["r_ohm_per_km"]
            owner["catenary"] = {
                "contact_line": {"r_ohm_per_km": max(0.0005, 0.4 * ohm)},
                "rails": {"r_ohm_per_km": max(0.0005, 0.6 * ohm)},
            }
        else:
            owner["catenary"] = {
                "r_ohm_per_km": 0.15, "x_ohm_per_km": 0.4, "conductors": conductors,
            }  # fmt: skip
    key = "rectifier_stations" if direct else "transformer_stations"
    for k, station in enumerate(supply[key]):
        if (k == 0 and leaks == 0.0) or draw(st.integers(0, 3)) == 3:
            station["rail_earthing_ohm"] = draw(numbers(0.05, 5.0))
        if with_feeder and (k == 0 or draw(st.booleans())):
            station["secondary"] = "2x"
    if with_feeder:
        give_autotransformers(Random(repr(document)), document)


def give_autotransformers(draw: Random, document: Document) -> None:
    """Let some autotransformers stand on a line; now and then too near to something else."""
    lines = {"": document["line"]} if "line" in document else document["lines"]
    name = draw.choice(list(lines))
    begin_km, length_km = lines[name].get("begins_at_km", 0.0), lines[name]["length_km"]
    shares = sorted(draw.uniform(0.05, 0.95) for _ in range(draw.randint(0, 2)))
    if shares:
        document["supply"]["autotransformers"] = [
            {
                **({"line": name} if name else {}),
                "positions_km": [begin_km + share * length_km for share in shares],
                "rated_mva": draw.uniform(2.0, 20.0),
                "short_circuit_percent": draw.uniform(0.3, 3.0),
                "no_load_current_percent": draw.choice([0.0, 0.3]),
            }
        ]


def of_25_kv_or_direct(document: Document) -> bool:
    """Whether a supply is one that knows conductors of their own."""
    supply = document["supply"]
    system = supply.get("system", "")
    return system.startswith("DC") or (system == "25kV-50Hz" and "high_voltage_line" not in supply)
