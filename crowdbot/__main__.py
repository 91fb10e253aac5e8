"""``python -m crowdbot``."""

from crowdbot.cli import main

if __name__ == "__main__":
    raise SystemExit(main())
