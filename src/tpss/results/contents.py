"""Files that TPSS writes into a result folder, and files that others have put there."""

from pathlib import Path

from tpss.results.file_kinds import Kind

DATASET, SUMMARY, SCENARIO = "result.nc", "summary.json", "scenario.toml"

FORMAT_KEY, FORMAT = "result_format", 2
"""Key and number of the format in which a result is written.

It increases when something is renamed, removed or newly required, not when something is added.
"""

REPORT = "report.html"
REPORT_MARK, HEAD_BYTES = "TPSS report", 2_000
"""Text that identifies a report, and the number of first bytes that contain it."""

TABLES = "tables"
"""Folder of exported tables, within that of the result."""

_OF_STANDARDS = (
    "violations", "voltage", "excursions", "low_voltage_places", "useful_voltage_zones",
    "useful_voltage_trains", "energy", "energy_blocks", "station_power", "load_duration", "converters",
    "losses", "branch_current", "unbalance", "neutral_sections",
)  # fmt: skip
TABLE_PLACES = {
    "trips": "trips",
    "stops": "stops",
    "waits": "waits",
    "stations": "stations",
    "regeneration": "regeneration",
    "converter_losses": "converter_losses",
    "rails": "rails",
    "stray_current": "stray_current",
    "autotransformers": "autotransformers",
    "transformer_losses": "transformer_losses",
    "storage": "storage",
    **{name: f"standards.{name}" for name in _OF_STANDARDS},
    "thermal": "thermal",
    "thermal_windows": "thermal_windows",
    "steps": "train_steps",
}
"""Tables by the names of their files, or of their sheets, and where a `Result` has them."""

WORKBOOK = "result.xlsx"

FIGURES = "figures"
"""Folder of figures, within that of the result."""

FIGURE_NAMES = (
    "network", "time-distance", "journey", "voltage", "train-voltage",
    "stations", "converters", "converter-losses", "unbalance", "braking", "storage", "thermal", "rails",
    "energy", "effort",
)  # fmt: skip


def carry_over(old: Path, new: Path) -> None:
    """Move what others have put into a replaced result folder into its successor."""
    for path in sorted(old.iterdir()):
        if path.name in (TABLES, FIGURES) and path.is_dir() and not path.is_symlink():
            for file in sorted(path.iterdir()):
                if not is_ours(file, path.name):
                    (new / path.name).mkdir(exist_ok=True)
                    file.rename(new / path.name / file.name)
        elif not is_ours(path):
            path.rename(new / path.name)


def is_ours(path: Path, folder: str = "") -> bool:
    """Whether TPSS has written a file of a result folder, or of the folder of that name within it."""
    if not path.is_file() or path.is_symlink():
        return False
    if folder == TABLES:
        written = {WORKBOOK} | {f"{n}.{kind}" for n in TABLE_PLACES for kind in Kind}
        return path.name in written
    if folder == FIGURES:
        return path.name in {f"{name}.png" for name in FIGURE_NAMES}
    return path.name in (DATASET, SUMMARY, SCENARIO) or (path.name == REPORT and is_report(path))


def is_report(file: Path) -> bool:
    """Whether a file is a report."""
    try:
        with file.open("rb") as opened:
            return REPORT_MARK.encode() in opened.read(HEAD_BYTES)
    except OSError:
        return False
