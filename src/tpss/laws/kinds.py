"""The kinds of laws that a package of one's own may have: a line each.

What is given and found has a name, a unit and a sign; a kernel hands it over in this order.
"""

from tpss.laws.law import LawKind, Quantity

RESISTANCE = LawKind(
    name="resistance",
    given=(
        Quantity("speed_m_s", "m/s", "speed, not negative"),
        Quantity("mass_kg", "kg", "mass of the whole train"),
        Quantity("a_n", "N", "the train's A, `resistance_a_n`"),
        Quantity("b_n_s_per_m", "N s/m", "its B"),
        Quantity("c_n_s2_per_m2", "N s²/m²", "its C"),
    ),
    found=(
        Quantity("resistance_n", "N", "running resistance on straight level track, against motion"),
    ),
    place="trains.*.resistance_law",
)

DRIVER = LawKind(
    name="driver",
    given=(
        Quantity("speed_m_s", "m/s", "speed at the start of a step"),
        Quantity("limit_m_s", "m/s", "lower one of the speed limit there and the train's own"),
        Quantity("position_m", "m", "position along the train's route, which grows"),
        Quantity("to_stop_m", "m", "distance to its next stop"),
    ),
    found=(
        Quantity(
            "wanted_m_s",
            "m/s",
            "speed wanted: a slower train accelerates up to it, a faster one coasts down to it; "
            "infinite: whatever the limits allow",
            may_be_infinite=True,
        ),
    ),
    place="trains.*.driver",
)

CONVERTER = LawKind(
    name="converter",
    given=(
        Quantity("power_w", "W", "active power of one running converter, fed into the railway"),
        Quantity("reactive_power_var", "var", "its reactive power, fed into the railway"),
    ),
    found=(
        Quantity("voltage_v", "V", "magnitude of the voltage at the busbar"),
        Quantity("angle_rad", "rad", "its angle, negative where it lags"),
        Quantity("voltage_by_power", "V/W", "slope of the magnitude over the active power"),
        Quantity("voltage_by_reactive", "V/var", "over the reactive power"),
        Quantity("angle_by_power", "rad/W", "slope of the angle over the active power"),
        Quantity("angle_by_reactive", "rad/var", "over the reactive power"),
    ),
    place="supply.converter_stations.*.law",
)

KINDS = {each.name: each for each in (RESISTANCE, DRIVER, CONVERTER)}
"""All kinds by their names."""
