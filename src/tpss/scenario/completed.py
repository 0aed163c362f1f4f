"""Values of a train or of other equipment, completed with those that they start from."""

from collections.abc import Mapping
from typing import Any


def completed(given: Mapping[str, Any], model: Mapping[str, Any]) -> dict[str, Any]:
    """Values of a train, completed with those of its model that they do not replace."""
    replaced: set[str] = set()
    if given.get("rotating_mass_share") is not None:
        replaced = {"rotating_mass_factor", "motor_inertia_kg"}
    elif given.get("rotating_mass_factor") is not None:
        replaced = {"rotating_mass_share"}
    return {**{key: value for key, value in model.items() if key not in replaced}, **given}
