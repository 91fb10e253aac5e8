#!/usr/bin/env bash
# Run `make demo` in a fresh clone for each Python that README names and this machine has.
# Usage: scripts/demo_on_each_python.sh [VERSION...]
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
versions=("$@")
[ $# -gt 0 ] || versions=(3.11 3.12 3.13)

find_python() {  # prints a working interpreter of version $1; pyenv's are found even if not active
    local candidate
    for candidate in "python$1" "${PYENV_ROOT:-$HOME/.pyenv}"/versions/"$1".*/bin/python; do
        if "$candidate" -c "import ensurepip" 2>/dev/null; then
            echo "$candidate"
            return
        fi
    done
}

for version in "${versions[@]}"; do
    python=$(find_python "$version")
    if [ -z "$python" ]; then
        echo "demo on Python $version: skipped, this machine has none"
        continue
    fi
    clone=$(mktemp -d)
    trap 'rm -rf "$clone"' EXIT
    git clone --quiet "$root" "$clone/crowdbot"
    if ! make -C "$clone/crowdbot" --no-print-directory demo PYTHON="$python" >"$clone/log" 2>&1; then
        cat "$clone/log"
        echo "demo on Python $version: failed"
        exit 1
    fi
    echo "demo on Python $version: ok"
    rm -rf "$clone"
done
