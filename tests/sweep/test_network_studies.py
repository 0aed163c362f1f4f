"""Studies vary what a network has: lines, tracks, timetables, stations, contact lines, outages."""

import shutil

import pytest
import tomli_w

import tpss
from tpss.sweep.batch import run_case
from tpss.sweep.check import check
from tpss.sweep.derive import scenario_of
from tpss.sweep.design import design_of
from tpss.sweep.inputs import inputs_of
from tpss.sweep.study import study_of_json

from conftest import EXAMPLES

SHORT = {"simulation.time_step_min": 0.5, "simulation.duration_min": 10.0}


def network_study(folder, **tables) -> tpss.Study:
    """A study of the network of the examples."""
    for name in ("network.toml", "network_timetable.csv"):
        shutil.copy(EXAMPLES / name, folder)
    document = {
        "format": 1,
        "name": "net",
        "scenario": "network.toml",
        "design": "grid",
        "set": SHORT,
    }
    file = folder / "study.toml"
    file.write_text(tomli_w.dumps({**document, **tables}), "utf-8")
    return tpss.load_study(file)


def only_case(folder, **tables):
    return scenario_of(design_of(network_study(folder, **tables)), 0)


def told(folder, **tables) -> list[str]:
    """Keys and problems of a faulty study."""
    with pytest.raises(tpss.ScenarioError) as caught:
        check(design_of(network_study(folder, **tables)))
    return [f"{finding.key}: {finding.problem}" for finding in caught.value.findings]


def test_a_length_moves_what_stands_on_its_line_and_nothing_else(tmp_path):
    """The main line of 120 km at 60 km: half of each distance on it; the branch stays as it is."""
    case = only_case(tmp_path, vary={"lines.main.length_km": 60.0})
    places = {s.name: s.position_km for s in case.lines["main"].stations}
    assert places == {"Aby": 0.0, "Brunna": 15.0, "Carlsro": 30.0, "Dalby": 45.0, "Ekeby": 60.0}
    assert [s.position_km for s in case.lines["branch"].stations] == [0.0, 18.0, 36.0]
    assert [s.position_km for s in case.supply.converter_stations] == [7.5, 52.5]
    assert case.supply.posts[0].position_km == 20.0
    assert [limit.from_km for limit in case.lines["main"].speed_limits] == [0.0, 1.5, 58.5]
    (section,) = case.outages[2].sections
    assert (section.from_km, section.to_km) == (35.0, 47.5)


def test_the_length_of_one_line_leaves_what_stands_on_another(tmp_path):
    case = only_case(tmp_path, vary={"lines.branch.length_km": 72.0})
    assert [s.position_km for s in case.lines["branch"].stations] == [0.0, 36.0, 72.0]
    assert [s.position_km for s in case.supply.converter_stations] == [15.0, 105.0]
    assert case.supply.posts[0].position_km == 40.0


def test_what_a_network_has_varies_by_its_path(tmp_path):
    varied = {
        "lines.branch.stations.Forsa.tracks": 3,
        "supply.converter_stations.Western.converters": 6,
        "supply.contact_lines.0.catenary": "AT",
        "simulation.outage": "Two converters less in the peak",
        "outages.Two converters less in the peak.units.Eastern": 1,
        "trains.regional.mass_t": 180.0,
        "supply.posts.+": {"name": "Post 80", "line": "main", "position_km": 80.0},
    }
    case = only_case(tmp_path, vary={path: [value] for path, value in varied.items()})
    assert case.lines["branch"].stations[1].tracks == 3
    assert case.supply.converter_stations[0].converters == 6
    assert (
        case.supply.contact_lines[0].catenary
        == tpss.load_scenario(EXAMPLES / "network.toml").supply.catenary
    )
    assert case.outage is not None
    assert case.outage.units == {"Eastern": 1}
    assert case.trains["regional"].mass_t == 180.0
    assert [post.name for post in case.supply.posts] == ["Post 40", "Post 80"]


def test_none_adds_nothing_and_chooses_no_outage(tmp_path):
    case = only_case(tmp_path, vary={"supply.posts.+": ["none"], "simulation.outage": ["none"]})
    assert [post.name for post in case.supply.posts] == ["Post 40"]
    assert case.outage is None


def test_the_trains_of_a_timetable_vary_by_their_names(tmp_path):
    case = only_case(tmp_path, vary={"traffic.G401.train": "regional"})
    assert len(case.traffic) == 40
    assert case.trains_by_service()["G401"].length_m == 110.0


def test_the_density_of_a_timetable_varies(tmp_path):
    """At half of it, trains run that depart in the first half of 40 trains' departures."""
    design = design_of(network_study(tmp_path, vary={"timetables.0.density": [0.5, 1.0, 2.0]}))
    few, all_of_them, many = (scenario_of(design, case) for case in range(3))
    times_min = [entry.departure_min for entry in all_of_them.traffic]
    half_min = (min(times_min) + max(times_min)) / 2.0
    assert inputs_of(few).listed_trains == sum(time_min <= half_min for time_min in times_min)
    assert inputs_of(all_of_them).listed_trains == 40
    assert inputs_of(many).listed_trains == pytest.approx(80, abs=3)


def test_what_all_cases_share_concerns_trains_of_a_timetable_that_varies_too(tmp_path):
    shared = {**SHORT, "traffic.R101.supplement_percent": 5.0, "timetables.0.density": 1.2}
    varied = {"timetables.0.supplement_percent": [0.0, 3.0]}
    design = design_of(network_study(tmp_path, set=shared, vary=varied))
    first, second = (scenario_of(design, case).traffic[:2] for case in range(2))
    assert [entry.supplement_percent for entry in (*first, *second)] == [5.0, 0.0, 5.0, 3.0]


def test_a_study_of_timetables_needs_no_files_later(tmp_path):
    """Its text holds them, so that it can be sent to another computer."""
    tables = {"vary": {"timetables.0.density": [1.0, 1.5]}}
    study = network_study(tmp_path, **tables)
    text = study.as_json()
    (tmp_path / "network_timetable.csv").unlink()
    case = scenario_of(design_of(study_of_json(text)), 1)
    assert case == scenario_of(design_of(study), 1)
    assert study_of_json(text).digest == study.digest


def test_another_timetable_is_another_study(tmp_path):
    varied = {"timetables.0.density": [1.0]}
    before = network_study(tmp_path, vary=varied).digest
    other = (EXAMPLES / "network_timetable.csv").read_text("utf-8").replace("06:05:00", "06:04:00")
    (tmp_path / "other.csv").write_text(other, "utf-8")
    choices = {"timetable": {"other": {"timetables.0.file": "other.csv"}}}
    study = network_study(tmp_path, vary=varied, choices=choices)
    assert study.digest != before
    assert scenario_of(design_of(study), 0).traffic[0].departure_min == 4.0


def test_gradients_are_drawn_on_the_line_that_is_named(tmp_path):
    drawn = {"line": "branch", "mean_permille": 1.5, "standard_deviation_permille": 2.0}
    case = only_case(tmp_path, gradients=drawn)
    rises = [gradient.permille for gradient in case.lines["branch"].gradients]
    assert sum(rises) / len(rises) == pytest.approx(1.5)
    assert len(case.lines["main"].gradients) == 5


def test_inputs_of_a_network_follow_the_studied_train(tmp_path):
    """From Gruvan down the branch and on along the main line to Ekeby: 36 + 60 km.

    Seen by the train, the branch rises by 3 ‰ over 16 km and falls by 6 ‰ over 20 km; then the main
    line falls by 2 ‰ over 25 km, by 5 ‰ over 20 km, and is level over 15 km: (48 - 120 - 50 - 100) / 96
    in the mean.  Limits are 90 km/h over 36 km, 160 km/h over 57 km, 80 km/h over 3 km.  Of the stations
    90 km apart one stands on its way.
    """
    service = {
        "name": "ore",
        "train": "regional",
        "from": "Gruvan",
        "to": "Ekeby",
        "headway_min": 30.0,
    }
    case = only_case(tmp_path, vary={"traffic": [[service]]})
    found = inputs_of(case)
    assert (found.length_km, found.route_km) == (156.0, 96.0)
    assert (found.converter_stations, found.station_distance_km) == (2, 90.0)
    assert found.gradient_mean_permille == pytest.approx(-222.0 / 96.0)
    assert found.starting_gradient_permille == 3.0
    assert found.steepest_permille == 3.0
    assert found.mean_speed_limit_kmh == pytest.approx((36 * 90 + 57 * 160 + 3 * 80) / 96)
    assert found.gradient_middle_permille != found.gradient_middle_permille  # of a single station


def test_a_case_of_a_network_runs(tmp_path):
    row = run_case(design_of(network_study(tmp_path, vary={"lines.main.length_km": 110.0})), 0)
    assert row["status"] == "finished"
    assert row["audit_passed"]
    assert row["listed_trains"] == 40


def test_what_cannot_be_varied_is_told_by_name(tmp_path):
    varied = {
        "name": ["a", "b"],
        "variants.AT.description": ["a"],
        "outages.Western out.from_min": [0.0, 10.0],
        "lines.branch.gradients.0.permille": [1.0],
    }
    drawn = {"line": "branch", "mean_permille": 0.0, "standard_deviation_permille": 1.0}
    assert told(tmp_path, vary=varied, gradients=drawn) == [
        "vary.name: name is not simulated",
        "vary.variants.AT.description: variants are scenarios of their own, which a study does not run",
        "vary.outages.Western out.from_min: no outage applies in any case",
        "vary.lines.branch.gradients.0.permille: the gradients of this line are drawn",
    ]


@pytest.mark.parametrize(
    ("tables", "words"),
    [
        (
            {"vary": {"line.length_km": 50.0}},
            "vary.line.length_km: there is no such place in the base scenario",
        ),
        (
            {"vary": {"lines.mian.tracks": 1}},
            "vary.lines.mian.tracks: there is no such place in the base scenario",
        ),
        (
            {"gradients": {"mean_permille": 0.0, "standard_deviation_permille": 1.0}},
            "gradients: it is not said which line gets them",
        ),
        (
            {"gradients": {"line": "brnach", "mean_permille": 0.0, "standard_deviation_permille": 1.0}},
            "gradients.line: there is no such line",
        ),
    ],
)  # fmt: skip
def test_a_line_that_there_is_not_is_told(tmp_path, tables, words):
    assert told(tmp_path, **tables) == [words]


def test_each_fault_is_told_once_at_its_own_parameter(tmp_path):
    """Two wrong names among five parameters: two faults, however many ends there are."""
    varied = {
        "lines.main.length_km": [100.0, 110.0, 120.0],
        "trains.regional.mass_t": [200.0, 210.0],
        "lines.branch.stations.Forsa.trakcs": [1, 2],
        "supply.converter_stations.Eastern.convertors": [1, 2, 3],
        "traffic.G401.train": ["regional", "freight"],
    }
    assert told(tmp_path, vary=varied) == [
        "vary.lines.branch.stations.Forsa.trakcs: unknown key",
        "vary.supply.converter_stations.Eastern.convertors: unknown key",
    ]
