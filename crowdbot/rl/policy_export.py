"""Save policies as files that can be used as planners: ONNX with conventions."""

from __future__ import annotations

import io
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from crowdbot.core.learning.conventions import KEY
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError, MissingLibraryError
from crowdbot.rl.onnx_file import onnx_bytes


def conventions(env: Any) -> dict[str, Any]:
    """Return the conventions of policies of an environment, as JSON values.

    ``model.crowdbot = conventions(env)`` before ``model.save("model.zip")`` makes a model of
    Stable-Baselines3 a planner, ``sb3:model.zip``.

    Args:
        env: an environment of `crowdbot.rl`, or a wrapper around one.
    """
    return dict(_actor(env).conventions.values)


def save_onnx(policy: Any, env: Any, path: str | Path) -> None:
    """Save a policy as an ONNX file, usable as ``--planner FILE.onnx``.

    Args:
        policy: a torch module, or a model of Stable-Baselines3, from an observation (N,) to an
            action, without noise.
        env: the environment in which it was trained, whose conventions are written.
        path: the file, written atomically.

    Raises:
        MissingLibraryError: torch or onnx is not installed.
        InputError: the policy has other shapes than the environment.
    """
    try:
        import onnx
        import torch
    except ImportError as error:
        raise MissingLibraryError(
            f"save_onnx needs {error.name}; pip install torch onnx"
        ) from error
    actor = _actor(env)
    module = _Deterministic.of(policy, torch)
    example = torch.zeros((1, len(actor.low)))
    with torch.no_grad():
        try:
            found = module(example)
        except RuntimeError as error:
            raise InputError(
                f"the policy does not take observations of this environment: {error}"
            ) from None
    if tuple(found.shape) != (1, actor.size):
        raise InputError(f"the policy returns shape {tuple(found.shape)}, not (1, {actor.size})")
    buffer = io.BytesIO()
    export: Any = torch.onnx.export
    with warnings.catch_warnings():
        # torch recommends an exporter that needs a further library, and warns of checks of
        # distributions, which an action without noise does not use.
        warnings.simplefilter("ignore")
        export(
            module, (example,), buffer, input_names=["observation"], output_names=["action"],
            dynamic_axes={"observation": {0: "worlds"}, "action": {0: "worlds"}}, dynamo=False,
        )  # fmt: skip
    model = onnx.load_from_string(buffer.getvalue())
    entry = model.metadata_props.add()
    entry.key, entry.value = KEY, actor.conventions.to_json()
    atomic_write(Path(path), model.SerializeToString())


def save_layers(layers: Sequence[tuple[Array, Array]], env: Any, path: str | Path) -> None:
    """Save a fully connected policy as an ONNX file for a planner; needs no further library.

    Args:
        layers: weight (inputs, outputs) and bias (outputs,) of each, with tanh after all but the
            last one.
        env: the environment in which it was trained, whose conventions are written.
        path: the file, written atomically.

    Raises:
        InputError: the layers do not fit each other, or the environment.
    """
    actor = _actor(env)
    sizes = [len(actor.low), *(weight.shape[1] for weight, _ in layers)]
    for k, (weight, bias) in enumerate(layers):
        if weight.shape != (sizes[k], sizes[k + 1]) or bias.shape != (sizes[k + 1],):
            raise InputError(
                f"layer {k} has shapes {weight.shape} and {bias.shape}, not "
                f"{(sizes[k], sizes[k + 1])} and {(sizes[k + 1],)}"
            )
    if not layers or sizes[-1] != actor.size:
        raise InputError(f"the last layer has {actor.size} outputs, not {sizes[-1]}")
    atomic_write(Path(path), onnx_bytes(layers, {KEY: actor.conventions.to_json()}))


class _Deterministic:
    """The part of a model that returns actions without noise."""

    @staticmethod
    def of(policy: Any, torch: Any) -> Any:
        own = getattr(policy, "policy", policy)  # of a model of Stable-Baselines3
        if not hasattr(own, "_predict"):
            return own

        class Actions(torch.nn.Module):
            def __init__(self) -> None:
                super().__init__()
                self.own = own

            def forward(self, observation: Any) -> Any:
                return self.own._predict(observation, deterministic=True)

        return Actions().eval()


def _actor(env: Any) -> Any:
    """Return the robot of an environment.

    Raises:
        InputError: it is not an environment of `crowdbot.rl`.
    """
    inner = getattr(env, "worlds", getattr(env, "unwrapped", env))
    rollout = getattr(inner, "rollout", None)
    if rollout is None:
        raise InputError(f"a {type(env).__name__} is not an environment of crowdbot.rl")
    return rollout.actors[0]
