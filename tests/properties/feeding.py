"""Random catenaries and stations that feed them, like ones and unlike ones."""

from typing import Any

from hypothesis import strategies as st

from .ranges import numbers

Document = dict[str, Any]

OWN_CATENARIES = st.fixed_dictionaries(
    {"r_ohm_per_km": numbers(0.01, 0.5), "x_ohm_per_km": numbers(0.0, 0.5)},
    optional={
        "capacitance_nf_per_km": numbers(0.0, 30.0),
        "connection_r_ohm": numbers(0.01, 0.5),
        "connection_x_ohm": numbers(0.01, 0.5),
    },
)

FEW_CONVERTERS = {
    "converters": st.integers(1, 6),
    "control": st.sampled_from(["all-on", "loading"]),
}

CONVERTER_STATIONS = st.fixed_dictionaries(
    {"type": st.just("Q48/Q49"), **FEW_CONVERTERS},
    optional={
        "grid_reactance_ohm": numbers(0.0, 2.0),
        "grid_reactive_power_mvar": numbers(-5.0, 5.0),
        "grid_angle_deg": numbers(-10.0, 10.0),
    },
)

OWN_CONVERTERS = st.fixed_dictionaries(
    {
        "rating_mva": numbers(1.0, 100.0),
        "no_load_voltage_kv": st.one_of(numbers(16.0, 17.0), numbers(14.5, 18.0)),
        "droop_kv_per_mvar": st.one_of(st.just(0.0), numbers(0.0, 0.2)),
        "generator_reactance_pu": st.one_of(numbers(0.0, 1.0), numbers(0.0, 10.0)),
        "generator_base_mva": st.just(10.0),
        "motor_reactance_pu": numbers(0.0, 1.5),
        "motor_base_mva": st.just(10.0),
        "base_voltage_kv": st.just(16.5),
    }
)

UNLIKE_STATIONS = st.fixed_dictionaries(
    {"type": st.one_of(OWN_CONVERTERS, st.just("Q48/Q49")), **FEW_CONVERTERS},
    optional={
        "grid_reactance_ohm": st.one_of(numbers(0.0, 2.0), numbers(0.0, 100.0)),
        "grid_reactive_power_mvar": numbers(-2.0, 2.0),
        "grid_angle_deg": st.one_of(numbers(-10.0, 10.0), numbers(-60.0, 60.0)),
    },
)
"""Stations that may differ in reactance, droop, no-load voltage and angle, by a little or by much."""


TRANSFORMERS = st.fixed_dictionaries(
    {"rated_mva": numbers(5.0, 60.0)},
    optional={"load_loss_kw": numbers(0.0, 40.0)},
)


def transformer_stations(no_load_kv: tuple[float, float]) -> st.SearchStrategy[Document]:
    """Transformer stations, ideal ones too, at strong and weak grids."""
    percent = st.one_of(numbers(2.0, 20.0), numbers(2.0, 20.0), st.just(0.0))

    def with_percent(unit: Document, short_circuit_percent: float) -> Document:
        losses = {} if short_circuit_percent == 0.0 else unit
        rated = {"rated_mva": unit["rated_mva"], "short_circuit_percent": short_circuit_percent}
        return {**losses, **rated}

    return st.fixed_dictionaries(
        {
            "no_load_voltage_kv": numbers(*no_load_kv),
            "transformer": st.builds(with_percent, TRANSFORMERS, percent),
        },
        optional={
            "transformers": st.integers(1, 3),
            "grid_short_circuit_mva": numbers(200.0, 5000.0),
            "grid_r_over_x": numbers(0.0, 1.0),
        },
    )
