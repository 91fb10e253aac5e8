"""Signatures: only a trusted key, only the signed content."""

from __future__ import annotations

from pathlib import Path

import pytest

from crowdbot.core.bundle.signature import (
    FIELD,
    check_public_key,
    key_path,
    own_public_key,
    sign,
    signature_problem,
)
from crowdbot.errors import InputError


@pytest.fixture(autouse=True)
def _key(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CROWDBOT_KEY", str(tmp_path / "own" / "organiser.key"))


def test_a_signed_document_is_believed_unchanged_only() -> None:
    assert own_public_key() == ""
    signed = sign({"ok": True, "runs": {"a": "identical"}})
    own = own_public_key()
    assert signature_problem(signed, {own}) == ""
    assert key_path().stat().st_mode & 0o077 == 0
    assert sign(signed) == signed  # a signature is not signed
    for changed in ({**signed, "ok": False}, {**signed, "more": 1}, {**signed, "runs": {}}):
        assert signature_problem(changed, {own}) == "it was changed after it was signed"


def test_other_keys_and_no_signature_are_not_believed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    signed = sign({"ok": True})
    own = own_public_key()
    monkeypatch.setenv("CROWDBOT_KEY", str(tmp_path / "other.key"))
    theirs = sign({"ok": True})
    assert "is not trusted here" in signature_problem(theirs, {own})
    assert "is not trusted here" in signature_problem(signed, set())
    assert signature_problem({"ok": True}, {own}) == "it is not signed"
    assert signature_problem({"ok": True, FIELD: "x"}, {own}) == "it is not signed"
    assert signature_problem({"ok": True, FIELD: {"key": 1}}, {own}) == "its signature is malformed"
    forged = {**theirs, FIELD: {**theirs[FIELD], "key": own}}
    assert signature_problem(forged, {own}) == "it was changed after it was signed"
    assert signature_problem({**signed, FIELD: {"key": own, "value": "zz"}}, {own})


def test_a_key_that_is_none_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "bad.key").write_text("not a key")
    monkeypatch.setenv("CROWDBOT_KEY", str(tmp_path / "bad.key"))
    with pytest.raises(InputError, match=r"bad.key: it is not a key"):
        sign({})
    with pytest.raises(InputError, match="64 hexadecimal digits"):
        check_public_key("abc")
    assert check_public_key("AB" * 32) == "ab" * 32
