"""Write the table of characters that look alike, from Unicode's confusables.txt (UTS 39).

    .venv/bin/python scripts/write_confusables.py confusables.txt

The file is published at https://www.unicode.org/Public/security/latest/confusables.txt. Each line
of the table is a character and what it looks like, in hexadecimal code points.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

TABLE = Path(__file__).parent.parent / "crowdbot" / "core" / "support" / "confusables.txt"
_LINE = re.compile(r"^([0-9A-F]+) ;\t([0-9A-F ]+?) ?;\tMA")


def main() -> None:
    """Write the table from the file that is named."""
    text = Path(sys.argv[1]).read_text(encoding="utf-8-sig")
    version = next(line for line in text.splitlines() if line.startswith("# Version:"))
    found = (_LINE.match(line) for line in text.splitlines())
    pairs = sorted((int(m[1], 16), m[2].strip()) for m in found if m)
    entries = [
        "# Characters that look alike, by UTS 39: code point, and those that it looks like.",
        f"# From Unicode's confusables.txt, {version[2:].lower()}, (c) Unicode, Inc.,",
        "# https://www.unicode.org/license.txt; written by scripts/write_confusables.py.",
    ]
    lines = [*entries, *(f"{source:04X} {target}" for source, target in pairs)]
    TABLE.write_text("\n".join(lines) + "\n", encoding="ascii")
    print(f"{TABLE}: {len(pairs)} characters")


if __name__ == "__main__":
    main()
