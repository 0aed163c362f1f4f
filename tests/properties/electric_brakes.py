"""Random electric brakes: weak and strong ones, taken by the line whole, in part, or hardly at all."""

from typing import Any

from hypothesis import strategies as st

from .ranges import numbers

Draw = Any
Document = dict[str, Any]

BRAKES = st.fixed_dictionaries(
    {"max_force_kn": numbers(1.0, 800.0), "max_power_kw": numbers(50.0, 12_000.0)},
    optional={
        "fade_from_kmh": numbers(6.0, 60.0),
        "fade_to_kmh": numbers(0.0, 5.0),
        "efficiency": numbers(0.5, 1.0),
        "power_factor": numbers(0.6, 1.0),
    },
)


def with_electric_brakes(draw: Draw, document: Document) -> None:
    """Give trains electric brakes, perhaps with a steep fall just above the stations' voltage."""
    narrow = draw(st.booleans())
    base_kv = 27.5 if str(document["supply"].get("system", "")).startswith("25kV") else 16.5
    for train in document["trains"].values():
        brakes = draw(BRAKES)
        if narrow:
            width_kv = draw(st.sampled_from([0.01, 0.1, 0.5, 1.0]))
            brakes |= {"full_until_kv": base_kv, "zero_from_kv": base_kv + width_kv}
        train["regeneration"] = brakes
