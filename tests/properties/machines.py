"""Random trains: locomotives with the network of the Rc4, and machines of every other description."""

from typing import Any

from hypothesis import strategies as st

from .ranges import numbers

Draw = Any
Document = dict[str, Any]


@st.composite
def retardations(draw: Draw, lowest: float, highest: float) -> Any:
    """A highest retardation: mostly a number, else one for each band of speeds."""
    if draw(st.integers(0, 4)) < 4:
        return draw(numbers(lowest, highest))
    speeds = draw(st.lists(numbers(1.0, 250.0), max_size=4, unique=True))
    each = st.lists(numbers(lowest, highest), min_size=len(speeds) + 1, max_size=len(speeds) + 1)
    return {"from_speed_kmh": [0.0, *sorted(speeds)], "retardation_m_s2": draw(each)}


TRAINS = st.fixed_dictionaries(
    {"model": st.just("Rc4-freight-1470t")},
    optional={
        "mass_t": numbers(80.0, 2500.0),
        "adhesion": numbers(0.05, 0.4),
        "length_m": st.sampled_from([0.0, 25.0, 700.0]),
        "max_motor_current_a": st.sampled_from([150.0, 700.0, 1250.0, 2080.0, 2500.0, 5000.0]),
        "max_retardation_m_s2": retardations(0.05, 2.0),
        "max_speed_kmh": numbers(20.0, 250.0),
        "efficiency": numbers(0.5, 1.0),
        "auxiliary_power_kw": st.one_of(numbers(0.0, 800.0), numbers(1000.0, 6000.0)),
        "auxiliary_power_factor": numbers(0.5, 1.0),
        "reactive_power": st.sampled_from(["power-factor", "double-bridge"]),
        "motor_voltage": st.sampled_from(["new", "former"]),
        "motor_current": st.sampled_from(["new", "former"]),
        "rotating_mass_factor": numbers(0.0, 0.3),
        "motor_inertia_kg": numbers(0.0, 20_000.0),
        "slip": numbers(0.0, 0.2),
        "resistance_a_n": numbers(0.0, 40_000.0),
        "resistance_b_n_s_per_m": numbers(0.0, 1000.0),
        "resistance_c_n_s2_per_m2": numbers(0.0, 200.0),
        "base_speed_kmh": numbers(20.0, 200.0),
        "filter_reactance_ohm": numbers(-5.0, -0.2),
        "current_limitation": st.fixed_dictionaries(
            {"max_current_a": st.one_of(numbers(900.0, 2000.0), st.just(900.0))},
            optional={"knee_factor": numbers(0.8, 1.0), "umin2_kv": numbers(9.0, 11.9)},
        ),
    },
)


def _pull_out_beyond_the_knee(
    max_force_kn: float, max_power_kw: float, limit_speed_kmh: float | None = None
) -> Document:
    """The limit speed, raised to that from which power limits; nothing, if there is none."""
    if limit_speed_kmh is None:
        return {}
    return {"limit_speed_kmh": max(limit_speed_kmh, 3.6 * max_power_kw / max_force_kn)}


EMUS = st.fixed_dictionaries(
    {
        "tractive_effort": st.fixed_dictionaries(
            {"max_force_kn": numbers(50.0, 400.0), "max_power_kw": numbers(500.0, 9000.0)},
            optional={"limit_speed_kmh": numbers(80.0, 300.0)},
        ).map(lambda effort: effort | _pull_out_beyond_the_knee(**effort)),
        "mass_t": numbers(80.0, 900.0),
        "adhesive_mass_t": numbers(40.0, 80.0),
        "resistance_a_n": numbers(0.0, 10_000.0),
        "resistance_b_n_s_per_m": numbers(0.0, 300.0),
        "resistance_c_n_s2_per_m2": numbers(0.0, 20.0),
        "max_speed_kmh": numbers(40.0, 300.0),
        "max_retardation_m_s2": retardations(0.2, 1.5),
        "efficiency": numbers(0.6, 1.0),
        "auxiliary_power_kw": numbers(0.0, 800.0),
        "power_factor": numbers(0.8, 1.0),
    },
    optional={
        "max_acceleration_m_s2": numbers(0.2, 1.5),
        "rotating_mass_factor": numbers(0.0, 0.2),
        "length_m": st.sampled_from([0.0, 25.0, 700.0]),
        "current_limitation": st.fixed_dictionaries(
            {"max_current_a": numbers(300.0, 1000.0)},
            optional={"knee_factor": numbers(0.8, 1.0)},
        ).map(lambda limit: {**limit, "un_kv": 25.0, "umin2_kv": 17.5}),
    },
)
"""Trains with converters, whose auxiliaries stay within their current limitation."""


@st.composite
def effort_tables(draw: Draw) -> Document:
    """Forces over speed, perhaps over voltage too, as steep and as uneven as it comes."""
    speeds = st.lists(numbers(0.0, 200.0), min_size=2, max_size=5, unique=True)
    table: Document = {"speed_kmh": sorted(draw(speeds))}
    row = st.lists(numbers(0.0, 400.0), min_size=len(table["speed_kmh"]),
                   max_size=len(table["speed_kmh"]))  # fmt: skip
    if not draw(st.booleans()):
        return {**table, "force_kn": draw(row)}
    voltages = sorted(draw(st.lists(numbers(8.0, 18.0), min_size=2, max_size=4, unique=True)))
    rows = [draw(row) for _ in voltages]
    return {**table, "voltage_kv": voltages, "force_kn": rows}


@st.composite
def efforts_over_voltage(draw: Draw) -> Document:
    """Force and power that fall with the voltage, gently or within some hundred volts."""
    full_kv = draw(numbers(10.0, 16.0))
    return {
        "max_force_kn": draw(numbers(50.0, 400.0)),
        "max_power_kw": draw(numbers(500.0, 9000.0)),
        "full_voltage_kv": full_kv,
        "zero_voltage_kv": full_kv - draw(st.one_of(numbers(1.0, 8.0), numbers(0.1, 1.0))),
    }


@st.composite
def knees(draw: Draw) -> Document:
    """A limit of the current that falls from a knee on, steeply or over half of the voltage."""
    factor = draw(numbers(0.6, 1.0))
    return {
        "max_current_a": draw(numbers(100.0, 1000.0)),
        "umin2_kv": 15.0 * factor * draw(numbers(0.6, 0.99)),
        "knee_factor": factor,
    }


BRIDGES = st.fixed_dictionaries(
    {
        "reactive_power": st.just("double-bridge"),
        "base_speed_kmh": numbers(20.0, 200.0),
        "max_motor_voltage_v": numbers(300.0, 1500.0),
    }
)

ODD_TRAINS = st.builds(
    lambda train, bridges: {**train, **bridges},
    st.fixed_dictionaries(
        {
            "tractive_effort": st.one_of(effort_tables(), efforts_over_voltage()),
            "mass_t": numbers(40.0, 2000.0),
            "adhesive_mass_t": numbers(20.0, 40.0),
            "resistance_a_n": numbers(0.0, 20_000.0),
            "resistance_b_n_s_per_m": numbers(0.0, 500.0),
            "resistance_c_n_s2_per_m2": numbers(0.0, 50.0),
            "max_speed_kmh": numbers(20.0, 250.0),
            "max_retardation_m_s2": retardations(0.1, 1.5),
            "efficiency": numbers(0.5, 1.0),
            "auxiliary_power_kw": numbers(0.0, 300.0),
            "auxiliary_power_factor": numbers(0.5, 1.0),
            "power_factor": numbers(0.3, 1.0),
        },
        optional={
            "max_acceleration_m_s2": numbers(0.1, 1.5),
            "rotating_mass_factor": numbers(0.0, 0.2),
            "filter_reactance_ohm": st.one_of(numbers(-5.0, -0.2), numbers(-100.0, -5.0)),
            "current_limitation": knees(),
        },
    ),
    st.one_of(st.just({}), BRIDGES),
)
"""Trains whose force is a table or falls with the voltage, with limits that have knees."""
