"""Write what a release consists of as a CycloneDX document: packages, versions, licences, sums.

Packages are those that are installed and that crowdbot needs; their files' SHA-256 come from
requirements.lock. A release has this file beside its wheel.

Examples:
    .venv/bin/python scripts/write_sbom.py build/crowdbot.cdx.json
"""

from __future__ import annotations

import json
import re
import sys
from hashlib import sha256
from importlib import metadata
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))  # as a script, too

from crowdbot.core.support.dependencies import Dependency, dependencies  # noqa: E402

_PINNED = re.compile(r"^([A-Za-z0-9._-]+)==(\S+)(.*?)(?=^[A-Za-z0-9]|\Z)", re.MULTILINE | re.DOTALL)
_SUM = re.compile(r"--hash=sha256:([0-9a-f]{64})")


def sums() -> dict[tuple[str, str], list[str]]:
    """Return (name, version) -> the SHA-256 of its files, from the lock."""
    text = (ROOT / "requirements.lock").read_text(encoding="utf-8")
    return {(m[1].lower(), m[2]): _SUM.findall(m[3]) for m in _PINNED.finditer(text)}


def document() -> dict[str, Any]:
    """Return the document."""
    version, known = metadata.version("crowdbot"), sums()
    found = dependencies()
    own = {
        "type": "application",
        "name": "crowdbot",
        "version": version,
        "bom-ref": f"pkg:pypi/crowdbot@{version}",
        "licenses": [{"expression": "BSD-3-Clause"}],
    }
    refs = {d.name: f"pkg:pypi/{d.name}@{d.version}" for d in found}
    return {
        "bomFormat": "CycloneDX",
        "specVersion": "1.6",
        "version": 1,
        "metadata": {"component": own},
        "components": [
            *(_component(d, known.get((d.name, d.version), [])) for d in found),
            three(),
        ],
        "dependencies": [
            {"ref": refs[d.name], "dependsOn": [refs[n] for n in d.needs if n in refs]}
            for d in found
        ],
    }


def three() -> dict[str, Any]:
    """Return three.js, which stands in the package itself."""
    pins = json.loads((ROOT / "scripts/js/package.json").read_text(encoding="utf-8"))
    version = pins["devDependencies"]["three"]
    file = ROOT / "crowdbot/core/replay/three.min.js"
    ref = f"pkg:npm/three@{version}"
    return {
        "type": "library", "name": "three", "version": version, "bom-ref": ref, "purl": ref,
        "scope": "required", "licenses": [{"license": {"id": "MIT"}}],
        "hashes": [{"alg": "SHA-256", "content": sha256(file.read_bytes()).hexdigest()}],
    }  # fmt: skip


def _component(one: Dependency, files: list[str]) -> dict[str, Any]:
    ref = f"pkg:pypi/{one.name}@{one.version}"
    licences = {"licenses": [{"license": {"name": one.licence}}]} if one.licence else {}
    references = [
        {"type": "distribution", "url": ref, "hashes": [{"alg": "SHA-256", "content": content}]}
        for content in files
    ]  # fmt: skip
    return {
        "type": "library", "name": one.name, "version": one.version, "bom-ref": ref, "purl": ref,
        "scope": "optional" if one.extra else "required", **licences,
        **({"externalReferences": references} if references else {}),
    }  # fmt: skip


def main() -> None:
    """Write the document to the file that is named."""
    target = Path(sys.argv[1])
    target.parent.mkdir(parents=True, exist_ok=True)
    text = json.dumps(document(), indent=1) + "\n"
    target.write_text(text, encoding="utf-8")
    print(f"{target}: {len(dependencies())} packages")


if __name__ == "__main__":
    main()
