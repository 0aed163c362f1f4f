"""Checks of the tracks that services give for their trains, against those that the lines have.

They read the document as it was written, see `scenario.raw`.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from tpss.scenario.line import MOST_TRACKS
from tpss.scenario.raw import CALLS, Fault, ends_of, items, tracks_by_stretch
from tpss.scenario.routes import Hop, NoWayError, Way, calls_on

LEAVE_IT_OUT = "leave it out: trains take the track of their direction then"


def gives_tracks(entry: Mapping[str, Any]) -> bool:
    """Whether a service says on which tracks its trains run."""
    return "track" in entry or any(
        "track" in call for key in CALLS for _, call in items(entry, key)
    )


def check_tracks(
    key: str, entry: Mapping[str, Any], way: Way, lines: Mapping[str, Mapping[str, Any]]
) -> Iterator[Fault]:
    """Faults of the tracks that a service gives.

    Parameters
    ----------
    key : str
        Its key path.
    entry : mapping
        The service.
    way : Way
        Of its trains.
    lines : mapping of str to mapping
        Tables of the lines, by their names.
    """
    given: dict[int, int] = {}
    keys: dict[int, str] = {}
    for place, hop, call in _calls(entry, way):
        track = call.get("track")
        if not isinstance(track, int) or not 1 <= track <= MOST_TRACKS:
            continue  # it is not given, or has a fault of its own
        if given.setdefault(hop, track) != track:
            problem = f"{keys[hop]} gives another track at the same station, {given[hop]}"
            yield f"{key}.{place}.track", str(track), problem, "leave one of them out"
        keys.setdefault(hop, place or "the service")
    for hop, track in given.items():
        held = _on_the_line(way, hop, given)
        problem = _missing(track, held, lines)
        remedy = "give a track that is there, or leave it out"
        if not problem and _most(ahead := _on_the_line(way, hop, {}), lines) == 1:
            problem, remedy = f"{_stretch(ahead, lines)} a single track", LEAVE_IT_OUT
        if problem:
            place = "" if hop < 0 else f"{keys[hop]}."
            yield f"{key}.{place}track", str(track), problem, remedy


def _calls(entry: Mapping[str, Any], way: Way) -> Iterator[tuple[str, int, Mapping[str, Any]]]:
    """Calls of a service: keys, numbers of the hops at whose ends they are, and tables."""
    yield "", -1, entry
    for hop, (k, stop) in zip(way.stops, items(entry, "stops"), strict=True):
        yield f"stops.{k}", hop, stop
    passes = list(items(entry, "passes"))
    try:
        passed = calls_on(way.hops, [str(each.get("station")) for _, each in passes], "passes")
    except NoWayError:
        return  # a fault of its own
    for hop, (k, each) in zip(passed, passes, strict=True):
        yield f"passes.{k}", hop, each


def _on_the_line(way: Way, after: int, given: Mapping[int, int]) -> Sequence[Hop]:
    """Hops after one, as far as they stay on one line and no other track is given."""
    found = [way.hops[after + 1]]
    for i, hop in enumerate(way.hops[after + 2 :], after + 1):
        if hop.line != found[0].line or i in given:
            break
        found.append(hop)
    return found


def _most(hops: Sequence[Hop], lines: Mapping[str, Mapping[str, Any]]) -> int:
    """Number of tracks on a way over one line where it has most; 0 if the line is at fault."""
    line = lines[hops[0].line]
    ends = ends_of(line)
    counts = [] if ends is None else tracks_by_stretch(line, ends)
    spans = [sorted((hop.begin_km, hop.end_km)) for hop in hops]
    return max(
        (n for first, last, n in counts if any(b < last and first < e for b, e in spans)), default=0
    )


def _missing(track: int, hops: Sequence[Hop], lines: Mapping[str, Mapping[str, Any]]) -> str:
    """What is wrong with a track that a line has nowhere on a way; empty if it has it."""
    most = _most(hops, lines)
    if not 0 < most < track:
        return ""
    return f"{_stretch(hops, lines)} {f'{most} tracks at most' if most > 1 else 'a single track'}"


def _stretch(hops: Sequence[Hop], lines: Mapping[str, Mapping[str, Any]]) -> str:
    name = hops[0].line if len(lines) > 1 else "the line"
    return f"from {hops[0].begin} to {hops[-1].end} {name} has"
