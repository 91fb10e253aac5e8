"""Signatures of an organiser: Ed25519 over canonical JSON.

The private key is in a file that only its owner can read; anyone can check a signature with the
public key, which is in every signed document.
"""

from __future__ import annotations

import json
import os
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from crowdbot.dsl.text.bounded_files import read_bytes
from crowdbot.errors import InputError, MissingLibraryError

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

#: Environment variable with the path of the key, and the field of a signed document.
KEY, FIELD = "CROWDBOT_KEY", "signature"
_BYTES = 32


def key_path() -> Path:
    """Return the path of the user's private key, which need not exist."""
    if given := os.environ.get(KEY):
        return Path(given)
    base = os.environ.get("XDG_CONFIG_HOME") or Path.home() / ".config"
    return Path(base) / "crowdbot" / "organiser.key"


def sign(document: Mapping[str, Any]) -> dict[str, Any]:
    """Return a document with the user's signature; the key is made if there is none.

    Raises:
        InputError: the key cannot be read or written.
        MissingLibraryError: the extra ``signing`` is not installed.
    """
    key = _own_key(create=True)
    assert key is not None
    plain = {k: v for k, v in document.items() if k != FIELD}
    value = key.sign(_canonical(plain)).hex()
    return {**plain, FIELD: {"key": _public(key), "value": value}}


def own_public_key() -> str:
    """Return the user's public key in hexadecimal digits; empty if there is no key.

    Raises:
        InputError: the key cannot be read.
    """
    key = _own_key(create=False)
    return "" if key is None else _public(key)


def signer_of(document: Mapping[str, Any]) -> str:
    """Return the public key that a signed document names."""
    return str(document[FIELD]["key"])


def signature_problem(document: Mapping[str, Any], trusted: Collection[str]) -> str:
    """Return why a signature is invalid; empty if a trusted key signed exactly this content.

    Args:
        document: from `sign`.
        trusted: public keys.

    Raises:
        MissingLibraryError: the extra ``signing`` is not installed.
    """
    found = document.get(FIELD)
    if not isinstance(found, Mapping):
        return "it is not signed"
    key, value = found.get("key"), found.get("value")
    if not isinstance(key, str) or not isinstance(value, str):
        return "its signature is malformed"
    if key not in trusted:
        return f"it is signed with the key {key[:16]!a}…, which is not trusted here; see --key"
    return "" if _fits(document, key, value) else "it was changed after it was signed"


def check_public_key(text: str) -> str:
    """Return a public key in lower case.

    Raises:
        InputError: it is not 64 hexadecimal digits.
    """
    key = text.strip().lower()
    if len(key) != 2 * _BYTES or any(c not in "0123456789abcdef" for c in key):
        raise InputError(f"--key {text[:80]}: a public key has {2 * _BYTES} hexadecimal digits")
    return key


def _fits(document: Mapping[str, Any], key: str, value: str) -> bool:
    _needs_library()
    from cryptography.exceptions import InvalidSignature
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PublicKey

    plain = {k: v for k, v in document.items() if k != FIELD}
    try:
        Ed25519PublicKey.from_public_bytes(bytes.fromhex(key)).verify(
            bytes.fromhex(value), _canonical(plain)
        )
    except (InvalidSignature, ValueError):
        return False
    return True


def _canonical(document: Mapping[str, Any]) -> bytes:
    text = json.dumps(document, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return text.encode("ascii")


def _own_key(*, create: bool) -> Ed25519PrivateKey | None:
    path = key_path()
    if not path.exists() and not create:
        return None
    _needs_library()
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

    try:
        if not path.exists():
            _write_key(path, Ed25519PrivateKey.generate().private_bytes_raw())
        return Ed25519PrivateKey.from_private_bytes(bytes.fromhex(read_bytes(path, 200).decode()))
    except OSError as error:
        raise InputError(f"{path}: {(error.strerror or str(error)).lower()}") from None
    except ValueError:
        raise InputError(f"{path}: it is not a key that crowdbot wrote") from None


def _write_key(path: Path, raw: bytes) -> None:
    path.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
    descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(descriptor, "w") as file:
        file.write(raw.hex() + "\n")


def _public(key: Ed25519PrivateKey) -> str:
    return key.public_key().public_bytes_raw().hex()


def _needs_library() -> None:
    from importlib.util import find_spec

    if find_spec("cryptography") is None:
        raise MissingLibraryError(
            "cryptography: not installed; install it with pip install 'crowdbot[signing]'"
        )
