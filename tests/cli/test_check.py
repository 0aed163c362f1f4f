"""The command ``tpss check``: every fault of a scenario, what it says, and what may not be meant."""

import os
import subprocess
import sys

import pytest

from conftest import EXAMPLE_SCENARIOS, EXAMPLES

MAIN_LINE = EXAMPLES / "thesis_160km.toml"
STOP = EXAMPLES / "thesis_3_7_2.toml"


def check(tpss_command, file, *changes):
    """What `tpss check` says of a file with some values changed."""
    return tpss_command("check", file, *(word for change in changes for word in ("--set", change)))


def test_a_scenario_is_told_in_a_few_lines(tpss_command, tmp_path):
    said = check(tpss_command, MAIN_LINE)
    assert (said.code, said.err) == (0, "")
    for words in (
        "thesis-160km Rc4 freight trains every 10 minutes",
        "line 160 km",
        "West 0 km, Middle 80 km, East 160 km",
        "gradients -3.4658 to 5.7058 ‰; from beginning to end +179 m",
        "speed limits 100 km/h from 0 km",
        "system 15kV-16.7Hz, 16.7 Hz",
        "catenary BT: 0.21 + j0.2 Ω/km",
        "132kV, 132 kV; transformers: 16MVA at 40 km, 80 km, 120 km, 25MVA at the stations",
        "West 0 km: 6 x Q48/Q49 of 10 MVA, control all-on",
        "freight: Rc4-freight-1470t, mass 1470 t, adhesive mass 79 t, max speed 135 km/h",
        "eastbound: freight from West to East, every 10 min from 0 min, already running",
        "standards 15kV-16.7Hz: 12 to 17.25 kV, for a limited time 11 to 18 kV",
        "steps of 0.5 min until eastbound 1 arrives",
    ):
        assert words in said.out, words
    assert said.out.endswith(f"No faults in {MAIN_LINE}")
    assert list(tmp_path.iterdir()) == []


def test_what_departs_from_the_library_and_the_defaults_is_told(tpss_command):
    said = check(
        tpss_command,
        STOP,
        "trains.freight.efficiency=0.9",
        "supply.catenary={r_ohm_per_km = 0.1, x_ohm_per_km = 0.3}",
        "simulation.rail=wet",
        "traffic.0.already_running=false",
        "traffic.0.initial_trains=[{position_km = 20.0, speed_kmh = 60.0}]",
        "standards.voltage_limits.umin1_kv=12.5",
        "standards.peak_from_min=10",
        "standards.zones=[{name = 'hill', from_km = 20, to_km = 40}]",
    )
    assert said.code == 0
    for words in (
        "changed from the library: efficiency 0.9 (0.8)",
        "own: 0.1 + j0.3 Ω/km",
        "steps of 1 min until eastbound 1 arrives, rail wet",
        "trains on the line at the start: 1, stops: Middle 2 min",
        "standards 15kV-16.7Hz: 12.5 to 17.25 kV, for a limited time 11 to 18 kV; changed from the "
        "library: umin1_kv 12.5 (12); peak window 10 min to the end; zones hill",
    ):
        assert words in said.out, words


def test_a_line_of_direct_current_is_told_without_a_frequency_or_a_reactance(tpss_command):
    said = check(tpss_command, EXAMPLES / "metro_750v.toml")
    assert "system DC-0.75kV catenary own: 0.019 Ω/km high voltage" in said.out


def test_long_lists_are_cut(tpss_command, short_file):
    said = check(
        tpss_command, short_file, "supply.high_voltage_line={type = '132kV', transformers = 20}"
    )
    assert "16MVA at 0.952381 km ... 19.0476 km, 20 in all" in said.out


def test_the_values_of_a_saved_scenario_get_their_library_names_back(tpss_command, tmp_path):
    tpss_command("run", MAIN_LINE, "--set", "traffic.0.already_running=false", "--quiet")
    said = check(tpss_command, tmp_path / "results/thesis-160km-001/scenario.toml")
    assert "catenary BT: 0.21 + j0.2 Ω/km" in said.out
    assert "6 x Q48/Q49 of 10 MVA" in said.out


@pytest.mark.parametrize("file", EXAMPLE_SCENARIOS, ids=lambda file: file.stem)
def test_every_example_can_be_checked(tpss_command, file):
    assert check(tpss_command, file).code == 0


def test_all_faults_are_reported_as_by_a_run(tpss_command):
    faults = ("supply.catenary=BTX", "line.length_km='160 km'", "traffic.0.to=Eats")
    checked = check(tpss_command, MAIN_LINE, *faults)
    options = [word for fault in faults for word in ("--set", fault)]
    ran = tpss_command("run", MAIN_LINE, *options)
    assert (checked.code, checked.out, checked.err) == (2, "", ran.err)
    assert "did you mean BT?" in checked.err


def test_a_train_placed_too_fast_is_a_fault(tpss_command):
    trains = "traffic.0.initial_trains=[{position_km = 3.0, speed_kmh = 120.0}]"
    said = check(tpss_command, MAIN_LINE, "traffic.0.already_running=false", trains)
    assert (said.code, said.out) == (2, "")
    assert "faster than the limit here, 100 km/h" in said.err


@pytest.mark.parametrize(
    ("changes", "note"),
    [
        (["trains.freight.max_speed_kmh=90"],
         "trains.freight: its max_speed_kmh of 90 is below every speed limit of the line"),
        (["trains.freight.tractive_effort={max_force_kn = 280, max_power_kw = 4000}",
          "trains.freight.power_factor=0.9", "trains.freight.max_motor_current_a=2000"],
         "trains.freight: max_motor_current_a does nothing for a machine that is described by force "
         "and power"),
        (["standards.voltage_limits={un_kv = 14, umin1_kv = 12}"],
         "standards.voltage_limits: its un_kv of 14 kV is not the 15 kV of the supply's system "
         "(15kV-16.7Hz); mean useful voltages are not judged, as mean_useful_kv is not given for it"),
        (["trains.other={model = 'Rc4-freight-1470t'}"],
         "trains.other is used by no traffic entry"),
        (["supply.converter_stations.0.converters=1"],
         "supply.converter_stations.0: control = \"loading\" has nothing to switch"),
        (["traffic.0.stops.0.dwell_min=2.5", "simulation.motion=stepped"],
         "traffic.0 (eastbound): the stop of 2.5 min at Middle takes whole time steps, 3 min"),
        (["traffic.0.headway_min=7.25", "simulation.motion=stepped"],
         "traffic.0 (eastbound): its departures are not all at whole time steps of 1 min"),
        (["traffic.0.first_departure_min=30", "simulation={time_step_min = 1, duration_min = 30}"],
         "traffic.0 (eastbound): its first departure, at 30 min, is not before the end of the run"),
        (["line.length_km=160.1", "line.speed_limits=[{from_km = 0, speed_kmh = 100}, "
          "{from_km = 161, speed_kmh = 60}]"],
         "line.speed_limits.1 begins at 161 km, where the line has ended (160.1 km)"),
        (["supply.converter_stations.1.type={rating_mva = 10, no_load_voltage_kv = 19.5, "
          "droop_kv_per_mvar = 0.05, generator_reactance_pu = 0.5, generator_base_mva = 10, "
          "motor_reactance_pu = 0.5, motor_base_mva = 10, base_voltage_kv = 16.5}"],
         "supply: East feeds 19.5 kV without load, outside of the 12 to 17.25 kV of "
         "standards.voltage_limits (15kV-16.7Hz)"),
    ],
)  # fmt: skip
def test_what_may_not_be_meant_is_noted(tpss_command, changes, note):
    said = check(tpss_command, STOP, *changes)
    assert said.code == 0
    assert said.out.count("Note:") == 1
    assert f"Note: {note}" in said.out


LIMITS = "trains.freight.tractive_effort={{max_force_kn = {}, max_power_kw = {}}}"


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        # N / 10 in place of kN: 10 000 / 100 = 100 m/s²; dry rails take 325 kN from 100 t.
        (["trains.freight.mass_t=100", "trains.freight.adhesive_mass_t=100",
          "trains.freight.resistance_c_n_s2_per_m2=5",
          "trains.freight.tractive_effort={speed_kmh = [0, 160], force_kn = [10000, 2200]}"],
         ["10000 kN would be 100.0 m/s² for 100 t", "31 times what 100 t", "(325 kN)"]),
        ([LIMITS.format(250, 200_000)], ["power of up to 200000 kW is 136 kW a tonne"]),
        ([LIMITS.format(250, 100)], ["auxiliaries draw 151.5 kW, more than the 100 kW of its motors"]),
        # C as if for km/h, 49.2 · 3.6²: 15.4 + 0.279 · 37.5 + 0.6376 · 37.5² = 922 kN of 14 421 kN.
        (["trains.freight.resistance_c_n_s2_per_m2=637.6"],
         ["running resistance at 135 km/h is 922 kN, 6 % of its weight", "in N and m/s"]),
        (["trains.freight.mass_t=14700"], ["a whole train of 14700 t is unusual"]),
    ],
)  # fmt: skip
def test_what_no_train_has_is_noted(tpss_command, short_file, changes, words):
    said = check(tpss_command, short_file, "trains.freight.power_factor=0.9", *changes)
    assert said.code == 0
    assert said.out.count("Note: trains.freight: ") == 1
    for each in words:
        assert each in said.out, each


@pytest.mark.parametrize(("max_speed_kmh", "line_kmh"), [(160, 200), (200, 160)])
def test_a_table_that_ends_below_the_speed_of_its_train_is_noted(
    tpss_command, short_file, max_speed_kmh, line_kmh
):
    """45 kN are 1.0 MW at 80 km/h, where the table ends, and 2.0 MW at 160 km/h."""
    table = "trains.freight.tractive_effort={speed_kmh = [0, 40, 80], force_kn = [100, 80, 45]}"
    changes = (
        table, "trains.freight.power_factor=0.9", f"trains.freight.max_speed_kmh={max_speed_kmh}",
        f"line.speed_limits=[{{from_km = 0, speed_kmh = {line_kmh}}}]",
    )  # fmt: skip
    said = check(tpss_command, short_file, *changes)
    assert (
        "Note: trains.freight: its table of tractive effort ends at 80 km/h, and the train runs up to "
        f"160 km/h (max_speed_kmh = {max_speed_kmh}): beyond its end the force of 45 kN holds, so that "
        "1000 kW grow to 2000 kW; extend the table" in said.out
    )
    slow = check(tpss_command, short_file, *changes[:-1], "line.speed_limits.0.speed_kmh=80")
    assert "ends at" not in slow.out


def test_a_profile_that_does_not_fit_the_line_is_noted(tpss_command, tmp_path, short_file):
    (tmp_path / "profile.csv").write_text("position_km,gradient_permille\n2,1\n25,0\n")
    changes = ("line.gradients_file=profile.csv", "line.length_km=20")
    text = short_file.read_text().replace("gradients = [", "other = [")
    start = text.index("other = [")
    short_file.write_text(text[:start] + text[text.index("]", start) + 1 :])
    said = check(tpss_command, short_file, *changes)
    assert (
        "Note: line.gradients begins at 2 km; its first gradient applies from 0 km on" in said.out
    )
    assert "Note: line.gradients continues to 25 km, but the line ends at 20 km" in said.out
    assert "gradients 1 ‰; from beginning to end +20 m" in said.out


def test_a_gradient_on_which_a_train_cannot_start_is_noted(tpss_command, short_file):
    """1470 t on 20 ‰ need 1470 · 9.81 · 0.020 + 15.4 = 303.8 kN.

    Dry rails give 79 · 9.81 · (0.161 + 7.5/44) = 256.9 kN; with 15 ‰, 231.7 kN, the train can start.
    """
    at_15, at_20 = (
        check(tpss_command, short_file, f"line.gradients=[{{from_km = 5, permille = {permille}}}]")
        for permille in (15, 20)
    )
    assert "to start" not in at_15.out
    assert (
        "Note: traffic.0 (eastbound): between 0 and 20 km the gradient is 20 ‰, on which freight "
        "needs 304 kN to start; dry rails allow 257 kN" in at_20.out
    )


def test_nothing_is_compiled_and_no_results_are_imported(tmp_path):
    script = (
        "import sys\n"
        "from tpss.cli.check import check_scenario\n"
        "from pathlib import Path\n"
        "check_scenario(Path(sys.argv[1]), [])\n"
        "assert not {'pandas', 'xarray', 'netCDF4'} & set(sys.modules)\n"
    )
    subprocess.run(
        [sys.executable, "-c", script, MAIN_LINE],
        env={**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}, check=True, capture_output=True,
    )  # fmt: skip
    assert not list(tmp_path.rglob("*.nbi"))


def test_a_dead_stretch_of_line_is_noted(tpss_command, short_file):
    """20 km at km 438, as a line from 0 on: nothing runs on its first 438 km."""
    places = [
        "line.length_km=458", "line.begins_at_km=0", "line.stations.0.position_km=438",
        "line.stations.1.position_km=448", "line.stations.2.position_km=458",
        "supply.converter_stations.0.position_km=438",
        "supply.converter_stations.1.position_km=458",
    ]  # fmt: skip
    said = check(tpss_command, short_file, *places)
    assert (
        "Note: line: 438 km of contact line before its first station, from 0 to 438 km, have no "
        "train; if there is no such line, give begins_at_km = 438 and length_km = 20" in said.out
    )
    cut = [*places, "line.length_km=20", "line.begins_at_km=438", "line.speed_limits.0.from_km=438"]
    said = check(tpss_command, short_file, *cut)
    assert "20 km, from 438 to 458 km" in said.out
    assert "contact line" not in said.out
    said = check(tpss_command, short_file, "line.length_km=120")
    assert "100 km of contact line behind its last station, from 20 to 120 km" in said.out
    assert "give length_km = 20" in said.out
