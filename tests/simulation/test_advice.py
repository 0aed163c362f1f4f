"""After a stall or a collapse: what binds, and only what would help."""

import pytest

import tpss

from scenarios import short_line

UNIT = {
    "mass_t": 1500.0, "adhesive_mass_t": 80.0, "resistance_a_n": 18_000.0,
    "resistance_b_n_s_per_m": 0.0, "resistance_c_n_s2_per_m2": 5.0, "max_speed_kmh": 40.0,
    "max_retardation_m_s2": 0.3, "auxiliary_power_kw": 0.0, "power_factor": 1.0, "efficiency": 1.0,
    "max_motor_current_a": 2000.0,
    "tractive_effort": {"max_force_kn": 280.0, "max_power_kw": 4000.0},
}  # fmt: skip
"""A train by force and power, with a current limit that such a machine does not heed."""


def stalled(permille: float, unit=None, **changes) -> dict[str, str]:
    """Summary of a run in which a train cannot start on a gradient."""
    train = {**UNIT, **(unit or {})}
    line = {"line.gradients": [{"from_km": 0.0, "permille": permille}], "trains.freight": train}
    result = tpss.simulate(short_line({**line, **changes}))
    assert result.status == "stalled"
    assert result.audit["passed"]
    return result.summary


def test_where_the_rails_limit_the_adhesive_mass_helps_and_no_current():
    """Up 20 per mille: 18.0 + 1500 · 9.81 · 0.020 = 312.3 kN.  At a stand dry rails pass on
    80 · 9.81 · (0.161 + 7.5 / 44) = 260.1 kN, the machine gives 280 kN: neither is enough."""
    said = stalled(20.0)
    assert "demand 312.3 kN" in said["problem"]
    assert "The rails pass on 260.1 kN, the machine gives 280.0 kN" in said["problem"]
    assert "the rails limit it, and the machine would not be enough either" in said["problem"]
    assert said["advice"] == (
        "Lower the train's mass (mass_t), or raise its adhesive mass (adhesive_mass_t) and the force "
        "of its machine (max_force_kn)."
    )


def test_where_the_machine_would_do_only_the_rails_are_named():
    """Up 17 per mille: 18.0 + 250.2 = 268.2 kN; the machine's 280 kN are enough."""
    said = stalled(17.0)
    assert said["problem"].count("the rails limit it.") == 1
    assert "or raise its adhesive mass (adhesive_mass_t)." in said["advice"]


def test_on_wet_rails_dry_ones_are_proposed():
    said = stalled(17.0, **{"simulation.rail": "wet"})
    assert 'Dry rails (simulation.rail = "dry") pass on more.' in said["advice"]


def test_where_the_machine_limits_at_a_good_voltage_the_supply_is_not_to_blame():
    effort = {"max_force_kn": 200.0, "max_power_kw": 4000.0}
    said = stalled(17.0, {"adhesive_mass_t": 200.0, "tractive_effort": effort})
    assert "the machine gives 200.0 kN: the machine limits it." in said["problem"]
    assert "raise the force of its machine (max_force_kn)." in said["advice"]
    for useless in ("Strengthen", "adhesive", "max_motor_current_a", "rails"):
        assert useless not in said["advice"]


def test_where_a_low_voltage_weakens_the_machine_the_supply_helps():
    """At 13 kV, 3 of the 5 kV between none and full, 280 kN become 168 kN."""
    station = {
        "rating_mva": 100.0, "no_load_voltage_kv": 13.0, "droop_kv_per_mvar": 0.0,
        "generator_reactance_pu": 0.0, "generator_base_mva": 10.0, "motor_reactance_pu": 0.0,
        "motor_base_mva": 10.0, "base_voltage_kv": 16.5,
    }  # fmt: skip
    effort = {
        "max_force_kn": 280.0, "max_power_kw": 4000.0, "full_voltage_kv": 15.0, "zero_voltage_kv": 10.0,
    }  # fmt: skip
    said = stalled(
        15.0, {"tractive_effort": effort}, **{"supply.converter_stations.0.type": station}
    )
    assert "the machine gives 168.0 kN: the machine limits it." in said["problem"]
    assert "The voltage is low, which weakens the machine. Strengthen the supply" in said["advice"]


def test_an_rc4_is_advised_to_raise_its_motor_current():
    """1470 t up 15 per mille: 231.7 kN, of which the rails pass on 256.9 kN."""
    said = tpss.simulate(
        short_line({"line.gradients": [{"from_km": 0.0, "permille": 15.0}]})
    ).summary
    assert "the machine limits it." in said["problem"]
    assert "its current limit (max_motor_current_a)" in said["advice"]
    assert "Strengthen" not in said["advice"]


@pytest.mark.parametrize(("step_min", "told"), [(0.05, False), (1.0, True)])
def test_a_shorter_step_is_proposed_where_the_step_is_long(step_min, told):
    said = stalled(20.0, **{"simulation.time_step_min": step_min})
    assert ("try a shorter one" in said["advice"]) == told


def test_a_line_whose_charging_current_alone_is_too_much_is_not_told_to_reduce_the_traffic():
    """Over 600 km with 100 nF/km the open end rises by 1 / |cosh γl|, above 1.2 of the base voltage,
    with or without trains; with 9 nF/km, the line carries its train."""
    changes = {
        "line.length_km": 600.0, "line.stations.2.position_km": 600.0, "simulation.duration_min": 1.0,
        "supply.converter_stations": [
            {"name": "West", "position_km": 0.0, "type": "Q48/Q49", "converters": 2}
        ],
    }  # fmt: skip
    catenary = {"r_ohm_per_km": 0.2, "x_ohm_per_km": 0.2}
    collapsed, sound = (
        tpss.simulate(
            short_line(
                {**changes, "supply.catenary": {**catenary, "capacitance_nf_per_km": farads}}
            )
        )
        for farads in (100.0, 9.0)
    )
    assert sound.status == "finished"
    assert collapsed.status == "collapsed"
    assert (
        "not even without trains: it would have 22.73 kV at 600.00 km"
        in collapsed.summary["problem"]
    )
    assert "The charging current of its catenary" in collapsed.summary["problem"]
    assert collapsed.summary["advice"].startswith("Less traffic does not help.")
    assert "capacitance_nf_per_km" in collapsed.summary["advice"]
