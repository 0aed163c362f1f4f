"""A source answers by the law of its kind, whatever the parameters of the others are."""

import pytest

from tpss.sources.converter import ConverterLaw, converter_residual
from tpss.sources.grid import GridLaw, grid_residual
from tpss.sources.kinds import Source, SourceKind, is_plausible, loading, losses, residual

CONVERTER = {
    "no_load_voltage_v": 16_500.0,
    "droop_v_per_var": 50e-6,
    "generator_reactance_ohm": 14.4,
    "motor_reactance_ohm": 12.5,
    "motor_voltage_v": 16_500.0,
    "grid_reactance_ohm": 1.0,
    "grid_reactive_power_var": 0.0,
    "grid_angle_rad": 0.0,
}
GRID = {
    "no_load_voltage_v": 16e3,
    "grid_impedance_ohm": 0.2 + 2.0j,
    "transformer_impedance_ohm": 0.3 + 3.0j,
}
STATE = 16e3 - 1e3j, 400.0 - 100.0j, 3.0


def source(kind, **laws):
    common = {"node": 0, "installed": 3, "controlled": False, "rating_va": 10e6}
    return Source.array([Source.row(kind=kind, **common, **laws)])[0]


CONVERTERS = source(SourceKind.CONVERTER, converter=ConverterLaw.row(**CONVERTER))
TRANSFORMERS = source(SourceKind.GRID, grid=GridLaw.row(**GRID))


def test_the_law_of_its_kind_is_asked(as_run):
    """What the other kinds' parameters are is left open: not a number."""
    for asked, found in (
        (
            as_run(converter_residual)(*STATE, CONVERTERS.converter, True),
            as_run(residual)(*STATE, CONVERTERS, True),
        ),
        (
            as_run(grid_residual)(*STATE, TRANSFORMERS.grid),
            as_run(residual)(*STATE, TRANSFORMERS, True),
        ),
    ):
        off, by_voltage, by_current = asked
        assert found[0] == pytest.approx(off, rel=1e-12)
        assert found[1] == pytest.approx(by_voltage, rel=1e-12)
        assert found[2] == pytest.approx(by_current, rel=1e-12)


def test_losses_are_those_of_transformers_and_unknown_of_converters(as_run):
    assert as_run(losses)(400.0 - 100.0j, 3.0, TRANSFORMERS) == pytest.approx(51e3)
    assert as_run(losses)(400.0 - 100.0j, 3.0, CONVERTERS) == 0.0


def test_only_converters_can_be_in_a_state_that_is_not_plausible(as_run):
    far_off = 1e4 + 0j, -330e3j, 3.0
    assert not as_run(is_plausible)(*far_off, CONVERTERS)
    assert as_run(is_plausible)(*STATE, CONVERTERS)
    assert as_run(is_plausible)(*far_off, TRANSFORMERS)


def test_loading_is_apparent_power_over_the_rating_of_running_units(as_run):
    """|12 + j9| MVA = 15 MVA over 2 · 10 MVA = 0.75."""
    assert as_run(loading)(12e6 + 9e6j, 2.0, 10e6) == pytest.approx(0.75)
