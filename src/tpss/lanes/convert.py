"""Kernels for lanes, made from the kernels as they are by if-conversion.

A branch that cases may take differently becomes a mask, under which its body is carried out:

    if c: A else: B       A under m & c, B under m & ~c, each only where any lane is left
    x = e                 x = select(m, e, x)
    record.field = e      record.field = select(m, e, record.field)
    return e              result = select(m, e, result), and the lanes leave the mask
    a if c else b         select(c, a, b);  and, or, not:  both, either, negated
    for k in range(a, b)  over the bounds of all lanes, under a <= k < b
    while c               until no lane is left

What is the same in all cases (`Same` tells what that is) stays a branch.  A condition that `known`
decides goes, and with it what hangs on it.
"""

import ast
import copy
from collections import Counter

from tpss.lanes.expressions import (
    NotConvertedError,
    assigned,
    call,
    name,
    not_converted,
    set_to,
)
from tpss.lanes.statements import Body, Statements, blank, exits


class Converter(Statements):
    """The conversion of one function; parameters are those of `Statements`."""

    def converted(self) -> ast.FunctionDef:
        """The function for lanes; it takes a mask at last if `needs_mask` says so afterwards."""
        body = self.block(self.tree.body)
        if self.has_returned:
            first: Body = [set_to("_gone", call("negated", name("_mask")))]
            if self.hint is not type(None):
                first.append(set_to("_result", blank(self.hint)))
                body.append(ast.Return(name("_result")))
            body = [*first, *body]
        self.needs_mask |= any(
            isinstance(each, ast.Name) and each.id == "_mask"
            for statement in body
            for each in ast.walk(statement)
        )
        arguments = [ast.arg(each.arg) for each in self.tree.args.args]
        if self.needs_mask:
            arguments.append(ast.arg("_mask"))
        made = copy.copy(self.tree)
        rest = self.tree.args.vararg and ast.arg(self.tree.args.vararg.arg)
        made.args = ast.arguments([], arguments, rest, [], [], None, [])
        made.body, made.decorator_list, made.returns = body or [ast.Pass()], [], None
        return ast.fix_missing_locations(made)

    def _for(self, statement: ast.For) -> Body:
        bounds, k = self._turns_of(statement)
        self.known.add(k)
        if all(self.is_same(each) for each in bounds):
            again = self._each_turn(statement.body, None)
            head = ast.Call(name("range"), [self.visit(each) for each in bounds], [])
            return [ast.For(statement.target, head, again or [ast.Pass()], [])]
        if len(bounds) == 3:
            raise not_converted(
                statement.iter, "a loop in steps, which lanes begin or end apart, over"
            )
        low, high = bounds if len(bounds) == 2 else (ast.Constant(0), bounds[0])
        a, b, mask = self.fresh("_a"), self.fresh("_b"), self.fresh("_m")
        inside = call(
            "both",
            ast.Compare(name(a), [ast.LtE()], [name(k)]),
            ast.Compare(name(k), [ast.Lt()], [name(b)]),
        )
        begin = self._begin_loop(statement.body)
        body: Body = [set_to(mask, call("both", self.mask(), inside))]
        body += self._each_turn(statement.body, mask)
        head = call("range", call("lowest", name(a)), call("highest", name(b)))
        return [
            *begin,
            set_to(a, self.visit(low)), set_to(b, self.visit(high)),
            ast.For(statement.target, head, body, []),
        ]  # fmt: skip

    def _turns_of(self, statement: ast.For) -> tuple[list[ast.expr], str]:
        """Bounds of a loop over whole numbers, and the name of these."""
        head = statement.iter
        if not (
            isinstance(statement.target, ast.Name)
            and isinstance(head, ast.Call)
            and ast.unparse(head.func) == "range"
        ):
            raise not_converted(head, "a loop over what is no range")
        if statement.orelse:
            raise not_converted(head, "a loop with an end of its own, over")
        return head.args, statement.target.id

    def _each_turn(self, body: Body, mask: str | None) -> Body:
        """The body of a loop, under a mask of its own where lanes differ in their turns."""
        left, skip = self.fresh("_b"), self.fresh("_s")
        head: Body = []
        may_leave = exits(body, (ast.Break, ast.Continue)) or exits(body, (ast.Return,))
        if may_leave and mask is None:
            mask = self.fresh("_m")
            head.append(set_to(mask, self.mask()))
        self.breaks.append(left)
        self.skips.append(skip)
        self.loop_masks.append(mask or self.mask_name)
        before, was = set(self.known), self.left_by
        self.left_by = set()
        self.known -= self._set_first(body)
        made = self.block(body) if mask is None else self.under(mask, body)
        self.known |= before
        gone = []
        if exits(body, (ast.Return,)) and self.has_returned:
            gone.append("_gone")
        if left in self.left_by:
            raise NotConvertedError("a break by some lanes out of a loop over a range")
        if skip in self.left_by:
            head.append(set_to(skip, ast.Constant(False)))
        if gone:
            assert mask is not None
            head.append(set_to(mask, call("both", name(mask), call("negated", name("_gone")))))
        self.left_by = was
        self.breaks.pop()
        self.skips.pop()
        self.loop_masks.pop()
        return [*head, *made]

    def _while(self, statement: ast.While) -> Body:
        if statement.orelse:
            raise not_converted(statement.test, "a loop with an end of its own, while")
        if self.is_same(statement.test) and not exits(statement.body, (ast.Return, ast.Break)):
            test = self.visit(statement.test)
            return [ast.While(test, self._each_turn(statement.body, None), [])]
        begin = self._begin_loop(statement.body)
        mask, left = self.fresh("_w"), self.fresh("_b")
        self.breaks.append(left)
        self.skips.append(self.fresh("_s"))
        self.loop_masks.append("")
        was, self.left_by = self.left_by, set()
        outer, was_masked = self.mask_name, self.is_masked
        self.mask_name, self.is_masked = mask, True
        test = self.visit(statement.test)
        body = self.block(statement.body)
        gone = [each for each in self.left_by if each == left]
        if exits(statement.body, (ast.Return,)):
            gone.append("_gone")
        self.mask_name, self.is_masked, self.left_by = outer, was_masked, was
        self.breaks.pop()
        self.skips.pop()
        self.loop_masks.pop()
        made: Body = [*begin, set_to(mask, self.mask())]
        if left in gone:
            made.append(set_to(left, call("negated", self.mask())))
        head: Body = [
            set_to(mask, call("both", name(mask), call("negated", name(each)))) for each in gone
        ]
        head.append(set_to(mask, call("both", name(mask), call("as_mask", test))))
        nobody = ast.UnaryOp(ast.Not(), call("anyone", name(mask)))
        head.append(ast.If(nobody, [ast.Break()], []))
        return [*made, ast.While(ast.Constant(True), [*head, *body], [])]

    def _begin_loop(self, body: Body) -> Body:
        """Names that a loop changes have lanes from the start, so that each has one type."""
        new = self._introduce(body)
        changed = [each for each in dict.fromkeys(assigned(body)) if each in self.known - self.same]
        return [*new, *(set_to(each, call("in_lanes", name(each))) for each in changed)]

    def _set_first(self, body: Body) -> set[str]:
        """Names that each turn of a loop sets before it looks at them, and nothing else looks at."""
        seen: set[str] = set()
        found: set[str] = set()
        inside = Counter(
            each.id for one in body for each in ast.walk(one) if isinstance(each, ast.Name)
        )
        for one in body:
            if isinstance(one, ast.Assign):
                seen |= {x.id for x in ast.walk(one.value) if isinstance(x, ast.Name)}
                found |= {each for each in assigned([one]) if each not in seen}
            seen |= {x.id for x in ast.walk(one) if isinstance(x, ast.Name)}
        return {each for each in found if inside[each] == self.uses[each]}
