"""Result folders: written whole or not at all, and read with clear words where they are damaged."""

import json
import os
import shutil
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w
import xarray as xr

from tpss.errors import ResultError, ScenarioError
from tpss.scenario.load import load_scenario
from tpss.scenario.scenario import Scenario

DATASET, SUMMARY, SCENARIO = "result.nc", "summary.json", "scenario.toml"


def check_target(folder: Path, force: bool) -> None:
    """Find out, before any work is done, whether a result can be saved into a folder.

    Raises
    ------
    ResultError
        It exists and may not be replaced, or its parent cannot be written.
    """
    if folder.exists() and not force:
        raise ResultError(f"{folder} exists already; give another --out, or --force to replace it")
    if folder.exists() and not _is_replaceable(folder):
        raise ResultError(
            f"{folder} is not a result folder, so it is not replaced; give another --out"
        )
    parent = folder.absolute().parent
    while not parent.exists():
        parent = parent.parent
    if not parent.is_dir() or not os.access(parent, os.W_OK | os.X_OK):
        raise ResultError(f"{parent} is not a folder that can be written; give another --out")


def _is_replaceable(folder: Path) -> bool:
    """Whether a folder is empty or holds a result."""
    return folder.is_dir() and (not any(folder.iterdir()) or (folder / SUMMARY).exists())


def save(
    scenario: Scenario, dataset: xr.Dataset, summary: dict[str, Any], folder: Path, force: bool
) -> Path:
    """Write a result folder.  See `Result.save`."""
    check_target(folder, force)
    target = folder.absolute()
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        part = Path(tempfile.mkdtemp(prefix=f".{target.name}-", dir=target.parent))
        try:
            dataset.to_netcdf(part / DATASET, engine="h5netcdf")
            document = tomli_w.dumps(scenario.as_document())
            (part / SCENARIO).write_text(document, encoding="utf-8")
            text = json.dumps(summary, indent=2, ensure_ascii=False)
            (part / SUMMARY).write_text(text + "\n", encoding="utf-8")
            part.chmod(0o755)
            if target.exists():
                shutil.rmtree(target)
            part.rename(target)
        finally:
            shutil.rmtree(part, ignore_errors=True)
    except OSError as error:
        message = f"{folder} cannot be written: {error.strerror or error}; give another --out"
        raise ResultError(message) from error
    return folder


def load(folder: Path) -> tuple[Scenario, xr.Dataset, dict[str, Any]]:
    """Read a result folder.  See `load_result`."""
    missing = [name for name in (DATASET, SUMMARY, SCENARIO) if not (folder / name).is_file()]
    if missing:
        raise ResultError(
            f"{folder} is not a result folder: {', '.join(missing)} missing; name a folder that "
            "tpss run has written"
        )
    try:
        with xr.open_dataset(folder / DATASET, engine="h5netcdf") as stored:
            dataset = stored.load()
        summary = json.loads((folder / SUMMARY).read_text(encoding="utf-8"))
        scenario = load_scenario(folder / SCENARIO)
        _demand_a_result(dataset, summary)
        # An attribute of one number comes back as that number.
        dataset.attrs["station_energy_mwh"] = np.atleast_1d(dataset.attrs["station_energy_mwh"])
    except (OSError, ValueError, KeyError, RuntimeError, ScenarioError) as error:
        raise ResultError(f"{folder} is damaged ({error}); run the scenario again") from error
    return scenario, dataset, summary


def _demand_a_result(dataset: xr.Dataset, summary: Any) -> None:
    """Raise a `ValueError` if the files are sound, but not those of a result."""
    if not isinstance(summary, dict) or not {"status", "audit"} <= set(summary):
        raise ValueError(f"{SUMMARY} is not the summary of a run")
    if not {"position", "pantograph_voltage", "station_active_power"} <= set(dataset.data_vars):
        raise ValueError(f"{DATASET} is not the dataset of a run")


def next_folder(name: str, parent: Path = Path("results")) -> Path:
    """First free folder ``results/<name>-NNN``."""
    number = 1
    while (folder := parent / f"{name}-{number:03d}").exists():
        number += 1
    return folder
