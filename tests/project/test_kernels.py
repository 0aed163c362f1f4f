"""The rule of kernels in CONTRIBUTING.md is what is done: who calls, and how often."""

import ast
from collections import Counter
from pathlib import Path

import pytest

from tpss.kernel import KERNEL_PACKAGES

SOURCE = Path(__file__).parents[2] / "src" / "tpss"
DECORATORS = {"kernel", "inlined", "fused", "fused_like_numpy"}
MOST_CALLS = 4
"""Calls of an inlined function in compiled code; each is a copy of its source to compile."""

HANDED_TO_CALLS = {"Model", "Network", "Flow", "DrivingData", "State", "Recording"}
"""Tuples of arrays, of which a call hands over each: what runs often and takes one is inlined."""

FILES = {
    file.relative_to(SOURCE).as_posix(): ast.parse(file.read_text("utf-8"))
    for package in KERNEL_PACKAGES
    for file in sorted((SOURCE / package).rglob("*.py"))
}


def module(file):
    return "tpss." + file.removesuffix(".py").replace("/", ".")


KERNELS = {
    (module(file), node.name): (decorator.id, node)
    for file, tree in FILES.items()
    for node in tree.body
    if isinstance(node, ast.FunctionDef)
    for decorator in node.decorator_list
    if isinstance(decorator, ast.Name) and decorator.id in DECORATORS
}


def calls():
    """How often each kernel is called in the kernels' sources."""
    counted = Counter()
    for file, tree in FILES.items():
        names = {}
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom):
                for each in node.names:
                    names[each.asname or each.name] = (node.module, each.name)
        for node in ast.walk(tree):
            if not isinstance(node, ast.Call):
                continue
            if isinstance(node.func, ast.Name):
                counted[names.get(node.func.id, (module(file), node.func.id))] += 1
            elif isinstance(node.func, ast.Attribute) and isinstance(node.func.value, ast.Name):
                package, name = names.get(node.func.value.id, ("", ""))
                counted[f"{package}.{name}", node.func.attr] += 1
    return counted


CALLS = calls()


def of(*kinds):
    return sorted(key for key, (kind, _) in KERNELS.items() if kind in kinds)


def test_every_kernel_lies_in_a_digested_package():
    """An edit of one that did not would leave stale code in the cache."""
    others = [
        f for f in SOURCE.rglob("*.py") if f.relative_to(SOURCE).parts[0] not in KERNEL_PACKAGES
    ]
    assert len(KERNELS) > 200
    for file in others:
        for node in ast.walk(ast.parse(file.read_text("utf-8"))):
            if isinstance(node, ast.FunctionDef):
                used = {d.id for d in node.decorator_list if isinstance(d, ast.Name)}
                assert not used & DECORATORS, (file.name, node.name)


@pytest.mark.parametrize("key", of("inlined"), ids=":".join)
def test_what_is_inlined_has_few_callers(key):
    assert 1 <= CALLS[key] <= MOST_CALLS


@pytest.mark.parametrize("key", of("fused", "fused_like_numpy"), ids=":".join)
def test_what_is_fused_has_several_callers_and_takes_records_and_numbers(key):
    _, function = KERNELS[key]
    assert CALLS[key] > 1
    taken = {ast.unparse(each.annotation) for each in function.args.args if each.annotation}
    assert not taken & HANDED_TO_CALLS
