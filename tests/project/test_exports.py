"""Names that the package exports are found by it and by type checkers, from the same modules."""

import ast
from pathlib import Path

import pytest

import tpss


def names_for_type_checkers() -> dict[str, str]:
    """Names that are imported for type checkers only, and their modules."""
    source = ast.parse(Path(tpss.__file__).read_text("utf-8"))
    block = next(each for each in source.body if isinstance(each, ast.If))
    imports = [each for each in block.body if isinstance(each, ast.ImportFrom)]
    return {alias.asname: each.module for each in imports for alias in each.names}


def test_type_checkers_are_told_of_the_same_names_and_modules():
    assert names_for_type_checkers() == tpss._HOME
    assert tpss.__all__ == dir(tpss) == sorted(tpss._HOME)


@pytest.mark.parametrize("name", tpss.__all__)
def test_a_name_is_where_it_is_looked_for(name):
    assert getattr(tpss, name).__name__ == name
