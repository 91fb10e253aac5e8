"""Layers of a trained network in single precision; compiled.

A linear algebra library would be as fast, but its sums depend on its number of threads, and runs
have to be the same in every process.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import Array, InputError, kernel

Singles = NDArray[np.float32]


class Perceptron:
    """Linear layers with a rectifier between them.

    Args:
        weights: name -> weights, ``PART.0.weight``, ``PART.0.bias``, ``PART.2.weight`` and so on.
        part: beginning of the names.
        where: the file, for messages.

    Raises:
        InputError: a layer is missing, does not fit the one before, or has no finite numbers.
    """

    def __init__(self, weights: Mapping[str, Array], part: str, where: str) -> None:
        self._layers: list[tuple[Singles, Singles]] = []
        numbers = [n.split(".")[-2] for n in weights if n.startswith(f"{part}.")]
        if not numbers or not all(n.isdecimal() for n in numbers):
            raise InputError(f"{where}: the layers of '{part}' are not numbered")
        for number in sorted({int(n) for n in numbers}):
            w, b = (weights.get(f"{part}.{number}.{tensor}") for tensor in ("weight", "bias"))
            if w is None or b is None:
                raise InputError(f"{where}: layer {number} of '{part}' lacks its weight or bias")
            before = self._layers[-1][0].shape[1] if self._layers else w.shape[-1]
            if w.ndim != 2 or b.shape != w.shape[:1] or w.shape[1] != before or 0 in w.shape:
                raise InputError(
                    f"{where}: layer {number} of '{part}' is {w.shape} with a bias {b.shape}, "
                    f"after {before} numbers"
                )
            if not (np.isfinite(w).all() and np.isfinite(b).all()):
                raise InputError(f"{where}: layer {number} of '{part}' is not finite")
            self._layers.append((np.ascontiguousarray(w.T, np.float32), b.astype(np.float32)))

    @property
    def width_in(self) -> int:
        """Return the number of its inputs."""
        return int(self._layers[0][0].shape[0])

    @property
    def width_out(self) -> int:
        """Return the number of its outputs."""
        return int(self._layers[-1][0].shape[1])

    def __call__(self, rows: Singles, *, last: bool = False) -> Singles:
        """Return the output (K, width_out) of K rows.

        Args:
            rows: (K, width_in).
            last: True if a rectifier comes after the last layer, too.
        """
        for number, (weight, bias) in enumerate(self._layers, 1):
            out = np.empty((len(rows), weight.shape[1]), dtype=np.float32)
            _layer(
                np.ascontiguousarray(rows), weight, bias, last or number < len(self._layers), out
            )
            rows = out
        return rows


@kernel
def _layer(rows: Singles, weight: Singles, bias: Singles, rectify: bool, out: Singles) -> None:
    """Write a layer's output; sums are always in the order of the inputs."""
    for k in range(rows.shape[0]):
        for j in range(out.shape[1]):
            out[k, j] = bias[j]
        for i in range(rows.shape[1]):
            value = rows[k, i]
            if value != 0.0:  # half of them, after a rectifier
                for j in range(out.shape[1]):
                    out[k, j] += value * weight[i, j]
        if rectify:
            for j in range(out.shape[1]):
                out[k, j] = max(out[k, j], np.float32(0.0))


def check_names(weights: Mapping[str, Array], parts: Sequence[str], where: str) -> None:
    """Raise an error for weights of another network.

    Raises:
        InputError: a part is missing or unknown.
    """
    there = {name.partition(".")[0] for name in weights}
    if there != set(parts):
        raise InputError(
            f"{where}: its layers are {', '.join(sorted(there))[:200]}; "
            f"those of this planner are {', '.join(sorted(parts))}"
        )


def check_widths(where: str, *expected: tuple[str, int, int]) -> None:
    """Raise an error for layers with another number of inputs.

    Args:
        where: the file.
        expected: name of a part, numbers that it takes, and those that it should take.

    Raises:
        InputError: they differ.
    """
    for part, found, width in expected:
        if found != width:
            raise InputError(
                f"{where}: '{part}' takes {found} numbers, not {width}; networks with occupancy "
                "maps or headings of people have more, and are not read"
            )
