"""Policies in ONNX files, run by onnxruntime (extra ``onnx``)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.learning.conventions import KEY, Conventions, read_conventions
from crowdbot.core.planning.policies.policy_planner import Policy
from crowdbot.core.registry.registry import Registry
from crowdbot.errors import InputError, MissingLibraryError


def load_onnx(path: Path, registry: Registry) -> tuple[Policy, Conventions]:
    """Return the policy of a file, which runs on one thread, and its conventions.

    Raises:
        MissingLibraryError: onnxruntime is not installed.
        InputError: it is not an ONNX file, or its shapes are not those of its conventions.
    """
    session = _session(path)
    metadata = session.get_modelmeta().custom_metadata_map
    conventions = read_conventions(metadata.get(KEY), str(path), registry)
    (given, *others), (found, *_) = session.get_inputs(), session.get_outputs()
    if others:
        names = ", ".join(i.name for i in session.get_inputs())
        raise InputError(f"{path}: a policy has one input, not {names}")
    _check_shape(path, "input", given.shape, conventions.size)
    _check_shape(path, "output", found.shape, len(conventions.action))

    def act(observation: NDArray[np.float32]) -> NDArray[np.float32]:
        return np.asarray(session.run([found.name], {given.name: observation})[0], np.float32)

    return act, conventions


def _session(path: Path) -> Any:
    try:
        import onnxruntime
    except ImportError as error:
        raise MissingLibraryError(
            f"{path}: onnxruntime is not installed; install it with: pip install 'crowdbot[onnx]'"
        ) from error
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = options.inter_op_num_threads = 1
    options.log_severity_level = 4
    try:
        return onnxruntime.InferenceSession(str(path), options, providers=["CPUExecutionProvider"])
    except Exception as error:
        raise InputError(f"{path}: onnxruntime cannot load it: {error}") from None


def _check_shape(path: Path, tensor: str, shape: Any, size: int) -> None:
    """Check that a tensor is (any number, size)."""
    any_number = len(shape) == 2 and (isinstance(shape[0], str) or shape[0] in (1, None))
    if not any_number or shape[1] != size:
        given = ", ".join("any" if isinstance(n, str) or n is None else str(n) for n in shape)
        raise InputError(f"{path}: its {tensor} has shape ({given}), not (any, {size})")
