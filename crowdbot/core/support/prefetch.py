"""A prefetch hint for compiled code: load memory that is needed soon."""
# Numba reads the arguments of intrinsics from their definitions.

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from llvmlite import ir  # type: ignore[import-untyped]
from numba import types
from numba.extending import intrinsic

from crowdbot.core.types.arrays import Array, Indices


def _prefetch(_: Any, array: Any, k: Any) -> tuple[Any, Any]:
    """Return typing and code of `llvm.prefetch` for entry ``k`` of an array (N,)."""

    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        whole = context.make_array(signature.args[0])(context, builder, values[0])
        at = context.cast(builder, values[1], signature.args[1], types.intp)
        byte, number = ir.IntType(8).as_pointer(), ir.IntType(32)
        place = builder.bitcast(builder.gep(whole.data, [at]), byte)
        kind = ir.FunctionType(ir.VoidType(), [byte, number, number, number])
        hint = builder.module.declare_intrinsic("llvm.prefetch", [byte], kind)
        builder.call(hint, [place, number(0), number(3), number(1)])
        return context.get_dummy_value()

    return types.void(array, k), generate


if TYPE_CHECKING:

    def prefetch(array: Array | Indices, k: int) -> None:
        """Load the memory of entry ``k`` of a contiguous array (N,) into the processor's cache."""
else:
    prefetch = intrinsic(_prefetch)

__all__ = ["prefetch"]
