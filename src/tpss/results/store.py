"""Result folders: written whole or not at all, and read with clear messages on damage."""

import hashlib
import json
import os
import threading
from pathlib import Path
from typing import Any

import netCDF4
import numpy as np
import tomli_w
import xarray as xr

from tpss.errors import ResultError, ScenarioError
from tpss.files import whole, workplace
from tpss.files.checked import document_checksum
from tpss.files.json_text import read_json_file
from tpss.files.read import MEGABYTE, demand_readable
from tpss.files.refusals import explained, refuse_to_replace
from tpss.results.contents import DATASET, FORMAT, FORMAT_KEY, SCENARIO, SUMMARY, carry_over
from tpss.results.dataset import NODE_KIND, described
from tpss.scenario.load import load_scenario
from tpss.scenario.own_library import using
from tpss.scenario.scenario import Scenario
from tpss.step.recorded import RECORDED

FIRST_BYTES = 2**16
"""Initial size of a dataset in memory; it grows."""

PACKED = {"zlib": True, "complevel": 1, "shuffle": True}
"""How numbers are compressed: more than this level takes longer and saves little."""

CHECKSUMS = "sha256"
"""Key of a saved summary: checksums of all files, its own too, by their names."""

ONE_AT_A_TIME = threading.Lock()
"""The netCDF library is not safe in several threads at once."""

DAMAGE = (OSError, ValueError, KeyError, RuntimeError, AttributeError)
"""Exceptions of netCDF on a damaged file, the last one on a damaged attribute."""

PARENT = Path("results")
"""Folder of results without a folder of their own."""


def check_target(scenario: Scenario, folder: Path | None, force: bool) -> None:
    """Find out, before any work is done, whether a result can be saved into a folder.

    Raises
    ------
    ResultError
        It exists and may not be replaced, it cannot be made, or the disk is full.
    """
    with explained(folder or PARENT):
        _put_right_first(folder)
        _refuse(folder, force)
        workplace.try_out(whole.real(folder or next_folder(scenario.name)))


def save(
    scenario: Scenario,
    dataset: xr.Dataset,
    summary: dict[str, Any],
    folder: Path | None,
    force: bool,
) -> Path:
    """Write a result folder.  See `Result.save`."""
    with explained(folder or PARENT):
        _put_right_first(folder)
        _refuse(folder, force)
        target = whole.real(folder or next_folder(scenario.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        with workplace.workplace(target, _put_right(target)) as work:
            new = work / workplace.NEW
            new.mkdir()
            # In memory first: on a full disk HDF5 cannot close its file, and aborts the process.
            # The simulation has needed more memory than this.
            content = _as_netcdf(dataset)
            whole.write_new(new / DATASET, content)
            run = tomli_w.dumps(scenario.as_document()).encode()
            whole.write_new(new / SCENARIO, run)
            whole.write_new(new / SUMMARY, _with_checksums(summary, content, run))
            if folder is None:
                return _move_to_next(new, scenario.name)
            _refuse(folder, force)
            workplace.put_in_place(work, target, carry_over)
            return folder


def _with_checksums(summary: dict[str, Any], dataset: memoryview, scenario: bytes) -> bytes:
    """Content of a summary's file, with the checksums of all files."""
    checksums = {
        DATASET: hashlib.sha256(dataset).hexdigest(),
        SCENARIO: _of_text(scenario),
        SUMMARY: document_checksum(summary),
    }
    text = json.dumps({**summary, CHECKSUMS: checksums}, indent=2, ensure_ascii=False)
    return f"{text}\n".encode()


def _put_right(target: Path) -> workplace.PutRight:
    """What is done where a process was killed while it put a result into its place."""
    return lambda work: workplace.restore(work, target, carry_over)


def _put_right_first(folder: Path | None) -> None:
    """Put right what processes that were killed have left of a named folder, before it is looked at."""
    if folder is not None:
        workplace.clear_left(whole.real(folder), _put_right(whole.real(folder)))


def _refuse(folder: Path | None, force: bool) -> None:
    """Refuse to replace a named folder."""
    if folder is not None and os.path.lexists(whole.real(folder)):
        refuse_to_replace(folder, force, "a result folder", _is_replaceable)


def _is_replaceable(folder: Path) -> bool:
    """Whether a folder is empty or holds a result."""
    if not folder.is_dir() or folder.is_mount():
        return False
    return not any(folder.iterdir()) or (folder / SUMMARY).exists()


def _move_to_next(new: Path, name: str) -> Path:
    """Put a written folder into the first free numbered place, which another run may take first."""
    while True:
        folder = next_folder(name)
        try:
            return new.rename(folder)
        except OSError:
            if not folder.exists():
                raise


def next_folder(name: str, parent: Path = PARENT) -> Path:
    """First free folder ``results/<name>-NNN``."""
    number = 1
    while os.path.lexists(folder := parent / f"{name}-{number:03d}"):
        number += 1
    return folder


def load(folder: Path) -> tuple[Scenario, xr.Dataset, dict[str, Any]]:
    """Read a result folder.  See `load_result`."""
    _put_right_first(folder)
    missing = [name for name in (DATASET, SUMMARY, SCENARIO) if not (folder / name).is_file()]
    if missing:
        raise ResultError(
            f"{folder} is not a result folder: {', '.join(missing)} missing; name a folder that "
            "tpss run has written"
        )
    try:
        summary = read_json_file(folder / SUMMARY)
        _demand_this_format(folder, summary)
        # First: on some damaged files HDF5 ends the process.
        _demand_what_was_written(folder, summary)
        _demand_whole(summary)
        dataset = _read_netcdf(folder / DATASET)
        with using(None):  # it holds what it took from any library
            scenario = load_scenario(folder / SCENARIO)
        _demand_a_result(dataset)
        # An attribute of one number comes back as that number.
        dataset.attrs["station_energy_mwh"] = np.atleast_1d(dataset.attrs["station_energy_mwh"])
    except ScenarioError as error:
        problem = f"{SCENARIO}: {error.findings[0].problem}"
        raise ResultError(f"{folder} is damaged ({problem}); run the scenario again") from error
    except DAMAGE as error:
        raise ResultError(f"{folder} is damaged ({error}); run the scenario again") from error
    return scenario, dataset, summary


def _as_netcdf(dataset: xr.Dataset) -> memoryview:
    """A dataset as the content of a netCDF 4 file."""
    with ONE_AT_A_TIME:
        file = netCDF4.Dataset(DATASET, "w", memory=FIRST_BYTES)
        packed = {name: PACKED for name in dataset.variables if dataset[name].dtype.kind in "fi"}
        dataset.dump_to_store(xr.backends.NetCDF4DataStore(file), encoding=packed)
        content: memoryview = file.close()
    return content


def _read_netcdf(path: Path) -> xr.Dataset:
    demand_readable(path, MOST_BYTES)
    with ONE_AT_A_TIME, xr.open_dataset(path, engine="netcdf4") as stored:
        _demand_bounded(stored)
        return _with_route_positions(_with_node_kinds(stored.load()))


MOST_BYTES = 64_000 * MEGABYTE
"""Of a dataset: eight times as much as a run may record. [byte]"""


def _demand_bounded(dataset: xr.Dataset) -> None:
    """Raise a `ValueError` if a dataset says that it holds more than a run may record.

    What is packed may be small, and unpack to anything.
    """
    if dataset.nbytes > MOST_BYTES:
        gigabytes = f"{dataset.nbytes / 1e9:.3g} GB"
        raise ValueError(f"{DATASET} unpacks to {gigabytes}, more than a run records")


def _with_node_kinds(dataset: xr.Dataset) -> xr.Dataset:
    """A dataset with the kinds of its nodes: earlier files have them in the nodes' names only."""
    if "node" not in dataset.coords or "node_kind" in dataset.coords:
        return dataset
    kinds = [name.rpartition(" at ")[0] for name in dataset.node.to_numpy().tolist()]
    return dataset.assign_coords(node_kind=("node", kinds, NODE_KIND))


def _with_route_positions(dataset: xr.Dataset) -> xr.Dataset:
    """A dataset with positions along routes: in earlier files trains ran along one line, either way."""
    if "position" not in dataset or "route_position" in dataset:
        return dataset
    moved_m = np.diff(dataset.position.to_numpy(), axis=0)
    falls = np.nansum(moved_m, axis=0) < 0.0
    recorded = next(each for each in RECORDED if each.name == "route_position")
    along_m = np.where(falls, -1.0, 1.0) * dataset.position.to_numpy()
    return dataset.assign(route_position=(dataset.position.dims, along_m, described(recorded)))


def _demand_this_format(folder: Path, summary: Any) -> None:
    """Raise a `ResultError` if another version has written the result."""
    if not isinstance(summary, dict) or not {"status", "audit"} <= set(summary):
        raise ValueError(f"{SUMMARY} is not the summary of a run")
    written = summary.get(FORMAT_KEY)
    if written != FORMAT:
        provenance = summary.get("provenance")
        maker = provenance.get("tpss_version") if isinstance(provenance, dict) else None
        raise ResultError(
            f"{folder} was written by another version of TPSS ({maker or 'unknown'}): its format is "
            f"{written or 'older than any number'}, this version reads {FORMAT}; run the scenario "
            f"again (tpss run {folder / SCENARIO}), or read it with that version"
        )


ALWAYS = {
    "name", "status", "audit", "limited", "provenance", "time_step_min", "duration_min", "studied_train",
    "trip_time_min", "total_energy_mwh", "station_energy_mwh", "losses_mwh", "lowest_voltage",
}  # fmt: skip
"""Keys of every summary of this format."""


def _demand_whole(summary: dict[str, Any]) -> None:
    """Raise a `ValueError` if a summary lacks what all have, as one without a checksum may."""
    if lacking := ALWAYS - set(summary):
        raise ValueError(f"{SUMMARY} has no {', '.join(sorted(lacking))}")


def _demand_what_was_written(folder: Path, summary: dict[str, Any]) -> None:
    """Take the checksums out of a summary, and raise a `ValueError` if a file has another one.

    Results that were saved before know some of them, or none.
    """
    written = summary.pop(CHECKSUMS, {})
    with (folder / DATASET).open("rb") as opened:
        found = hashlib.file_digest(opened, "sha256").hexdigest()
    there = {
        DATASET: found,
        SCENARIO: _of_text((folder / SCENARIO).read_bytes()),
        SUMMARY: document_checksum(summary),
    }
    for name, checksum in there.items():
        if written.get(name, checksum) != checksum:
            raise ValueError(f"{name} is not as it was written: its checksum is another")


def _of_text(content: bytes) -> str:
    """Checksum of a text, whatever ends its lines."""
    return hashlib.sha256(content.replace(b"\r\n", b"\n")).hexdigest()


def _demand_a_result(dataset: xr.Dataset) -> None:
    """Raise a `ValueError` if a dataset is not that of a result."""
    if not {"position", "pantograph_voltage", "station_active_power"} <= set(dataset.data_vars):
        raise ValueError(f"{DATASET} is not the dataset of a run")
    if dataset.attrs.get(FORMAT_KEY) != FORMAT:
        raise ValueError(f"{DATASET} and {SUMMARY} are not of the same version")
