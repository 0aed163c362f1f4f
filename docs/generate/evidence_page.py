"""The page of the evidence for standards: its tables and figures, from a run."""

import inspect
from pathlib import Path
from typing import Any

from markdown_pieces import described, prose

import tpss
from tpss.results.standards.energy import BLOCK_MIN
from tpss.results.standards.low_voltage import JOINED_KM, MOST_NAMES
from tpss.results.standards.useful_voltage import LEAST_PRESENCE_S
from tpss.results.standards.windows import WINDOWS_MIN

EXAMPLE = Path(__file__).parents[2] / "examples" / "thesis_160km.toml"

INTRODUCTION = f"""# Evidence for standards

`Result.standards` gives key figures of a run by the definitions of EN 50163, EN 50388 and EN 50463.
They are evidence for an assessment, and no more: the simulation knows one line, its traffic and its
supply, and voltages that are constant within a time step. The
[guide](../how-to/evidence-for-standards.md) shows how to work with them;
[`tpss export`](command_line.md#tpss-export) writes each table to a file of its name.

The limits are those of the scenario's [`standards`](scenario.md#standards), by default those of
the supply's system in the [library](library.md#voltage-limits), which says where each figure is from.
`Result.with_standards` judges a run by others, without running it again.

- All values hold from an instant to the next, so all means are over time, and exact.
- Windows of {", ".join(f"{each:g}" for each in WINDOWS_MIN)} min move over the run and need not begin
  at an instant. The first window of a table is the time step: its mean is the peak. One that is
  longer than the run has no mean, NaN, and `notes` says so.
- A train pulls while its tractive force at the wheel rim is positive. One that is present for less than
  {LEAST_PRESENCE_S:g} s is not a dimensioning train, and is not judged.
- Energy is billed in blocks of {BLOCK_MIN:g} min from the start of the run, each direction
  by itself."""

TRAIN = {"train": "name"}
ENERGIES = {
    "consumed_mwh": "active energy drawn",
    "regenerated_mwh": "active energy fed back, not negative",
    "reactive_consumed_mvarh": "reactive energy drawn, inductive",
    "reactive_regenerated_mvarh": "reactive energy fed back, not negative",
}
JUDGED = {
    "mean_useful_kv": "mean useful voltage; NaN without any voltage to count",
    "minimum_kv": "what it is held against; NaN: nothing",
    "verdict": "`reached`, `below the minimum`, or empty",
}
WINDOW = {
    "window_min": "length of the window",
    "from_min": "where the window of the highest mean begins",
}

TABLES: dict[str, dict[str, str]] = {
    "violations": {
        "standard": "EN 50163 or EN 50388; EN 50122 for rails; `grid` for the unbalance of one",
        "rule": "what was broken",
        "subject": "train, zone, rails or busbar",
        "limit_kv": "the limit",
        "value_kv": "the voltage farthest beyond it, or the mean useful voltage",
        "duration_min": "time beyond the limit at a stretch; NaN for a mean",
        "from_min": "when that began",
        "position_km": "where the voltage was farthest beyond it",
        "words": "all of it in words",
    },
    "voltage": {
        **TRAIN,
        "lowest_kv": "lowest voltage",
        "highest_kv": "highest voltage",
        **{
            f"{longest}{side}_{limit.lower()}_min": f"{meaning} {side} {limit}"
            for limit, side in (
                ("Umin2", "below"),
                ("Umax2", "above"),
                ("Umin1", "below"),
                ("Umax1", "above"),
            )
            for longest, meaning in (("", "time"), ("longest_", "longest stretch of time"))
        },
        "verdict": "`within the limits`, or the rules that were broken",
    },
    "excursions": {
        **TRAIN,
        "limit": "Umin2, Umax2, Umin1 or Umax1",
        "limit_kv": "its value",
        "from_min": "when it began",
        "to_min": "... and ended",
        "duration_min": "how long it lasted",
        "cut": "whether the run began or ended in it, so that it may have been longer",
        "from_km": "where it began",
        "to_km": "... and ended",
        "extreme_kv": "voltage farthest beyond the limit",
        "extreme_km": "... and where",
        "extreme_min": "... and when",
        "allowed_min": "how long it may last",
        "violation": "whether it lasted longer",
    },
    "low_voltage_places": {
        "limit": "Umin2 or Umin1",
        "limit_kv": "its value",
        "from_km": f"where the stretch begins; stretches within {JOINED_KM:g} km of each other are one",
        "to_km": "... and ends",
        "lowest_kv": "lowest voltage in it",
        "lowest_km": "... and where",
        "lowest_min": "... and when",
        "from_min": "when a train was first below the limit in it",
        "to_min": "... and last",
        "duration_min": "time in which at least one train was",
        "train_count": "trains that were",
        "trains": f"their names, {MOST_NAMES} at most",
    },
    "useful_voltage_zones": {
        "zone": "name",
        "from_km": "where it begins",
        "to_km": "where it ends",
        "trains": "trains that were in it",
        **JUDGED,
    },
    "useful_voltage_trains": {
        **TRAIN,
        "present_min": "time on the line within the peak window",
        "traction_min": "time of that in which it pulls",
        "counts": "whether it is there long enough to be the dimensioning train, and to be judged",
        **JUDGED,
    },
    "energy": {
        **TRAIN,
        "distance_km": "distance within the run",
        "mass_t": "mass of the whole train",
        **ENERGIES,
        "energy_kwh_per_km": "active energy consumed less regenerated, a train kilometre",
        "energy_wh_per_t_km": "the same a gross tonne kilometre",
    },
    "energy_blocks": {
        **TRAIN,
        "from_min": "where the block begins",
        "to_min": "where it ends",
        **ENERGIES,
    },
    "station_power": {
        "station": "name",
        **WINDOW,
        "highest_mean_mw": "highest mean active power of any such window",
    },
    "load_duration": {
        "station": "name",
        "duration_min": "for how long",
        "power_mw": "... which power is reached or exceeded",
    },
    "converters": {
        "station": "name",
        "converters": "number of converters",
        "duration_min": "how long so many were running",
    },
    "losses": {
        "branch_kind": "contact line, transformer, connection or high-voltage line",
        "energy_mwh": "energy lost there",
        "share": "of all losses",
    },
    "branch_current": {
        "branch": "name; a section of contact line has one at each end, where its current is highest "
        "unless trains feed back",
        "branch_kind": "what it is",
        **WINDOW,
        "highest_rms_a": "highest RMS current of any such window, at the branch's own level",
    },
    "unbalance": {
        "busbar": "name",
        "stations": "transformer stations there",
        "peak_r_a": "highest current of phase R in a time step, at the grid's voltage",
        "peak_s_a": "... of phase S",
        "peak_t_a": "... of phase T",
        "peak_percent": "highest negative-sequence voltage in a time step, of the positive-sequence one",
        "mean_10_min_percent": "highest mean of that over 10 min; of a shorter run, over all of it",
        "from_min": "where that window begins",
        "limit_percent": "what the mean is held against",
        "verdict": "`kept` or `exceeded`",
    },
    "neutral_sections": {
        "from_km": "where it begins",
        "to_km": "where it ends",
        "phases_before": "phases that feed the side of the lower kilometres",
        "phases_behind": "... and that of the higher ones",
        "angle_deg": "angle between the voltages of both sides without load",
        "highest_kv": "highest voltage across it in a time step",
        "mean_kv": "mean voltage across it",
        "at_min": "when it was highest",
    },
}

FIGURES = """## Single figures

| name | meaning |
|---|---|
| `dimensioning_train` | train with the lowest mean useful voltage, or None |
| `least_useful_voltage_kv` | what mean useful voltages are held against, by the line's highest speed |
| `unbalance_in_words` | the busbar that is closest to its limit; empty if no station tells its phases |
| `voltage_in_words` | that no train passed Umin1 or Umax1, or the longest time that one was allowed to |
| `notes` | what the figures lack, in words |
| `as_dict()` | the key figures that stand in `summary.json` under `standards` |"""


def page() -> str:
    """Text of the page."""
    changes = {"simulation.until": None, "simulation.duration_min": 5.0}
    evidence = tpss.simulate(tpss.load_scenario(EXAMPLE, changes)).standards
    blocks = [INTRODUCTION]
    for name, meanings in TABLES.items():
        blocks += [
            f"## `{name}`",
            _meaning(name),
            described(meanings, getattr(evidence, name), "column"),
        ]
    return "\n\n".join([*blocks, FIGURES])


def _meaning(name: str) -> str:
    """What a table is, from its docstring."""
    table: Any = inspect.getattr_static(tpss.Evidence, name)
    return prose(inspect.getdoc(table.func) or "")
