"""Writes a fully connected policy as an ONNX file, without further libraries.

The format is Protocol Buffers, version 3; numbers of fields are those of ``onnx.proto`` (ONNX,
Apache-2.0), operator set 17.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from crowdbot.core.types.arrays import Array

_IR_VERSION, _OPERATORS, _FLOAT = 9, 17, 1


def onnx_bytes(layers: Sequence[tuple[Array, Array]], metadata: Mapping[str, str]) -> bytes:
    """Return the file of a network: tanh after each layer but the last.

    Args:
        layers: weight (inputs, outputs) and bias (outputs,) of each.
        metadata: texts by name.
    """
    nodes, constants, before = [], [], "observation"
    for k, (weight, bias) in enumerate(layers):
        last = k == len(layers) - 1
        constants += [_tensor(f"w{k}", weight), _tensor(f"b{k}", bias)]
        after = "action" if last else f"h{k}"
        nodes.append(_node("MatMul", [before, f"w{k}"], f"m{k}"))
        nodes.append(_node("Add", [f"m{k}", f"b{k}"], after if last else f"s{k}"))
        if not last:
            nodes.append(_node("Tanh", [f"s{k}"], after))
        before = after
    graph = b"".join(
        [
            *(_part(1, node) for node in nodes),
            _text(2, "policy"),
            *(_part(5, constant) for constant in constants),
            _part(11, _value("observation", layers[0][0].shape[0])),
            _part(12, _value("action", layers[-1][0].shape[1])),
        ]
    )
    entries = [_part(14, _text(1, key) + _text(2, value)) for key, value in metadata.items()]
    version = _part(8, _text(1, "") + _number(2, _OPERATORS))
    return b"".join([_number(1, _IR_VERSION), _part(7, graph), version, *entries])


def _varint(value: int) -> bytes:
    found = bytearray()
    while value > 0x7F:
        found.append(value & 0x7F | 0x80)
        value >>= 7
    return bytes([*found, value])


def _number(field: int, value: int) -> bytes:
    return _varint(field << 3) + _varint(value)


def _part(field: int, content: bytes) -> bytes:
    return _varint(field << 3 | 2) + _varint(len(content)) + content


def _text(field: int, text: str) -> bytes:
    return _part(field, text.encode())


def _node(operator: str, inputs: Sequence[str], output: str) -> bytes:
    given = b"".join(_text(1, name) for name in inputs)
    return given + _text(2, output) + _text(3, output) + _text(4, operator)


def _tensor(name: str, values: Array) -> bytes:
    sizes = b"".join(_number(1, size) for size in values.shape)
    raw = np.ascontiguousarray(values, "<f4").tobytes()
    return sizes + _number(2, _FLOAT) + _text(8, name) + _part(9, raw)


def _value(name: str, size: int) -> bytes:
    """Return a tensor of floats (worlds, size)."""
    shape = _part(1, _text(2, "worlds")) + _part(1, _number(1, size))
    return _text(1, name) + _part(2, _part(1, _number(1, _FLOAT) + _part(2, shape)))
