"""JSON Schema of the plan format, made from its parts, for editors."""

from typing import Any

from tpss.planning.plan import PlanFile
from tpss.scenario.schema import OfToml, add_unit

TITLE = "TPSS plan"


def plan_schema() -> dict[str, Any]:
    """JSON Schema of a plan file.

    It describes every key, with its unit, range and choices.  Faults between the parts (probabilities
    that do not add up, a stage without a value, a configuration that is no valid scenario) are detected
    by ``tpss plan check`` only.
    """
    schema = PlanFile.model_json_schema(by_alias=True, schema_generator=OfToml)
    parts = schema["$defs"]
    for part in (schema, *parts.values()):
        part.pop("title", None)
        for key, field in part["properties"].items():
            add_unit(key, field)
    _be_like_another(parts["PlannedMeasure"])
    _hold_values(parts["Future"])
    for key in ("measures", "renewals"):
        _group_by_area(schema["properties"][key])
    schema["oneOf"] = [{"required": ["scenario"]}, {"required": ["areas"]}]
    schema["description"] = "What may be built, what it costs, which traffic may come."
    return {"$schema": OfToml.schema_dialect, "title": TITLE, **schema}


def _be_like_another(measure: dict[str, Any]) -> None:
    """A measure names another that it is like, or gives all required keys itself."""
    measure["anyOf"] = [{"required": ["like"]}, {"required": measure.pop("required")}]


def _hold_values(future: dict[str, Any]) -> None:
    """Values of a scenario stand beside its probability, by the key paths of what they set."""
    future["properties"].pop("values")
    future["additionalProperties"] = True


def _group_by_area(tables: dict[str, Any]) -> None:
    """Tables by name, or by area and name."""
    one = tables.pop("additionalProperties", None) or tables.pop("patternProperties", {})
    pattern = next(iter(one.values())) if "$ref" not in one else one
    tables["additionalProperties"] = {
        "anyOf": [pattern, {"type": "object", "additionalProperties": pattern}]
    }
