"""``crowdbot judge-log``: check the log of a judge."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.shared.option import argument, option
from crowdbot.cli.shared.run_arguments import AsJson
from crowdbot.core.support.text import plural


def judge_log(
    log: Annotated[Path, argument("FILE", "Log, or folder of a judge.")],
    key: Annotated[
        list[str] | None, option("HEX", "Public key of the organiser; default: your own.")
    ] = None,
    known: Annotated[
        str | None, option("SHA256", "Hash of a line that was published before.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Check that no line of a judge's log was changed, removed or inserted, and list it.

    Example: crowdbot judge-log judged --key 3d40...c7 --known 9f86...08
    """
    from crowdbot.core.bundle.judge_log import LOG, read_log
    from crowdbot.core.bundle.signature import check_public_key, own_public_key, signer_of
    from crowdbot.errors import InputError

    path = log / LOG if log.is_dir() else log
    if not path.is_file():
        raise InputError(f"{path}: no such log")
    trusted = {check_public_key(text) for text in key or ()} or {own_public_key()} - {""}
    lines = read_log(path, trusted)
    if known is not None and known.lower() not in (line.sha256 for line in lines):
        raise InputError(f"{path}: no line has the hash {known[:80]}; it is another log")
    if as_json:
        say_json([{**x.document, "sha256": x.sha256} for x in lines])
        return
    for line in lines:
        about = " ".join(str(line.document.get(k, ""))[:80] for k in ("submission", "team"))
        say(f"{line.document['time']} {line.event} {about}".rstrip())
    last = lines[-1].sha256 if lines else "none"
    say(f"{plural(len(lines), 'line')}, all signed and in order; the last has {last}")
    for signer in dict.fromkeys(signer_of(line.document) for line in lines):
        say(f"signed with the public key {signer}")
