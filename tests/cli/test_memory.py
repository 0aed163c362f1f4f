"""What would not fit into memory is told before anything is simulated, also by a mere check."""

import pytest

from tpss.run import limits

WEEK = """
format = 1
name = "week"
simulation = { time_step_min = 0.05, duration_min = 10080.0 }
[line]
length_km = 20.0
gradients = [{ from_km = 0.0, permille = 0.0 }]
speed_limits = [{ from_km = 0.0, speed_kmh = 80.0 }]
stations = [{ name = "A", position_km = 0.0 }, { name = "B", position_km = 20.0 }]
[supply]
catenary = "BT"
converter_stations = [{ name = "A", position_km = 0.0, type = "Q48/Q49", converters = 2 }]
[trains.freight]
model = "Rc4-freight-1470t"
[[traffic]]
name = "out"
train = "freight"
from = "A"
to = "B"
headway_min = 60.0
"""


@pytest.mark.parametrize("command", ["check", "run"])
def test_more_than_the_machine_has_is_refused(tpss_command, tmp_path, monkeypatch, command):
    """168 trains in 201,601 instants of 145 bytes and more: 4.6 GiB, and 11.4 with what is saved."""
    file = tmp_path / "week.toml"
    file.write_text(WEEK)
    monkeypatch.setattr(limits, "memory_of_machine", lambda: 8.0 * limits.GIB)
    said = tpss_command(command, str(file))
    assert (said.code, said.out) == (2, "")
    assert "201600 steps with 168 trains need 11." in said.err
    assert (
        "4.6 of them for what is recorded, and 8.0 are there; take a longer time step" in said.err
    )


def test_what_fits_is_checked(tpss_command, tmp_path, monkeypatch):
    file = tmp_path / "week.toml"
    file.write_text(WEEK)
    monkeypatch.setattr(limits, "memory_of_machine", lambda: 32.0 * limits.GIB)
    assert tpss_command("check", str(file)).code == 0
