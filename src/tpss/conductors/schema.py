"""JSON Schema of the format of geometries, made from its parts, for editors."""

from typing import Any

from tpss.conductors.geometry import Geometry
from tpss.scenario.schema import OfToml, add_unit

TITLE = "TPSS geometry"


def geometry_schema() -> dict[str, Any]:
    """JSON Schema of a file with conductors.

    It describes every key, with its unit, range and choices.  Faults between conductors (two at one
    place, a track without a contact line) are detected by `tpss.load_geometry` only.
    """
    schema = Geometry.model_json_schema(by_alias=True, schema_generator=OfToml)
    for part in (schema, *schema["$defs"].values()):
        part.pop("title", None)
        for key, field in part["properties"].items():
            add_unit(key, field)
    schema["description"] = "Conductors of a line, and the earth below them."
    return {"$schema": OfToml.schema_dialect, "title": TITLE, **schema}
