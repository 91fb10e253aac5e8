"""Draw the pictures of docs/howto/streams_of_people.md with ``crowdbot view``.

Usage: python scripts/stream_pictures.py
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FILES = ROOT / "docs" / "howto" / "files"
IMAGES = ROOT / "docs" / "images"


def main() -> None:
    """One picture for each scenario whose file begins with ``streams_``."""
    for file in sorted(FILES.glob("streams_*.yaml")):
        if file.stem == "streams_base":
            continue
        out = IMAGES / f"{file.stem}.svg"
        command = [sys.executable, "-m", "crowdbot", "view", str(file), "--out", str(out)]
        subprocess.run(command, check=True)
    encounter = ("social-guidelines", "blind_corner", "--out", str(IMAGES / "blind_corner.svg"))
    subprocess.run([sys.executable, "-m", "crowdbot", "view", *encounter], check=True)


if __name__ == "__main__":
    main()
