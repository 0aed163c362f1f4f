"""Expressions of kernels for lanes, and what of them is the same in all cases."""

import ast
import copy
import inspect
from collections.abc import Callable
from enum import EnumMeta
from typing import Any

from tpss.lanes.known import DECIDED, SAME_ARRAYS, SAME_FIELDS


class NotConvertedError(Exception):
    """A kernel has a form that the conversion does not know; the message shows it."""


def not_converted(form: ast.AST, what: str) -> NotConvertedError:
    """What a form is, and as what it is not known."""
    return NotConvertedError(f"{what}: {ast.unparse(form)}")


def name(of: str) -> ast.Name:
    """A name that is read."""
    return ast.Name(of, ast.Load())


def call(function: str, *arguments: ast.expr) -> ast.Call:
    """A call of a function by its name."""
    return ast.Call(name(function), list(arguments), [])


def set_to(target: str, value: ast.expr) -> ast.Assign:
    """An assignment to a name."""
    return ast.Assign([ast.Name(target, ast.Store())], value)


def load(target: ast.expr) -> ast.expr:
    """What is stored to, as it is read."""
    read = copy.deepcopy(target)
    read.ctx = ast.Load()
    return read


def assigned(body: list[ast.stmt]) -> list[str]:
    """Names that statements set."""
    return [
        each.id
        for one in body
        for each in ast.walk(one)
        if isinstance(each, ast.Name) and isinstance(each.ctx, ast.Store)
    ]


def _is_whole(test: ast.expr, value: bool) -> bool:
    return isinstance(test, ast.Constant) and test.value is value


_UNKNOWN = (
    ast.Lambda, ast.NamedExpr, ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp, ast.Yield,
    ast.YieldFrom, ast.Await,
)  # fmt: skip


class Pruned(ast.NodeTransformer):
    """Takes out what hangs on conditions that are decided."""

    def __init__(self, fold: Callable[[ast.expr], ast.expr]) -> None:
        self.fold = fold

    def visit_If(self, node: ast.If) -> Any:
        """A branch that is decided goes."""
        node.test = self.fold(node.test)
        self.generic_visit(node)
        if isinstance(node.test, ast.Constant):
            return node.body if node.test.value else node.orelse
        node.body = node.body or [ast.Pass()]
        return node


class Expressions(ast.NodeTransformer):
    """The expressions of one function.

    Parameters
    ----------
    tree : ast.FunctionDef
    space : dict
        Its global names.
    same : set of str
        Parameters that are the same in all cases.
    lane_version : callable
        Gives the lane version of what is called, and whether that takes a mask.
    math : dict
        Lane versions of functions of `math`, by their names.
    """

    def __init__(
        self, tree: ast.FunctionDef, space: dict[str, Any], same: set[str],
        lane_version: Callable[[Any], Any], math: dict[str, Any],
    ) -> None:  # fmt: skip
        self.space, self.lane_version, self.math = space, lane_version, math
        self.replaced: dict[str, Any] = {}
        self.needs_mask = False
        self.mask_name = "_mask"
        self._narrowed: ast.expr | None = None
        self._count = 0
        self.left_by: set[str] = set()
        self.loop_masks: list[str] = []
        self.local = {each.arg for each in tree.args.args} | set(assigned(tree.body))
        Pruned(self.fold).visit(tree)
        self.same = set(same)
        self.same |= self._find_same(tree)

    def fresh(self, prefix: str) -> str:
        """A name that is not in use."""
        self._count += 1
        return f"{prefix}{self._count}"

    def mask(self) -> ast.expr:
        """The present mask."""
        return name(self.mask_name) if self._narrowed is None else copy.deepcopy(self._narrowed)

    # What is the same in all cases

    def _find_same(self, tree: ast.FunctionDef) -> set[str]:
        """Local names that only ever hold what is the same in all cases."""
        values: dict[str, list[ast.expr | None]] = {}
        counters: set[str] = set()
        for each in ast.walk(tree):
            if isinstance(each, ast.For) and isinstance(each.target, ast.Name):
                counters.add(each.target.id)
            elif isinstance(each, ast.Assign):
                for target in each.targets:
                    self._note(target, each.value, values)
            elif isinstance(each, (ast.AugAssign, ast.AnnAssign)):
                self._note(each.target, each.value, values)
        branches = [each for each in ast.walk(tree) if isinstance(each, (ast.If, ast.While))]
        parameters = {each.arg for each in tree.args.args}
        found = {each for each in values if each not in parameters} | counters
        while True:
            self.same |= found
            wrong = {
                each
                for each in found
                if any(v is None or not self.is_same(v) for v in values.get(each, []))
                or (len(values.get(each, [])) > 1 and self._differs(each, branches))
            }
            if not wrong:
                return found
            self.same -= wrong
            found -= wrong

    def _differs(self, local: str, branches: list[Any]) -> bool:
        """Whether a name is set where lanes may go different ways."""
        return any(
            local in assigned(each.body + each.orelse) and not self.is_same(self.fold(each.test))
            for each in branches
        )

    def _note(self, target: ast.expr, value: Any, values: dict[str, list[Any]]) -> None:
        if isinstance(target, ast.Name):
            values.setdefault(target.id, []).append(value)
        elif isinstance(target, ast.Tuple):
            for each in target.elts:
                if not isinstance(each, (ast.Name, ast.Attribute, ast.Subscript)):
                    raise not_converted(target, "names unpacked within others")
            apart = value.elts if isinstance(value, ast.Tuple) else [None] * len(target.elts)
            for each, one in zip(target.elts, apart, strict=True):
                self._note(each, one, values)

    def is_same(self, value: ast.expr) -> bool:
        """Whether an expression is a plain value that is the same in all cases."""
        if isinstance(value, ast.Constant):
            return True
        if isinstance(value, ast.Name):
            return value.id in self.same or value.id not in self.local
        if isinstance(value, ast.Attribute):
            owner = ast.unparse(value.value).rsplit(".", 1)[-1]
            listed = value.attr in SAME_FIELDS or f"{owner}.{value.attr}" in SAME_FIELDS
            return listed or self._is_global(value)
        if isinstance(value, ast.Subscript):
            array = ast.unparse(value.value).rsplit(".", 1)[-1]
            return array in SAME_ARRAYS and self.is_same(value.slice)
        if isinstance(value, ast.Call):
            plain = ast.unparse(value.func) in ("at", "min", "max", "abs", "bool", "float")
            return plain and all(self.is_same(each) for each in value.args)
        inner = [each for each in ast.iter_child_nodes(value) if isinstance(each, ast.expr)]
        simple = (ast.BinOp, ast.UnaryOp, ast.BoolOp, ast.Compare, ast.IfExp)
        return isinstance(value, simple) and all(self.is_same(each) for each in inner)

    def _is_global(self, value: ast.Attribute) -> bool:
        return isinstance(value.value, ast.Name) and value.value.id not in self.local

    # What is decided

    def fold(self, test: ast.expr) -> ast.expr:
        """A condition less what is decided."""
        if isinstance(test, (ast.Compare, ast.Attribute)):
            text = ast.unparse(test)
            for decided, value in DECIDED.items():
                if text == decided or text.endswith(f".{decided}"):
                    return ast.Constant(value)
        if isinstance(test, ast.Call) and (function := ast.unparse(test.func)) in DECIDED:
            return ast.Constant(DECIDED[function])
        if isinstance(test, ast.Call) and hasattr(found := self._called(test.func), "without"):
            return self._fold_without(found.without, test)
        if isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not):
            inner = self.fold(test.operand)
            if isinstance(inner, ast.Constant):
                return ast.Constant(not inner.value)
            return ast.UnaryOp(ast.Not(), inner)
        if isinstance(test, ast.BoolOp):
            ends = isinstance(test.op, ast.Or)
            rest = [self.fold(each) for each in test.values]
            rest = [each for each in rest if not _is_whole(each, not ends)]
            if any(_is_whole(each, ends) for each in rest):
                return ast.Constant(ends)
            if len(rest) < 2:
                return rest[0] if rest else ast.Constant(not ends)
            return ast.BoolOp(test.op, rest)
        return test

    def _fold_without(self, without: Any, test: ast.Call) -> ast.expr:
        """What a function gives where there is nothing that it asks about, if that is a constant."""
        source = ast.parse(inspect.getsource(without)).body[0]
        last = source.body[-1]
        constant = isinstance(last, ast.Return) and isinstance(last.value, ast.Constant)
        return last.value if constant else test

    # Expressions

    def generic_visit(self, node: ast.AST) -> ast.AST:
        """Of other expressions their parts."""
        if isinstance(node, _UNKNOWN):
            raise not_converted(node, "an expression of an unknown kind")
        return super().generic_visit(node)

    def visit_BoolOp(self, node: ast.BoolOp) -> ast.expr:
        """Masks joined; what is called sees the lanes that are left."""
        folded = self.fold(node)
        if not isinstance(folded, ast.BoolOp):
            return self.visit(folded)
        if self.is_same(folded):
            return self.generic_visit(folded)  # type: ignore[return-value]
        join = "both" if isinstance(folded.op, ast.And) else "either"
        outer = self._narrowed
        made = call("as_mask", self.visit(folded.values[0]))
        for each in folded.values[1:]:
            left = made if join == "both" else call("negated", made)
            self._narrowed = outer
            self._narrowed = call("both", self.mask(), copy.deepcopy(left))
            made = call(join, made, call("as_mask", self.visit(each)))
            self._narrowed = outer
        return made

    def visit_UnaryOp(self, node: ast.UnaryOp) -> ast.expr:
        """A mask's other lanes."""
        if not isinstance(node.op, ast.Not):
            return self.generic_visit(node)  # type: ignore[return-value]
        return call("negated", call("as_mask", self.visit(node.operand)))

    def visit_IfExp(self, node: ast.IfExp) -> ast.expr:
        """A choice by a mask."""
        test = self.fold(node.test)
        if isinstance(test, ast.Constant):
            return self.visit(node.body if test.value else node.orelse)
        if self.is_same(test):
            return self.generic_visit(node)  # type: ignore[return-value]
        condition = call("as_mask", self.visit(test))
        outer, whole = self._narrowed, self.mask()
        self._narrowed = call("both", whole, copy.deepcopy(condition))
        body = self.visit(node.body)
        rest = call("negated", copy.deepcopy(condition))
        self._narrowed = call("both", copy.deepcopy(whole), rest)
        orelse = self.visit(node.orelse)
        self._narrowed = outer
        return call("select", condition, body, orelse)

    def visit_Compare(self, node: ast.Compare) -> ast.expr:
        """Chains apart; what is one of several is compared with each."""
        if isinstance(self.fold(node), ast.Constant):
            return self.fold(node)
        left, right = self.visit(node.left), [self.visit(each) for each in node.comparators]
        if isinstance(node.ops[0], ast.In) and isinstance(right[0], ast.Tuple) and not right[1:]:
            tested: list[ast.expr] = [
                ast.Compare(copy.deepcopy(left), [ast.Eq()], [each]) for each in right[0].elts
            ]
            join = "either"
        elif any(isinstance(op, (ast.In, ast.NotIn, ast.Is, ast.IsNot)) for op in node.ops):
            raise not_converted(node, "a comparison of an unknown kind")
        else:
            tested = [
                ast.Compare(copy.deepcopy(a), [op], [copy.deepcopy(b)])
                for a, op, b in zip([left, *right], node.ops, right, strict=False)
            ]
            join = "both"
        made = tested[0]
        for each in tested[1:]:
            made = call(join, made, each)
        return made

    def visit_BinOp(self, node: ast.BinOp) -> ast.expr:
        """A square is a product."""
        left, right = self.visit(node.left), self.visit(node.right)
        if isinstance(node.op, ast.Pow):
            if not (isinstance(right, ast.Constant) and right.value == 2):
                raise not_converted(node, "a power that is not a square")
            return ast.BinOp(left, ast.Mult(), copy.deepcopy(left))
        return ast.BinOp(left, node.op, right)

    def visit_Attribute(self, node: ast.Attribute) -> ast.expr:
        """Members of enumerations are numbers."""
        owner = self.space.get(node.value.id) if isinstance(node.value, ast.Name) else None
        if isinstance(owner, EnumMeta) and isinstance(node.value, ast.Name):
            known = f"{node.value.id}_{node.attr}"
            self.replaced[known] = int(getattr(owner, node.attr))
            return name(known)
        return self.generic_visit(node)  # type: ignore[return-value]

    def visit_Call(self, node: ast.Call) -> ast.expr:
        """Kernels are their lane versions."""
        folded = self.fold(node)
        if isinstance(folded, ast.Constant):
            return folded
        if node.keywords:
            raise not_converted(node, "a call with names of arguments")
        text = ast.unparse(node.func)
        if text == "bool":
            return self.visit(node.args[0])
        if text.startswith("math.") and text[5:] in self.math:
            known = f"lane_{text[5:]}"
            self.replaced[known] = self.math[text[5:]]
            return ast.Call(name(known), [self.visit(each) for each in node.args], [])
        found = self._called(node.func)
        arguments = [self.visit(each) for each in node.args]
        if text in ("min", "max") and len(arguments) == 3:
            return call(text, call(text, *arguments[:2]), arguments[2])
        if text == "at":
            return call("lane_at", *arguments)
        if hasattr(found, "py_func") or hasattr(found, "without"):
            version, takes_mask = self.lane_version(found)
            known = f"{text.replace('.', '_')}_lanes"
            self.replaced[known] = version
            if takes_mask:
                self.needs_mask = True
                arguments.append(self.mask())
            return call(known, *arguments)
        return ast.Call(self.visit(node.func), arguments, [])

    def _called(self, function: ast.expr) -> Any:
        """What a call calls, if that is found by global names."""
        if isinstance(function, ast.Name):
            return None if function.id in self.local else self.space.get(function.id)
        if isinstance(function, ast.Attribute) and isinstance(function.value, ast.Name):
            return getattr(self.space.get(function.value.id), function.attr, None)
        return None
