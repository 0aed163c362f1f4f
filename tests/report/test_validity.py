"""A report says how far the trains that ran can be trusted, and nothing of others."""

from tpss.report.validity import limits_of_validity

from scenarios import short_line

SHORT = {"simulation.duration_min": 1.0}
LIMITS = {"trains.freight.tractive_effort": {"max_force_kn": 200.0, "max_power_kw": 2600.0},
          "trains.freight.power_factor": 0.95}  # fmt: skip
TABLE = {**LIMITS, "trains.freight.tractive_effort": {
    "speed_kmh": [0, 120], "voltage_kv": [12, 16], "force_kn": [[200, 40], [220, 60]]}}  # fmt: skip


def said(*changes):
    return " ".join(limits_of_validity([short_line({**SHORT, **each}) for each in changes]))


def test_networks_are_told_of_trains_that_have_them():
    assert said({}).count("Rc4") == 1
    assert "Rc4" not in said(LIMITS)
    assert said({}, LIMITS).count("Rc4") == 1


def test_a_table_has_its_own_range():
    assert "a table for 0 to 120 km/h and 12 to 16 kV; beyond it the outer" in said(TABLE)


def test_force_and_power_depend_on_the_voltage_or_do_not():
    limited = {**LIMITS, "trains.freight.current_limitation": {"max_current_a": 300.0}}
    assert "does not depend on the voltage" in said(LIMITS)
    assert "does not depend on the voltage" not in said(limited)
    assert "auxiliaries are never shed" in said(limited)


def test_the_method_is_told_of_every_run():
    assert "No transients" in said(LIMITS)


def test_what_trips_and_what_is_refused_is_told_of_those_that_know_it():
    """Nothing is said to be left out that the run has."""
    rating = {"time_constant_min": 5.0, "overloads": [{"percent": 120.0, "minutes": 2.0}]}
    wire = {"r_ohm_per_km": 0.2, "x_ohm_per_km": 0.2, "rating": {"continuous_a": 500.0, **rating}}
    moves = {"simulation.motion": None, "simulation.braking": None}
    protected = said({**moves, "supply.catenary": wire, "protection": {"trip": True}})
    assert "Nothing trips" in said({})
    assert "Nothing trips" not in protected
    assert "trips; equipment without overloads" in protected
    brakes = {"max_force_kn": 100.0, "max_power_kw": 2000.0}
    assert "the line refuses" not in said({})
    assert "the line refuses" in said({**moves, **LIMITS, "trains.freight.regeneration": brakes})


def test_motors_with_a_rating_are_monitored_and_judged_once_a_run_has_ended():
    motor = {"continuous_a": 1250.0, "short_time_a": 2080.0, "short_time_min": 6.0}
    assert "not monitored" in said({})
    assert "judged once a run has ended" not in said({})
    rated = said({"trains.freight.motor_rating": motor})
    assert "not monitored" not in rated
    assert "judged once a run has ended" in rated


def test_grids_are_told_of_lines_whose_stations_know_their_phases():
    station = {
        "name": "Grid", "position_km": 15.0, "no_load_voltage_kv": 16.0,
        "transformer": {"rated_mva": 10.0, "short_circuit_percent": 8.0},
    }  # fmt: skip
    with_phases = {**station, "grid_kv": 132.0, "phases": "RS"}
    assert "three-phase grid" not in said({"supply.transformer_stations": [station]})
    assert "one impedance for both sequences" in said(
        {"supply.transformer_stations": [with_phases]}
    )
