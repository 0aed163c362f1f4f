"""The judgement of equipment in words."""

from collections.abc import Mapping
from typing import Any

from tpss.results.thermal.judge import OF_THE_RUN

MOST_LISTED = 3
"""Equipment beyond what it bears that is listed."""


def thermal_in_words(figures: Mapping[str, Any] | None) -> list[str]:
    """Lines on the thermal part of a summary: what is too hot, or what came closest to it."""
    if figures is None or not figures["judged"]:
        return []
    items, over = list(figures["elements"].items()), figures["over"]
    count = f"{figures['judged']} rated"
    if not over:
        name, hottest = items[0]
        return [
            f"Thermal: {count}, all within what they bear; closest to it is {name}: {_of(hottest)}"
        ]
    listed = items[: min(over, MOST_LISTED)]
    more = f", and {over - len(listed)} more" if over > len(listed) else ""
    words = "; ".join(f"{name}: {_of(each)}" for name, each in listed)
    return [f"Thermal: {over} of {count} over what they bear: {words}{more}"]


def _of(judged: Mapping[str, Any]) -> str:
    """What decides over a piece of equipment, when, by which trains, and from which start."""
    by_state = judged["highest_state_percent"] / judged["allowed_state_percent"]
    by_load = judged.get("highest_rms_percent", 0.0) / judged.get("allowed_rms_percent", 1.0)
    if by_load > by_state:
        text = (
            f"{judged['highest_rms_percent']:.1f} % r.m.s. over {judged['window_min']:g} min from "
            f"{judged['from_min']:.2f} min, {judged['allowed_rms_percent']:.1f} % allowed"
        )
    else:
        text = (
            f"thermal state {judged['highest_state_percent']:.1f} % at "
            f"{judged['state_at_min']:.2f} min, {judged['allowed_state_percent']:.1f} % allowed"
        )
        if "highest_temperature_c" in judged:
            text = f"{judged['highest_temperature_c']:.0f} °C, {text}"
    if "trains" in judged:
        text += f", by {judged['trains']}"
    before = "the r.m.s. load of the run" if judged["start"] == OF_THE_RUN else "a preload"
    return f"{text} (before the run {before}, {judged['start_load_percent']:.0f} %)"
