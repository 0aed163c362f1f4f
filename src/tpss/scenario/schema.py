"""JSON Schema of the scenario format, made from the parts themselves, for editors."""

from typing import Any

from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue

from tpss import library, units
from tpss.scenario.fields import OWN_FILE
from tpss.scenario.scenario import Scenario

TITLE = "TPSS scenario"


class OfToml(GenerateJsonSchema):
    """Schema for TOML, which has no null; its keys need no titles."""

    def nullable_schema(self, schema: Any) -> JsonSchemaValue:
        """Schema of a value that may be left out: that of the value."""
        return self.generate_inner(schema["schema"])

    def default_schema(self, schema: Any) -> JsonSchemaValue:
        """Schema of a value with a default, which is not told where it is none."""
        if schema.get("default") is None:
            return self.generate_inner(schema["schema"])
        return super().default_schema(schema)

    def field_title_should_be_set(self, _: Any) -> bool:
        """Whether a key has a title."""
        return False


def scenario_schema() -> dict[str, Any]:
    """JSON Schema of a scenario file.

    It describes every key, with its unit, range and choices, and lists the names in the library.
    Faults between the parts (a train that does not exist, a stop outside the line) are detected by
    `tpss.load_scenario` only.
    """
    schema = Scenario.model_json_schema(by_alias=True, schema_generator=OfToml)
    parts = schema["$defs"]
    for part in (schema, *parts.values()):
        part.pop("title", None)
        for key, field in part["properties"].items():
            add_unit(key, field)
    _start_from_a_model(parts["Train"])
    _start_from_a_system(parts["VoltageLimits"])
    _demand_reactance_of_alternating_current(parts["Supply"], parts["Catenary"])
    line = schema["properties"]["line"]
    schema["properties"]["line"] = {"description": "The line.", "anyOf": [OWN_FILE, line]}
    lines = schema["properties"]["lines"]
    lines["additionalProperties"] = {"anyOf": [OWN_FILE, lines["additionalProperties"]]}
    schema["required"].remove("traffic")
    schema["allOf"] = [
        {"anyOf": [{"required": ["line"]}, {"required": ["lines"]}]},
        {"anyOf": [{"required": ["traffic"]}, {"required": ["timetables"]}]},
    ]
    for station in ("ConverterStation", "TransformerStation", "MixedStation", "RectifierStation"):
        _stand_at_a_station(parts[station])
    schema["description"] = "A line, its power supply, its trains and its traffic."
    return {"$schema": OfToml.schema_dialect, "title": TITLE, **schema}


def add_unit(key: str, field: dict[str, Any]) -> None:
    """Add the unit of a key to its description."""
    unit = units.label(key)
    if unit:
        field["description"] = f"{field.get('description', '')} [{unit}]".strip()


def _stand_at_a_station(station: dict[str, Any]) -> None:
    """A station of the line gives the position of what stands at it."""
    station["required"].remove("position_km")
    station["anyOf"] = [{"required": ["position_km"]}, {"required": ["at"]}]


def _demand_reactance_of_alternating_current(
    supply: dict[str, Any], catenary: dict[str, Any]
) -> None:
    """The contact line of an alternating current has a reactance, that of a direct one has none."""
    key = "x_ohm_per_km"
    catenary["required"].remove(key)
    catenary["anyOf"] = [{"required": ["r_ohm_per_km"]}, {"required": ["contact_line", "rails"]}]
    own = {"if": {"type": "object"}, "then": {"required": [key]}}
    systems = library.entries("systems")
    direct = sorted(name for name, each in systems.items() if each["frequency_hz"] == 0.0)
    supply["if"] = {"properties": {"system": {"enum": direct}}, "required": ["system"]}
    supply["else"] = {
        "properties": {
            "catenary": own,
            "contact_lines": {"items": {"properties": {"catenary": own}}},
        }
    }


def _start_from_a_model(train: dict[str, Any]) -> None:
    """A train names a library model or a file, or gives all required keys itself."""
    names = {"type": "string", "enum": sorted(library.entries("locomotives"))}
    description = train["properties"]["model"]["description"]
    train["properties"]["model"] = {"anyOf": [names, OWN_FILE], "description": description}
    train["anyOf"] = [{"required": ["model"]}, {"required": train.pop("required")}]


def _start_from_a_system(limits: dict[str, Any]) -> None:
    """Voltage limits start from a system of the library, which gives the keys common to all."""
    entries = library.entries("voltage_limits")
    given = set.intersection(*(set(entry) for entry in entries.values()))
    limits["required"] = [name for name in limits["required"] if name not in given]
    limits["properties"]["system"]["enum"] = sorted(entries)
