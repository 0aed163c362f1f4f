"""Statements of kernels for lanes, but loops."""

import ast
import copy
import inspect
import textwrap
from collections import Counter
from collections.abc import Callable
from enum import IntEnum
from typing import Any, get_args, get_origin, get_type_hints

from tpss.lanes.expressions import (
    Expressions,
    assigned,
    call,
    load,
    name,
    not_converted,
    set_to,
)
from tpss.lanes.known import SAME_PARAMETERS

CHEAP = {"as_mask", "complex", "float", "select", "both", "either", "negated", "anyone", "lane_at",
         "min", "max", "abs"}  # fmt: skip
"""Calls that are done for all lanes rather than asked whether any needs them."""

Body = list[ast.stmt]


def source_of(function: Callable[..., Any]) -> ast.FunctionDef:
    """Syntax tree of a function."""
    tree = ast.parse(textwrap.dedent(inspect.getsource(function))).body[0]
    assert isinstance(tree, ast.FunctionDef)
    return tree


def blank(hint: Any) -> ast.expr:
    """What a lane has as the result of a function until it returns: zeros."""
    if get_origin(hint) is tuple:
        return ast.Tuple([blank(each) for each in get_args(hint)], ast.Load())
    if hint is bool:
        return ast.Constant(False)
    whole = hint is int or (isinstance(hint, type) and issubclass(hint, IntEnum))
    return ast.Constant(0 if whole else 0.0)


def exits(body: Body, kinds: tuple[type[ast.stmt], ...]) -> bool:
    """Whether statements may leave what they stand in."""
    return any(isinstance(each, kinds) for one in body for each in ast.walk(one))


class Statements(Expressions):
    """The statements of one function.

    Parameters
    ----------
    function : callable
        In Python.
    lane_version : callable
        Gives the lane version of what is called, and whether that takes a mask.
    math : dict
        Lane versions of functions of `math`, by their names.
    """

    def __init__(
        self, function: Callable[..., Any], lane_version: Callable[[Any], Any], math: dict[str, Any]
    ) -> None:
        tree = source_of(function)
        parameters = [each.arg for each in tree.args.args]
        same = {each for each in parameters if each in SAME_PARAMETERS}
        super().__init__(tree, function.__globals__, same, lane_version, math)
        self.tree = tree
        self.known = set(parameters)
        self.uses = Counter(each.id for each in ast.walk(tree) if isinstance(each, ast.Name))
        self.hint = get_type_hints(function).get("return")
        self.is_masked = False
        self.has_returned = False
        self.breaks: list[str] = []
        self.skips: list[str] = []

    def block(self, body: Body) -> Body:
        """Statements under the present mask; behind one that lanes may leave by, under what is left."""
        made: Body = []
        for i, statement in enumerate(body):
            made += self.statement(statement)
            if isinstance(made[-1] if made else None, (ast.Return, ast.Continue, ast.Break)):
                break
            if left := self._who_may_have_left(statement):
                rest = body[i + 1 :]
                if not rest:
                    break
                mask = self.fresh("_m")
                made.append(set_to(mask, call("both", self.mask(), *left)))
                made += self.under(mask, rest)
                break
        return made

    def _who_may_have_left(self, statement: ast.stmt) -> list[ast.expr]:
        """The lanes that are still there behind a statement, if some may not be."""
        left: list[ast.expr] = []
        if not isinstance(statement, (ast.If, ast.While, ast.For)):
            return left
        gone: list[str] = []
        if exits([statement], (ast.Return,)) and self.has_returned:
            gone.append("_gone")
        if isinstance(statement, ast.If):
            if self.breaks and self.breaks[-1] in self.left_by:
                gone.append(self.breaks[-1])
            if self.skips and self.skips[-1] in self.left_by:
                gone.append(self.skips[-1])
        if not gone:
            return left
        everyone: ast.expr = name(gone[0])
        for each in gone[1:]:
            everyone = call("either", everyone, name(each))
        return [call("negated", everyone)]

    def under(self, mask: str, body: Body, guarded: bool = True) -> Body:
        """Statements under another mask, which is narrower."""
        outer, was_masked = self.mask_name, self.is_masked
        self.mask_name, self.is_masked = mask, True
        made = self.block(body)
        self.mask_name, self.is_masked = outer, was_masked
        return self.guard(mask, made) if guarded else made

    def guard(self, mask: str, body: Body) -> Body:
        """What costs something is skipped where no lane is left."""
        costly = any(
            isinstance(each, (ast.Div, ast.For, ast.While))
            or (isinstance(each, ast.Call) and not (
                isinstance(each.func, ast.Name) and each.func.id in CHEAP))
            for one in body for each in ast.walk(one)
        )  # fmt: skip
        return [ast.If(call("anyone", name(mask)), body, [])] if costly and body else body

    def statement(self, statement: ast.stmt) -> Body:
        """One statement under the present mask."""
        if isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant):
            return []  # a docstring
        convert = getattr(self, f"_{type(statement).__name__.lower()}", None)
        if convert is None:
            raise not_converted(statement, "a statement of an unknown kind")
        made: Body = convert(statement)
        return made

    def _pass(self, _: ast.Pass) -> Body:
        return []

    def _expr(self, statement: ast.Expr) -> Body:
        return [ast.Expr(self.visit(statement.value))]

    def _assign(self, statement: ast.Assign) -> Body:
        targets, value = statement.targets, statement.value
        if len(targets) == 1 and isinstance(targets[0], ast.Name):
            return self._store(targets[0], self.visit(value))
        if len(targets) == 1 and isinstance(targets[0], ast.Tuple):
            return self._unpack(targets[0], value)
        held = self.fresh("_t")
        made: Body = [set_to(held, self.visit(value))]
        for target in targets:
            made += self._store(target, name(held))
        return made

    def _annassign(self, statement: ast.AnnAssign) -> Body:
        if statement.value is None:
            raise not_converted(statement, "a name without a value")
        return self._store(statement.target, self.visit(statement.value))

    def _augassign(self, statement: ast.AugAssign) -> Body:
        value = ast.BinOp(load(statement.target), statement.op, statement.value)
        return self._store(statement.target, self.visit(value))

    def _unpack(self, target: ast.Tuple, value: ast.expr) -> Body:
        if all(isinstance(each, ast.Name) and not self._keeps(each.id) for each in target.elts):
            made: Body = [ast.Assign([target], self.visit(value))]
            self.known |= {each.id for each in target.elts if isinstance(each, ast.Name)} - {"_"}
            return made
        held = [self.fresh("_t") for _ in target.elts]
        if isinstance(value, ast.Tuple):
            made = [
                set_to(each, self.visit(one)) for each, one in zip(held, value.elts, strict=True)
            ]
        else:
            names = ast.Tuple([ast.Name(each, ast.Store()) for each in held], ast.Store())
            made = [ast.Assign([names], self.visit(value))]
        for one, each in zip(target.elts, held, strict=True):
            made += self._store(one, name(each))
        return made

    def _keeps(self, local: str) -> bool:
        """Whether other lanes keep what a name holds when it is set."""
        return local in self.known and self.is_masked and local not in self.same

    def _store(self, target: ast.expr, value: ast.expr) -> Body:
        """Store a value, which is converted already."""
        if isinstance(target, ast.Tuple):
            raise not_converted(target, "a tuple in a tuple")
        if isinstance(target, ast.Name):
            if self._keeps(target.id):
                value = call("select", self.mask(), value, name(target.id))
            self.known |= {target.id} - {"_"}
            return [set_to(target.id, value)]
        place = self.visit(load(target))
        stored = copy.deepcopy(place)
        stored.ctx = ast.Store()
        return [ast.Assign([stored], call("select", self.mask(), value, place))]

    def _return(self, statement: ast.Return) -> Body:
        value = None if statement.value is None else self.visit(statement.value)
        if not self.is_masked and not self.has_returned:
            return [ast.Return(value)]
        self.has_returned = True
        made: Body = [set_to("_gone", call("either", name("_gone"), self.mask()))]
        if value is not None:
            made = [set_to("_result", call("select", self.mask(), value, name("_result"))), *made]
        return made

    def _break(self, _: ast.Break) -> Body:
        return self._leave(self.breaks[-1], ast.Break())

    def _continue(self, _: ast.Continue) -> Body:
        return self._leave(self.skips[-1], ast.Continue())

    def _leave(self, left: str, plain: ast.stmt) -> Body:
        if self.mask_name == self.loop_masks[-1]:
            return [plain]
        self.left_by.add(left)
        return [set_to(left, call("either", name(left), self.mask()))]

    def _if(self, statement: ast.If) -> Body:
        test = statement.test
        if self.is_same(test):
            return self._plain_if(test, statement)
        condition, yes, no = self.fresh("_c"), self.fresh("_m"), self.fresh("_m")
        made: Body = [
            set_to(condition, call("as_mask", self.visit(test))),
            set_to(yes, call("both", self.mask(), name(condition))),
        ]
        if fast := self._way_out(statement, condition):
            made += fast
        made += self._introduce(statement.body + statement.orelse)
        for mask, body in ((yes, statement.body), (no, statement.orelse)):
            if not body:
                continue
            if mask == no:
                rest = call("negated", name(condition))
                made.append(set_to(no, call("both", self.mask(), rest)))
            before = set(self.known)
            made += self.under(mask, body)
            self.known = before
        return made

    def _way_out(self, statement: ast.If, condition: str) -> Body:
        """Where all lanes return at once, the function ends: none waits for another one."""
        only = statement.body[0]
        plain = not self.is_masked and not self.has_returned and not statement.orelse
        if not (plain and isinstance(only, ast.Return)):
            return []
        value = only.value
        if value is not None and any(isinstance(each, ast.Call) for each in ast.walk(value)):
            return []
        rest = call("both", self.mask(), call("negated", name(condition)))
        nobody = ast.UnaryOp(ast.Not(), call("anyone", rest))
        return [ast.If(nobody, [ast.Return(None if value is None else self.visit(value))], [])]

    def _plain_if(self, test: ast.expr, statement: ast.If) -> Body:
        before = set(self.known)
        body = self.block(statement.body)
        after, self.known = self.known, set(before)
        orelse = self.block(statement.orelse)
        self.known |= after
        return [ast.If(self.visit(test), body or [ast.Pass()], orelse)]

    def _introduce(self, body: Body) -> Body:
        """Zeros for names that statements set first, and that are looked at behind them."""
        new = [each for each in assigned(body) if each not in self.known | self.same | {"_"}]
        seen_later = [each for each in dict.fromkeys(new) if self._is_read_behind(body, each)]
        self.known |= set(seen_later)
        return [set_to(each, ast.Constant(0.0)) for each in seen_later]

    def _is_read_behind(self, body: Body, local: str) -> bool:
        """Whether a name is looked at behind statements before it is set anew."""
        end = body[-1].end_lineno or 0
        added = {id(each.target) for each in ast.walk(self.tree) if isinstance(each, ast.AugAssign)}
        behind = [
            each
            for each in ast.walk(self.tree)
            if isinstance(each, ast.Name) and each.id == local and each.lineno > end
        ]
        line = min((each.lineno for each in behind), default=0)
        return any(
            isinstance(each.ctx, ast.Load) or id(each) in added
            for each in behind
            if each.lineno == line
        )
