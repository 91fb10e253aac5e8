"""Calls from compiled code into cost functions, by address.

Numba can also pass functions as arguments, but types them in each call from Python, and
compiles the caller for each number of them. An address is a number: one compiled search
serves all combinations of costs.
"""
# Numba reads the arguments of intrinsics from their definitions.
# ruff: noqa: ARG001

from __future__ import annotations

from typing import Any

from llvmlite import ir  # type: ignore[import-untyped]
from numba import types
from numba.extending import intrinsic

from crowdbot.core.crowd.velocity_search.cost import (
    BASE,
    EXCESS,
    GRADIENT,
    LOWER_BOUND,
    OPTIMUM,
    PREPARE,
)
from crowdbot.core.support.records import start_of


def address_of(function: Any, signature: Any) -> int:
    """Return the address of the C function compiled by numba; valid while ``function`` lives."""
    result = function.get_compile_result(signature)
    return int(result.library.get_pointer_to_function(result.fndesc.llvm_cfunc_wrapper_name))


def _call(signature: Any, *given: Any) -> tuple[Any, Any]:
    """Return typing and code of a call: address of the function, then its arguments.

    Records, arrays and integers become pointers here.
    """
    pointers = types.CPointer | types.Record
    taken = [types.intp if isinstance(kind, pointers) else kind for kind in signature.args]
    for k, actual in enumerate(given):
        if isinstance(actual, types.Record | types.Array):
            taken[k] = actual

    def generate(context: Any, builder: Any, _: Any, values: Any) -> Any:
        llvm_types = [context.get_value_type(a) for a in signature.args]
        kind = ir.FunctionType(context.get_value_type(signature.return_type), llvm_types)
        arguments = [
            _pointer(context, builder, how, value, want)
            if isinstance(want, ir.PointerType)
            else value
            for how, value, want in zip(taken, values[1:], llvm_types, strict=True)
        ]
        return builder.call(builder.inttoptr(values[0], kind.as_pointer()), arguments)

    return signature.return_type(types.intp, *taken), generate


def _pointer(context: Any, builder: Any, kind: Any, value: Any, llvm_type: Any) -> Any:
    if isinstance(kind, types.Integer):
        return builder.inttoptr(value, llvm_type)
    return builder.bitcast(start_of(context, builder, kind, value), llvm_type)


def _base(
    _: Any, at: Any, ux: Any, uy: Any, preferred: Any, max_speed: Any, params: Any
) -> tuple[Any, Any]:
    return _call(BASE, ux, uy, preferred, max_speed, params)


def _prepare(
    _: Any,
    at: Any,
    agent: Any,
    near: Any,
    near_count: Any,
    walls: Any,
    wall_count: Any,
    params: Any,
    work: Any,
) -> tuple[Any, Any]:
    return _call(PREPARE, agent, near, near_count, walls, wall_count, params, work)


def _excess(
    _: Any, at: Any, ux: Any, uy: Any, budget: Any, agent: Any, work: Any, params: Any
) -> tuple[Any, Any]:
    return _call(EXCESS, ux, uy, budget, agent, work, params)


def _gradient(
    _: Any, at: Any, ux: Any, uy: Any, agent: Any, work: Any, params: Any, out: Any
) -> tuple[Any, Any]:
    return _call(GRADIENT, ux, uy, agent, work, params, out)


def _optimum(_: Any, at: Any, agent: Any, work: Any, params: Any, out: Any) -> tuple[Any, Any]:
    return _call(OPTIMUM, agent, work, params, out)


def _lower_bound(
    _: Any, at: Any, count: Any, ux: Any, uy: Any, agent: Any, work: Any, params: Any, out: Any
) -> tuple[Any, Any]:
    return _call(LOWER_BOUND, count, ux, uy, agent, work, params, out)


call_base: Any = intrinsic(_base)
call_prepare: Any = intrinsic(_prepare)
call_excess: Any = intrinsic(_excess)
call_gradient: Any = intrinsic(_gradient)
call_optimum: Any = intrinsic(_optimum)
call_lower_bound: Any = intrinsic(_lower_bound)
