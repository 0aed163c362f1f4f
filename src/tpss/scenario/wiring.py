"""Checks of the contact line of several tracks: its ties, posts, breaks and stretches.

They read the document as it was written, see `scenario.raw`.
"""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from tpss.scenario.feeding_points import placed_transformers
from tpss.scenario.line import CLOSEST_KM
from tpss.scenario.raw import (
    Ends,
    Fault,
    ends_of,
    items,
    lines_of,
    number,
    places_of,
    table,
    tracks_by_stretch,
)
from tpss.scenario.supply.supply import STATIONS, STORAGE
from tpss.units import kilometres

NEUTRAL, BARE = "neutral_sections", "without_contact_line"
"""Keys of the supply that list stretches which overlap no other of their kind."""


class _Stretch(NamedTuple):
    """A stretch of a line, and whether its tracks are tied."""

    begin_km: float
    end_km: float
    tracks: int
    tied: object


def check_wiring(document: Mapping[str, Any]) -> Iterator[Fault]:
    """Faults of the contact line of several tracks, of posts and breaks."""
    supply, lines = table(document, "supply"), lines_of(document)
    for i, each in items(supply, "contact_lines"):
        yield from _overlaps(i, each, supply)
    stretches = {
        name: _stretches(name, line, ends, supply, len(lines) == 1)
        for name, (_, line) in lines.items()
        if (ends := ends_of(line)) is not None
    }
    for name, (key, line) in lines.items():
        yield from _untold(name if len(lines) > 1 else "the line", stretches.get(name, []))
        yield from _early_tracks(key, line)
    for i, post in items(supply, "posts"):
        yield from _idle_post(f"supply.posts.{i}", post, stretches)
    for i, each in items(supply, "section_breaks"):
        yield from _break_at_a_node(f"supply.section_breaks.{i}", each, document)
    for i, each in items(supply, "neutral_sections"):
        yield from _neutral_at_a_node(f"supply.neutral_sections.{i}", each, document)
        yield from _meets_another(NEUTRAL, i, each, supply)
    for i, each in items(supply, BARE):
        yield from _bare_at_a_node(f"supply.{BARE}.{i}", each, document)
        yield from _meets_another(BARE, i, each, supply)


def _overlaps(i: int, here: Mapping[str, Any], supply: Mapping[str, Any]) -> Iterator[Fault]:
    for k, other in items(supply, "contact_lines"):
        if k >= i or here.get("line") != other.get("line"):
            continue
        (first, last), (begin, end) = (_span(each) for each in (here, other))
        if first < end and begin < last:
            problem = f"overlaps supply.contact_lines.{k}"
            yield f"supply.contact_lines.{i}", "", problem, "give each place one contact line"


def _span(stretch: Mapping[str, Any]) -> Ends:
    begin, end = number(stretch, "from_km"), number(stretch, "to_km")
    return -1e9 if begin is None else begin, 1e9 if end is None else end


def _stretches(
    name: str, line: Mapping[str, Any], ends: Ends, supply: Mapping[str, Any], alone: bool
) -> list[_Stretch]:
    """Stretches of a line, as far as it tells them."""
    counts = tracks_by_stretch(line, ends)
    others = [
        each for _, each in items(supply, "contact_lines") if alone or each.get("line") == name
    ]
    borders = {*ends, *(km for begin, end, _ in counts for km in (begin, end))}
    borders |= {km for each in others for km in _span(each)}
    inside = sorted(km for km in borders if ends[0] <= km <= ends[1])
    found = []
    for begin, end in zip(inside, inside[1:], strict=False):
        tracks = next((count for first, last, count in counts if first <= begin < last), 1)
        tied = supply.get("tracks_tied")
        for each in others:
            first, last = _span(each)
            if first <= begin and end <= last:
                tied = each.get("tracks_tied", tied)
        found.append(_Stretch(begin, end, tracks, tied))
    return found


def _early_tracks(key: str, line: Mapping[str, Any]) -> Iterator[Fault]:
    ends, first = ends_of(line), next((each for _, each in items(line, "tracks")), {})
    begin = number(first, "from_km")
    if ends is not None and begin is not None and begin > ends[0]:
        problem = "no number of tracks applies at the beginning of the line"
        remedy = f"make the first one begin at {kilometres(ends[0])}"
        yield f"{key}.tracks.0.from_km", kilometres(begin), problem, remedy


def _untold(line: str, stretches: list[_Stretch]) -> Iterator[Fault]:
    """Several tracks of which it is not said whether they are tied."""
    untold = next((each for each in stretches if each.tracks > 1 and each.tied is None), None)
    if untold is not None:
        problem = f"it is missing, and {line} has {untold.tracks} tracks"
        remedy = (
            'add "everywhere", "posts" or "no": tied or not changes the voltage drop of tracks by a '
            "factor of about two"
        )
        yield "supply.tracks_tied", "", problem, remedy


def _idle_post(
    key: str, post: Mapping[str, Any], stretches: Mapping[str, list[_Stretch]]
) -> Iterator[Fault]:
    """A post where no tracks are tied at posts."""
    km = number(post, "position_km")
    line = post.get("line", next(iter(stretches), None) if len(stretches) == 1 else None)
    if km is None or line not in stretches:
        return
    here = [each for each in stretches[str(line)] if each.begin_km <= km <= each.end_km]
    if here and not any(each.tracks > 1 and each.tied == "posts" for each in here):
        problem = f"ties nothing: at {kilometres(km)} km no tracks are tied at posts"
        remedy = 'leave it out, or give tracks_tied = "posts" where the line has several tracks'
        yield key, "", problem, remedy


def _break_at_a_node(
    key: str, section_break: Mapping[str, Any], document: Mapping[str, Any]
) -> Iterator[Fault]:
    """A break where the contact line is fed or meets others, so that it parts nothing."""
    km = number(section_break, "position_km")
    if km is not None and any(
        abs(place - km) < CLOSEST_KM for place in _nodes(section_break, document)
    ):
        problem = "the contact line is fed, tied or ends here"
        yield f"{key}.position_km", kilometres(km), problem, "place it beside"


def _neutral_at_a_node(
    key: str, section: Mapping[str, Any], document: Mapping[str, Any]
) -> Iterator[Fault]:
    """A neutral section in which the contact line is fed, tied or broken."""
    begin, end = number(section, "from_km"), number(section, "to_km")
    if begin is None or end is None:
        return
    places = [*_nodes(section, document, but_connections=True), *_breaks(section, document)]
    inside = [km for km in places if begin - CLOSEST_KM < km < end + CLOSEST_KM]
    if inside:
        problem = (
            f"the contact line is fed, tied, broken or ends in it, at {kilometres(inside[0])} km"
        )
        yield f"{key}.from_km", kilometres(begin), problem, "place it beside"


def _bare_at_a_node(
    key: str, stretch: Mapping[str, Any], document: Mapping[str, Any]
) -> Iterator[Fault]:
    """A stretch without contact line in which that is fed, tied, broken or neutral; a hair of one."""
    begin, end = number(stretch, "from_km"), number(stretch, "to_km")
    if begin is None or end is None or end <= begin:
        return
    if end - begin < CLOSEST_KM:
        problem, remedy = "shorter than a metre", "give it a metre or more, or leave it out"
        yield f"{key}.to_km", kilometres(end), problem, remedy
        return
    ends = ends_of(lines_of(document).get(str(stretch.get("line")), ("", {}))[1]) or ()
    lines = lines_of(document)
    if len(lines) == 1:
        ends = ends_of(next(iter(lines.values()))[1]) or ()
    places = [km for km in _nodes(stretch, document) if km not in ends]
    places += _breaks(stretch, document)
    inside = [km for km in places if begin + CLOSEST_KM < km < end - CLOSEST_KM]
    if inside:
        problem = f"what is fed, tied or broken at {kilometres(inside[0])} km would have no line"
        yield (
            f"{key}.from_km",
            kilometres(begin),
            problem,
            "place it beside, or end the stretch there",
        )
    for k, other in items(table(document, "supply"), NEUTRAL):
        first, last = _span(other)
        if _on_one_line(stretch, other, document) and first < end and begin < last:
            problem = f"overlaps supply.{NEUTRAL}.{k}"
            yield key, "", problem, "leave the neutral section out: there is no contact line"


def _meets_another(
    kind: str, i: int, here: Mapping[str, Any], supply: Mapping[str, Any]
) -> Iterator[Fault]:
    """A neutral section, or a stretch without contact line, that overlaps one before it in the file."""
    for k, other in items(supply, kind):
        (first, last), (begin, end) = (_span(each) for each in (here, other))
        if k < i and here.get("line") == other.get("line") and first < end and begin < last:
            problem = f"overlaps supply.{kind}.{k}"
            yield f"supply.{kind}.{i}", "", problem, "make one of both"


def _breaks(part: Mapping[str, Any], document: Mapping[str, Any]) -> list[float]:
    """Section breaks on the line of a part. [km]"""
    breaks = items(table(document, "supply"), "section_breaks")
    known = [
        number(each, "position_km") for _, each in breaks if _on_one_line(part, each, document)
    ]
    return [km for km in known if km is not None]


def _on_one_line(
    one: Mapping[str, Any], other: Mapping[str, Any], document: Mapping[str, Any]
) -> bool:
    """Whether two parts are on one line."""
    return len(lines_of(document)) == 1 or one.get("line") == other.get("line")


def _nodes(
    part: Mapping[str, Any], document: Mapping[str, Any], but_connections: bool = False
) -> list[float]:
    """Where the contact line of a part's line is fed, meets others or ends. [km]

    Stations with a connection, which stand at a neutral section and feed beside it, may be left out.
    """
    supply, lines = table(document, "supply"), lines_of(document)
    line = part.get("line", next(iter(lines)) if len(lines) == 1 else None)
    if line not in lines:
        return []
    fed = [
        number(each, "position_km")
        for kind in (*STATIONS, "posts", STORAGE)
        for _, each in items(supply, kind)
        if len(lines) == 1 or each.get("line") == line
        if not (but_connections and each.get("connection"))
    ]
    if len(lines) == 1 or table(supply, "high_voltage_line").get("line") == line:
        fed += placed_transformers(supply, len(lines))
    own = places_of(lines[str(line)][1])
    others = [places_of(other) for name, (_, other) in lines.items() if name != line]
    fed += [place for name, place in own.items() if any(name in each for each in others)]
    fed += list(ends_of(lines[str(line)][1]) or ())
    return [place for place in fed if place is not None]
