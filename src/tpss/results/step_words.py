"""What a summary says of its time step, in words: how it was chosen, and what moves at half of it."""

from collections.abc import Iterator, Mapping
from typing import Any

Summary = Mapping[str, Any]

_ENDS = {
    "finished": "the run finishes",
    "stalled": "a train stalls at {at:.2f} min",
    "deadlocked": "trains wait for each other at {at:.2f} min",
    "collapsed": "the line cannot carry its load at {at:.2f} min",
}
"""How a run ends, by its status."""

_IN_WORDS = {
    "trip_time_min": "the trip of {of}",
    "mean_trip_min": "the mean trip of {of}",
    "total_energy_mwh": "the energy",
    "energy_mwh": "the energy of {of}",
    "lowest_voltage_kv": "the lowest voltage",
    "peak_loading": "the peak loading of {of}",
    "duration_min": "the end of the run",
}


_SCALES = {"lowest_voltage_kv": " of its drop", "energy_mwh": " of the total"}
"""What a change is a share of, if not of the figure itself."""


def step_lines(summary: Summary) -> list[str]:
    """How the step was chosen, and what moves at half of it; results saved before know neither."""
    return [*_choice(summary), *_check(summary)]


def step_warnings(summary: Summary) -> list[str]:
    """That the step is too long, what shows it, and which one would do."""
    check = summary.get("step_check")
    if check is None or check["within"] in (None, True):
        return []
    step, half = f"{summary['time_step_min']:g} min", f"{check['half_step_min']:g} min"
    if check["status"] != summary["status"]:
        here = _ENDS[summary["status"]].format(at=summary["duration_min"])
        there = _ENDS[check["status"]].format(at=check["duration_min"])
        told = f"the step of {step} decides how the run ends: with it {here}, at half of it {there}"
    else:
        beyond = [change for change in check["changes"] if not change["within"]]
        told = (
            f"the step of {step} is too long: at half of it ({half}) {_listed(beyond)}, more than "
            f"{_percent(min(change['limit'] for change in beyond))}"
        )
    return [f"{told}; {_remedy(check)}"]


def _choice(summary: Summary) -> Iterator[str]:
    choice = summary.get("step_choice")
    if choice is None:
        return
    close = f"within {_percent(choice['largest_share'])} of the run at half of it"
    how = f"the longest one tried that keeps {close}"
    if not choice["tried_min"]:
        how = "as the run takes too long for steps to be tried"
    elif not choice["within"]:
        how = f"the shortest one tried, and none keeps {close}"
    yield f"Time step: {summary['time_step_min']:g} min, {how}"


def _check(summary: Summary) -> Iterator[str]:
    check = summary.get("step_check")
    if check is None:
        return
    if check["not_made"]:
        yield f"No step check: {check['not_made']}"
        return
    at_half = f"At half the step ({check['half_step_min']:g} min)"
    if {check["status"], summary["status"]} != {"finished"}:
        yield f"{at_half} {_ENDS[check['status']].format(at=check['duration_min'])}"
        return
    moved = {change["figure"]: change for change in check["changes"]}
    told = [f"{words} {_moved(moved[name])}" for name, words in _SHOWN.items() if name in moved]
    yield f"{at_half}: {', '.join(told) or 'nothing to compare'}"


_SHOWN = {
    "trip_time_min": "trip",
    "total_energy_mwh": "energy",
    "lowest_voltage_kv": "lowest voltage",
    "peak_loading": "peak loading",
}
"""Changes that are printed; the summary has those of each service and station too."""


def _moved(change: Mapping[str, Any]) -> str:
    """A change in the unit in which it is best understood."""
    change_of = change["at_half_step"] - change["at_step"]
    if change["figure"].endswith("_min"):
        return f"{_signed(change_of, 2)} min"
    if change["figure"].endswith("_kv"):
        return f"{_signed(1e3 * change_of, 0)} V"
    return f"{_signed(100.0 * change['share'], 1)} %"


def _signed(value: float, digits: int) -> str:
    text = f"{abs(value):.{digits}f}"
    sign = "±" if float(text) == 0.0 else "+" if value > 0.0 else "−"
    return f"{sign}{text}"


def _listed(changes: list[Mapping[str, Any]]) -> str:
    """The largest change of each kind of figure."""
    largest: dict[str, Mapping[str, Any]] = {}
    for change in sorted(changes, key=lambda change: -abs(change["share"])):
        kind = change["figure"].removeprefix("total_").replace("mean_trip", "trip_time")
        largest.setdefault(kind, change)
    texts = []
    for change in largest.values():
        scale = _SCALES.get(change["figure"], "")
        words = _IN_WORDS[change["figure"]].format(of=change["of"])
        texts.append(f"{words} moves by {_signed(100.0 * change['share'], 1)} %{scale}")
    return " and ".join(texts) if len(texts) < 3 else f"{', '.join(texts[:-1])} and {texts[-1]}"


def _remedy(check: Mapping[str, Any]) -> str:
    if check["would_do_min"] is not None:
        return f"a step of {check['would_do_min']:g} min would do"
    if not check["tried_min"]:
        return "a shorter one was not tried, as such a run takes long"
    tried = ", ".join(f"{step:g}" for step in check["tried_min"])
    return f"none of the shorter ones tried would do ({tried} min)"


def _percent(share: float) -> str:
    return f"{100.0 * share:g} %"
