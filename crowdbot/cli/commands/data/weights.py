"""``crowdbot weights``: show the weights of a learned planner, or convert them to ``.npz``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.shared.option import argument, option, switch


def weights(
    file: Annotated[Path, argument("FILE", "PyTorch's .pth of a state_dict, or .npz.")],
    out: Annotated[Path | None, option("FILE", "File to write, .npz; default: none.")] = None,
    as_json: Annotated[bool, switch("--json", "Names and shapes as JSON.")] = False,
) -> None:
    """List or convert a network's weights without PyTorch; no code in the file is run.

    Example: crowdbot weights rl_model.pth --out sarl.npz
    """
    from crowdbot.cli.shared.options import check_ending
    from crowdbot.core.planning.weights.weights_file import npz_bytes, read_weights
    from crowdbot.core.support.atomic_write import atomic_write
    from crowdbot.core.support.source_digest import file_digest

    check_ending(out, ".npz")
    found = read_weights(file)
    if out is not None:
        atomic_write(out, npz_bytes(found))
    read = {"file": str(file), "sha256": file_digest(file)}
    written = {} if out is None else {"out": str(out), "out_sha256": file_digest(out)}
    shapes = {name: list(values.shape) for name, values in found.items()}
    if as_json:
        say_json({**read, **written, "weights": shapes})
        return
    for name, shape in shapes.items():
        say(f"{name}  {' x '.join(map(str, shape)) or 'one number'}")
    count = sum(values.size for values in found.values())
    say(f"{file}: {len(found)} tables, {count} numbers, sha256 {read['sha256']}")
    if out is not None:
        say(f"{out}: sha256 {written['out_sha256']}")
