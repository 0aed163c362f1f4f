"""JSON Schema of the scenario format, made from the parts themselves, for editors."""

from typing import Any

from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue

from tpss import library, units
from tpss.scenario.fields import OWN_FILE
from tpss.scenario.scenario import Scenario

TITLE = "TPSS scenario"


class _OfToml(GenerateJsonSchema):
    """Schema of what a TOML file can say: it has no null, and its keys need no titles."""

    def nullable_schema(self, schema: Any) -> JsonSchemaValue:
        return self.generate_inner(schema["schema"])

    def default_schema(self, schema: Any) -> JsonSchemaValue:
        if schema.get("default") is None:
            return self.generate_inner(schema["schema"])
        return super().default_schema(schema)

    def field_title_should_be_set(self, _: Any) -> bool:
        return False


def scenario_schema() -> dict[str, Any]:
    """JSON Schema of a scenario file.

    It knows every key, with its description, unit, range and choices, and the names in the library.
    What lies between the parts (a train that does not exist, a stop outside the line) is found by
    `tpss.load_scenario` only.
    """
    schema = Scenario.model_json_schema(by_alias=True, schema_generator=_OfToml)
    parts = schema["$defs"]
    for part in (schema, *parts.values()):
        part.pop("title", None)
        for key, field in part["properties"].items():
            _add_unit(key, field)
    _lean_on_the_library(parts["Train"])
    line = schema["properties"]["line"]
    schema["properties"]["line"] = {"description": "The line.", "anyOf": [OWN_FILE, line]}
    schema["description"] = "A line, its power supply, its trains and its traffic."
    return {"$schema": _OfToml.schema_dialect, "title": TITLE, **schema}


def _add_unit(key: str, field: dict[str, Any]) -> None:
    unit = units.label(key)
    if unit:
        field["description"] = f"{field.get('description', '')} [{unit}]".strip()


def _lean_on_the_library(train: dict[str, Any]) -> None:
    """A train names a library model or a file, or gives by itself what those would give."""
    names = {"type": "string", "enum": sorted(library.entries("locomotives"))}
    model = train["properties"]["model"]
    train["properties"]["model"] = {
        "anyOf": [names, OWN_FILE],
        "description": model["description"],
    }
    train["anyOf"] = [{"required": ["model"]}, {"required": train.pop("required")}]
