"""Compilation in less time: what numba's passes do again and again is done once, or not at all.

numba takes its passes over every function anew, with copies that nobody changes and lists that are
found by asking each value what it is.  Of functions that many others become part of, as the kernels
are, that is most of the time of their compilation.  What comes out is the same.

All of it holds for one release of numba; with another one, its own passes do their work.
"""

import gc
from collections import defaultdict
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from functools import reduce
from hashlib import sha256
from itertools import chain
from operator import or_
from types import SimpleNamespace
from typing import Any

import numba
from numba.core.compiler_lock import global_compiler_lock

TESTED = "0.68."
"""numba whose passes are known to allow it."""

_lock: Any = global_compiler_lock
_changed: list[bool] = []
"""Not empty while they are."""


@contextmanager
def quick_compiling() -> Iterator[None]:
    """Compile quickly within, where numba lets one thread do so at a time."""
    with _lock:
        if _changed or not numba.__version__.startswith(TESTED):
            yield
            return
        _changed.append(True)
        try:
            with ExitStack() as stack:
                stack.enter_context(_rare_search_for_garbage())
                for owner, name, quick in _changes():
                    stack.enter_context(_in_place_of(owner, name, quick))
                yield
        finally:
            _changed.pop()


OBJECTS_BEFORE_SEARCH = 1_000_000
"""New objects after which Python looks for cycles that nobody needs: about 100 MB."""


@contextmanager
def _rare_search_for_garbage() -> Iterator[None]:
    """Look for garbage seldom: a compilation makes millions of objects, and they live until its end."""
    before = gc.get_threshold()
    if before[0] == 0:  # Python is told not to look
        yield
        return
    gc.set_threshold(OBJECTS_BEFORE_SEARCH, 1, 1000)
    try:
        yield
    finally:
        gc.set_threshold(*before)


@contextmanager
def _in_place_of(owner: Any, name: str, quick: Any) -> Iterator[None]:
    slow = getattr(owner, name)
    setattr(owner, name, quick)
    try:
        yield
    finally:
        setattr(owner, name, slow)


def _changes() -> list[tuple[Any, str, Any]]:
    """What is put in place of what, while kernels are compiled."""
    from llvmlite.binding import ffi
    from numba.core import (  # isort: skip
        analysis, base, errors, inline_closurecall, ir, itanium_mangler, postproc, ssa, targetconfig,
        types,
    )  # fmt: skip
    from numba.core.types.functions import BaseFunction

    return [
        (inline_closurecall.InlineWorker, "inline_function", _inline_function),
        (ir.Inst, "_rec_list_vars", _list_variables),
        (postproc.PostProcessor, "run", _lazily(postproc.PostProcessor.run)),
        (analysis, "compute_live_map", _live_variables),
        (ssa, "_run_ssa", _run_ssa),
        (targetconfig.TargetConfig, "__eq__", _same_flags),
        (targetconfig.TargetConfig, "__hash__", _hash_of_flags),
        (BaseFunction, "get_call_type", _memo_of(BaseFunction.get_call_type)),
        (itanium_mangler, "mangle_type_or_value", _short(itanium_mangler.mangle_type_or_value)),
        (base.OverloadSelector, "find", _finding(base.OverloadSelector._select_compatible)),
        (errors, "termcolor", _Colourless),  # most only say that something else is to be tried
        (types.Record, "__repr__", _once(types.Record.__repr__)),
        (ffi.lib._lock, "_cblist", []),  # nobody measures how long LLVM is locked
    ]


def _inline_function(
    self: Any, caller: Any, block: Any, i: int, function: Any, arg_typs: Any = None
) -> Any:
    """Inline a function without two copies of what was translated for this one call."""
    from numba.core import inline_closurecall

    callee = self.run_untyped_passes(function)
    with _in_place_of(inline_closurecall, "copy", SimpleNamespace(deepcopy=lambda part: part)):
        return self.inline_ir(
            caller, block, i, callee, function.__code__.co_freevars, arg_typs=arg_typs
        )


# --- Variables of an instruction ---

_Collector = Callable[[Any, list[Any]], None]
_collectors: dict[type, _Collector | None] = {}
"""How to collect the variables in values of a type; None if there are none."""


def _list_variables(_: Any, value: Any) -> list[Any]:
    """Variables in a value, in their order."""
    found: list[Any] = []
    _collect_of([value], found)
    return found


def _collect_of(values: Any, found: list[Any]) -> None:
    for value in values:
        kind = type(value)
        if kind not in _collectors:
            _collectors[kind] = _collector(kind)
        if collect := _collectors[kind]:
            collect(value, found)


def _collector(kind: type) -> _Collector | None:
    from numba.core import ir

    if issubclass(kind, ir.Var):
        return lambda value, found: found.append(value)
    if issubclass(kind, ir.Inst):
        if kind.list_vars is ir.Stmt.list_vars:
            return lambda value, found: _collect_of(value.__dict__.values(), found)
        if kind.list_vars is ir.Expr.list_vars:
            return lambda value, found: _collect_of(value._kws.values(), found)
        return lambda value, found: found.extend(value.list_vars())
    if issubclass(kind, (list, tuple)):
        return _collect_of
    if issubclass(kind, dict):
        return lambda value, found: _collect_of(value.values(), found)
    return None


def _lazily(process: Callable[..., Any]) -> Callable[..., None]:
    """Find which variables live where only for who asks; numba does so after every pass."""
    from numba.core import postproc, transforms

    def run(self: Any, emit_dels: bool = False, extend_lifetimes: bool = False) -> None:
        if emit_dels or self.func_ir.is_generator:
            process(self, emit_dels, extend_lifetimes)
            return
        self.func_ir.blocks = transforms.canonicalize_cfg(self.func_ir.blocks)
        self.func_ir.variable_lifetime = postproc.VariableLifetime(self.func_ir.blocks)
        self.func_ir.generator_info = None

    return run


def _live_variables(
    graph: Any, blocks: Any, used: dict[int, set[str]], defined: dict[int, set[str]]
) -> dict[int, set[str]]:
    """Variables that live where each block begins, as numba finds them, with a bit for each."""
    names = list(dict.fromkeys(chain(*used.values(), *defined.values())))
    bits = {name: 1 << k for k, name in enumerate(names)}
    uses = {label: _all_of(bits, used[label]) for label in blocks}
    defines = {label: _all_of(bits, defined[label]) for label in blocks}
    order = graph.topo_order()
    reaching, living, before = dict.fromkeys(blocks, 0), dict(uses), None
    while before != reaching:
        before = dict(reaching)
        for label in order:
            reaching[label] |= defines[label] | uses[label]
            for after, _ in graph.successors(label):
                reaching[after] |= reaching[label]
    before = None
    while before != living:
        before = dict(living)
        for label in reversed(order):
            for ahead, _ in graph.predecessors(label):
                living[ahead] |= living[label] & reaching[ahead] & ~defines[ahead]
    return {label: _names_of(names, living[label]) for label in blocks}


def _all_of(bits: dict[str, int], names: set[str]) -> int:
    """The bits of names."""
    return reduce(or_, map(bits.__getitem__, names), 0)


def _names_of(names: list[str], bits: int) -> set[str]:
    """The names of bits."""
    return {names[k] for k, bit in enumerate(reversed(f"{bits:b}")) if bit == "1"}


# --- Static single assignment ---


def _run_ssa(blocks: dict[int, Any]) -> dict[int, Any]:
    """numba's reconstruction, which for each variable looks only at blocks that name it."""
    from numba.core import analysis, errors, ir, ssa

    if not blocks:
        return {}
    graph_of: Any = analysis.compute_cfg_from_blocks
    cfg = graph_of(blocks)
    fronts = ssa._iterated_domfronts(cfg)
    violators = ssa._find_defs_violators(blocks, cfg)
    listed = ssa._CacheListVars()
    assigned, used = _blocks_of_variables(blocks, listed)
    renewed = {}
    for label, block in blocks.items():
        renewed[label] = ir.Block(scope=block.scope, loc=block.loc)
        renewed[label].body = list(block.body)
    for name in violators:
        states = {**ssa._make_states(renewed), "varname": name, "defmap": defaultdict(list)}
        _rewrite(renewed, assigned[name], states, ssa._FreshVarHandler())
        states["phimap"], states["cfg"] = defaultdict(list), cfg
        states["phi_locations"] = ssa._compute_phi_locations(fronts, states["defmap"])
        _rewrite(renewed, used[name], states, ssa._FixSSAVars(listed))
        for label, phis in states["phimap"].items():
            renewed[label].body = phis + renewed[label].body
    if graph_of(renewed) != cfg:
        raise errors.CompilerError("CFG mutated in SSA pass")
    return renewed


def _blocks_of_variables(
    blocks: dict[int, Any], listed: Any
) -> tuple[dict[str, list[int]], dict[str, list[int]]]:
    """Labels of the blocks, in their order, that assign to each variable, and of those that use it."""
    from numba.core import ir

    assigned: dict[str, list[int]] = defaultdict(list)
    used: dict[str, list[int]] = defaultdict(list)
    for label, block in blocks.items():
        targets: dict[str, None] = {}
        others: dict[str, None] = {}
        for statement in block.body:
            read = statement
            if isinstance(statement, ir.Assign):
                targets[statement.target.name] = None
                read = statement.value
            if isinstance(read, ir.Var):
                others[read.name] = None
            elif isinstance(read, ir.Inst):
                others.update((variable.name, None) for variable in listed.get(read))
        for name in targets:
            assigned[name].append(label)
        for name in others:
            used[name].append(label)
    return assigned, used


def _rewrite(blocks: dict[int, Any], labels: list[int], states: Any, handler: Any) -> None:
    """Let a handler of numba's rewrite the statements of some blocks."""
    from numba.core import ir

    for label in labels:
        block = states["block"] = blocks[label]
        states["label"] = label
        block.body = [
            (handler.on_assign if isinstance(each, ir.Assign) else handler.on_other)(states, each)
            for each in block.body
        ]


# --- Types ---


def _same_flags(self: Any, other: Any) -> Any:
    """Whether options are the same; seldom does it take the values of all of them."""
    from numba.core.targetconfig import TargetConfig

    if not isinstance(other, TargetConfig):
        return NotImplemented
    if self is other or (type(self) is type(other) and self._values == other._values):
        return True
    return self.values() == other.values()


def _hash_of_flags(self: Any) -> int:
    """Hash of options: as numba's, of their names."""
    return hash(tuple(self.options))


_signatures: dict[tuple[Any, ...], tuple[Any, Any]] = {}
"""A function of numba's own and its signature, by what identifies it and the types of arguments."""


def _memo_of(resolve: Callable[..., Any]) -> Callable[..., Any]:
    """Resolve operators and functions of numba's own once for each types of numbers and records.

    Those that numba implements by functions that it compiles are resolved anew, as that compiles them.
    """
    from numba.core import types

    lasting = (types.Number, types.Boolean, types.Array, types.BaseTuple, types.Record)

    def get_call_type(self: Any, context: Any, args: Any, kws: Any) -> Any:
        if kws or not all(isinstance(each, lasting) for each in args):
            return resolve(self, context, args, kws)
        key = id(self), id(context), tuple(args)
        if key in _signatures:
            return _signatures[key][1]
        signature = resolve(self, context, args, kws)
        if self._impl_keys[signature.args] is self.typing_key:
            _signatures[key] = self, signature
        return signature

    return get_call_type


class _Colourless:
    """Colours of errors: none."""

    def __getattr__(self, _: str) -> Callable[[str], str]:
        return lambda text: text


def _finding(select: Callable[..., Any]) -> Callable[..., Any]:
    """Find implementations for types; that there is none is remembered, and no text is made of it."""
    from numba.core.errors import NumbaNotImplementedError

    def find(self: Any, types: Any) -> Any:
        if (found := self._cache.get(types)) is not None:
            return found
        lacking = self.__dict__.setdefault("_lacking", {})
        if lacking.get(types) != len(self.versions):
            if candidates := select(self, types):
                found = self._cache[types] = candidates[self._best_signature(candidates)]
                return found
            lacking[types] = len(self.versions)
        raise NumbaNotImplementedError("not implemented")

    return find


_texts: dict[int, tuple[Any, str]] = {}
"""Types of records and how they are written."""


def _once(write: Callable[[Any], str]) -> Callable[[Any], str]:
    """Write a type of records once; numba does so for each of its passes, and for errors."""

    def text(self: Any) -> str:
        if id(self) not in _texts:
            _texts[id(self)] = self, write(self)
        return _texts[id(self)][1]

    return text


LONGEST_NAME = 60
"""Longest name of a type in the name of a function."""

_short_names: dict[int, tuple[Any, str]] = {}
"""Types and their names in those of functions."""


def _short(mangle: Callable[[Any], str]) -> Callable[[Any], str]:
    """Name types of many records by a digest: whole names would be a quarter of all code."""
    from numba.core import types

    def mangle_type_or_value(kind: Any) -> str:
        if not isinstance(kind, types.Type):
            return mangle(kind)
        if id(kind) not in _short_names:
            name = mangle(kind)
            if len(name) > LONGEST_NAME:
                name = f"33T{sha256(name.encode()).hexdigest()[:32]}"
            _short_names[id(kind)] = kind, name
        return _short_names[id(kind)][1]

    return mangle_type_or_value
