"""Kernels that only kernels call: no machine code of their own, and nothing for Python to call.

Machine code of a kernel holds that of all that it calls.  numba makes it for each of these by itself
too, with an interface for Python, although nobody calls most of them: a third of the time that LLVM has
to work.  Here a kernel that another one asks for is optimised, and kept, as an intermediate form, which
becomes part of the callers.  If Python calls it after all, it gets its machine code and its interface.
"""

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from numba.core.caching import CompileResultCacheImpl
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler, CompileResult
from numba.core.compiler_machinery import register_pass
from numba.core.lowering import Lower
from numba.core.registry import CPUDispatcher
from numba.core.sigutils import normalize_signature
from numba.core.typed_passes import NativeLowering

from tpss.quick_compiling import quick_compiling

# Classes of numba have no types.
_Library: Any = JITCodeLibrary
_Lower: Any = Lower
_Lowering: Any = NativeLowering
_Pipeline: Any = Compiler
_Dispatcher: Any = CPUDispatcher
_Results: Any = CompileResultCacheImpl
_Result: Any = CompileResult

FORM = "called"
"""How the cache names the form of a kernel that only kernels call."""

_asking = threading.local()


@contextmanager
def for_kernels(kernels: bool = True) -> Iterator[None]:
    """Compile within for kernels that call what is compiled, or for Python."""
    before = _are_for_kernels()
    _asking.kernels = kernels
    try:
        yield
    finally:
        _asking.kernels = before


def _are_for_kernels() -> bool:
    return getattr(_asking, "kernels", False)


class _WithoutEnvironment:
    """The generator of machine code, to which a kernel without any gives no place for its globals."""

    def __init__(self, codegen: Any) -> None:
        self._codegen = codegen

    def __getattr__(self, name: str) -> Any:
        return getattr(self._codegen, name)

    def set_env(self, _: str, __: Any) -> None:
        """The callers' machine code has that place."""


class CalledLibrary(_Library):  # type: ignore[misc]
    """Code of a kernel that only kernels call: optimised, and no more."""

    @classmethod
    def of(cls, codegen: Any, state: tuple[str, str, bytes]) -> "CalledLibrary":
        """From what was kept; see `serialize_using_object_code`."""
        from llvmlite import binding

        name, _, bitcode = state
        library = cls(codegen, name)
        library._final_module = binding.parse_bitcode(bitcode)
        library._finalize_final_module()
        return library

    @property
    def codegen(self) -> Any:
        """What would make machine code."""
        return _WithoutEnvironment(self._codegen)

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._verify_declare_only_symbols()
        self._finalized = True

    def get_pointer_to_function(self, _: str) -> int:
        """There is no machine code to point to."""
        self._ensure_finalized()
        return 0

    def serialize_using_object_code(self) -> tuple[str, str, bytes]:
        """What is kept, in place of machine code."""
        self._ensure_finalized()
        return self.name, FORM, self._final_module.as_bitcode()


class _CalledLower(_Lower):  # type: ignore[misc]
    def create_cpython_wrapper(self, release_gil: bool = False) -> None:
        """Python does not call it."""


class _CalledLowering(_Lowering):  # type: ignore[misc]
    lowering_class = _CalledLower


@register_pass(mutates_CFG=True, analysis_only=False)
class KernelLowering(_Lowering):  # type: ignore[misc]
    """numba's last pass, for a kernel that Python calls, or that only kernels do."""

    _name = "kernel_lowering"

    def run_pass(self, state: Any) -> bool:
        """Make code for LLVM."""
        if not _are_for_kernels():
            return bool(super().run_pass(state))
        state.library = CalledLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        return bool(_CalledLowering().run_pass(state))


class KernelCompiler(_Pipeline):  # type: ignore[misc]
    """numba's passes, with `KernelLowering` in place of its own."""

    def define_pipelines(self) -> list[Any]:
        """The order of the passes."""
        pipelines: list[Any] = super().define_pipelines()
        for each in pipelines:
            each.passes = [
                (KernelLowering, text) if made is NativeLowering else (made, text)
                for made, text in each.passes
            ]
            each.finalize()
        return pipelines


class KernelDispatcher(_Dispatcher):  # type: ignore[misc]
    """A kernel."""

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """Of a call in a kernel."""
        with for_kernels():
            return super().get_call_template(args, kws)

    def add_overload(self, result: Any) -> None:
        """Note what was compiled for types; Python hears only of what it can call."""
        if isinstance(result.library, CalledLibrary):
            self.overloads[tuple(result.signature.args)] = result
        else:
            super().add_overload(result)

    def compile(self, sig: Any) -> Any:
        """Compile for types; return what stands for it, or, if Python asks, what it can call."""
        types = tuple(normalize_signature(sig)[0])
        kept = self.overloads.get(types)
        if kept and (_are_for_kernels() or not isinstance(kept.library, CalledLibrary)):
            return kept.entry_point
        with quick_compiling():
            entry = super().compile(sig)
            if _are_for_kernels():
                return entry
            result = _with_environments(self.overloads[types])
            if isinstance(result.library, CalledLibrary):
                result = _for_python(result)
                self.targetctx.insert_user_function(
                    result.entry_point, result.fndesc, [result.library]
                )
                self.add_overload(result)
                self._cache.save_overload(sig, result)
        return result.entry_point


def _for_python(result: Any) -> Any:
    """What Python can call, of a kernel that so far only kernels did."""
    context, described, environment = result.target_context, result.fndesc, result.environment
    library = context.codegen().create_library(result.library.name)
    library.enable_object_caching()
    library.add_linking_library(result.library)
    with context.push_code_library(library):
        context.create_cpython_wrapper(library, described, environment, None, release_gil=True)
    entry = context.get_executable(library, described, environment)
    return _with_environments(result._replace(library=library, entry_point=entry))


def _with_environments(result: Any) -> Any:
    """Tell machine code where the globals are of all kernels that are part of it."""
    for each in result._find_referenced_environments():
        result.library.codegen.set_env(each.env_name, each)
    return result


class KernelResults(_Results):  # type: ignore[misc]
    """How compiled kernels are kept."""

    def reduce(self, result: Any) -> Any:
        """What is kept; numba's listing of the types in the source is not."""
        return super().reduce(result._replace(type_annotation=""))

    def rebuild(self, target_context: Any, payload: tuple[Any, ...]) -> Any:
        """From what was kept."""
        kept, described, environment, signature, objectmode, lifted, text, reload, others = payload
        if kept[1] != FORM:
            return super().rebuild(target_context, payload)
        library = CalledLibrary.of(target_context.codegen(), kept)
        return _Result(
            target_context=target_context,
            typing_context=target_context.typing_context,
            library=library,
            environment=environment,
            entry_point=target_context.get_executable(library, described, environment),
            fndesc=described,
            type_annotation=text,
            signature=signature,
            objectmode=objectmode,
            lifted=lifted,
            typing_error=None,
            call_helper=None,
            metadata=None,
            reload_init=reload,
            referenced_envs=others,
        )  # fmt: skip
