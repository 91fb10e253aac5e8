"""Fully connected policies that Stable-Baselines3 has saved, such as an ``MlpPolicy``.

Their weights are read without executing code of the file, so other networks are refused.
"""

from __future__ import annotations

import io
import json
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.learning.conventions import KEY, Conventions, read_conventions
from crowdbot.core.planning.policies.policy_planner import Policy
from crowdbot.core.registry.registry import Registry
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError, MissingLibraryError

_HIDDEN, _LAST = "mlp_extractor.policy_net.", "action_net"
_MOST_BYTES = 1 << 30


def load_sb3(path: Path, registry: Registry) -> tuple[Policy, Conventions]:
    """Return the policy of a file, and its conventions.

    Raises:
        MissingLibraryError: torch is not installed.
        InputError: it is not such a file, or it holds another network.
    """
    data, weights = _read(path)
    conventions = read_conventions(data.get(KEY), str(path), registry)
    layers = _layers(path, weights)
    if _other_activation(data):
        raise InputError(f"{path}: activations other than Tanh are not read; export it to ONNX")
    sizes = layers[0][0].shape[1], layers[-1][0].shape[0]
    if sizes != (conventions.size, len(conventions.action)):
        raise InputError(
            f"{path}: its network has {sizes[0]} inputs and {sizes[1]} outputs, not "
            f"{conventions.size} and {len(conventions.action)}"
        )

    def act(observation: NDArray[np.float32]) -> NDArray[np.float32]:
        found = observation
        for weight, bias in layers[:-1]:
            found = np.tanh(found @ weight.T + bias)
        weight, bias = layers[-1]
        return np.asarray(found @ weight.T + bias, np.float32)

    return act, conventions


def _read(path: Path) -> tuple[dict[str, Any], dict[str, Array]]:
    """Return the plain values and the weights of a file."""
    try:
        import torch
    except ImportError as error:
        raise MissingLibraryError(f"{path}: its weights need torch; pip install torch") from error
    try:
        with zipfile.ZipFile(path) as file:
            if sum(entry.file_size for entry in file.infolist()) > _MOST_BYTES:
                raise InputError(f"{path}: larger than 1 GiB")
            data = json.loads(file.read("data"))
            state = torch.load(io.BytesIO(file.read("policy.pth")), "cpu", weights_only=True)
    except InputError:
        raise
    except Exception as error:
        raise InputError(f"{path}: not a policy of Stable-Baselines3: {error}") from None
    return data, {name: value.numpy() for name, value in state.items()}


def _layers(path: Path, weights: dict[str, Array]) -> list[tuple[Array, Array]]:
    """Return weight and bias of each layer, the first one first.

    Raises:
        InputError: the network is not fully connected.
    """
    hidden = sorted(
        {n.removeprefix(_HIDDEN).split(".")[0] for n in weights if n.startswith(_HIDDEN)}, key=int
    )
    names = [*(f"{_HIDDEN}{n}" for n in hidden), _LAST]
    try:
        return [(weights[f"{n}.weight"], weights[f"{n}.bias"]) for n in names]
    except KeyError as error:
        raise InputError(
            f"{path}: has no {error}: only fully connected policies of PPO and A2C (MlpPolicy) are "
            "read; export it to ONNX"
        ) from None


def _other_activation(data: dict[str, Any]) -> bool:
    """True if the policy was made with another activation than the usual one, Tanh."""
    given = data.get("policy_kwargs") or {}
    return "activation_fn" in str(given) and "Tanh" not in str(given)
