"""From a scenario to arrays in SI units, sorted and indexed, once."""

from tpss.model.build import Layout, build_model

__all__ = ["Layout", "build_model"]
