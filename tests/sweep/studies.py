"""A small study to vary in tests."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import distributed
import tomli_w

import tpss

from scenarios import SHORT_LINE, gradients

STUDY: dict[str, Any] = {
    "format": 1,
    "name": "small",
    "scenario": "short_line.toml",
    "design": "grid",
    "set": {"simulation.time_step_min": 0.5, "simulation.duration_min": 10.0},
    "vary": {
        "traffic.0.headway_min": [5.0, 10.0],
        "supply.converter_stations.*.converters": [1, 2, 3],
    },
}


def write_study(folder: Path, changes: dict[str, Any] | None = None) -> Path:
    """Write the small study with some tables or values changed, and its scenario; give its file."""
    (folder / "short_line.toml").write_text(tomli_w.dumps(SHORT_LINE), "utf-8")
    document = {**STUDY, **(changes or {})}
    file = folder / "study.toml"
    file.write_text(tomli_w.dumps({k: v for k, v in document.items() if v is not None}), "utf-8")
    return file


def study(folder: Path, changes: dict[str, Any] | None = None) -> tpss.Study:
    """The small study with some tables or values changed."""
    return tpss.load_study(write_study(folder, changes))


def study_with_stalls(place: Path) -> Path:
    """Folder of a study of nine cases: trains of three masses on a hill, where the heavy ones stall."""
    loads = {"light": 300.0, "medium": 700.0, "heavy": 4000.0}
    changes = {
        "set": {"simulation.time_step_min": 0.1, **gradients((0.0, 0.0), (5.0, 20.0))},
        "vary": {"supply.converter_stations.*.converters": [1, 2, 3]},
        "choices": {"load": {k: {"trains.freight.mass_t": t} for k, t in loads.items()}},
    }
    tpss.run_study(study(place, changes), place / "out", workers=1)
    return place / "out"


@contextmanager
def small_cluster() -> Iterator[str]:
    """Address of a scheduler with a worker of two threads in this process."""
    with distributed.LocalCluster(
        n_workers=1,
        threads_per_worker=2,
        processes=False,
        protocol="tcp",
        dashboard_address="127.0.0.1:0",
    ) as cluster:
        yield cluster.scheduler_address
