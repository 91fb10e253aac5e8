#!/usr/bin/env bash
# Run `make demo`, `crowdbot doctor` and a small campaign on each Python that README names and this
# machine has. The Python of .venv runs in this checkout, each other one in a copy of it with the
# packages of the lock, all side by side. Copies are kept in .venv/pythons, with their packages and
# compiled functions: a first time takes two minutes of processor time for each.
# Usage: scripts/demo_on_each_python.sh [VERSION...]
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
versions=("$@")
[ $# -gt 0 ] || versions=(3.11 3.12 3.13 3.14)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

find_python() {  # prints a working interpreter of version $1; pyenv's are found even if not active
    local candidate
    for candidate in "python$1" "${PYENV_ROOT:-$HOME/.pyenv}"/versions/"$1".*/bin/python; do
        if "$candidate" -c "import ensurepip" 2>/dev/null; then
            echo "$candidate"
            return
        fi
    done
}

version_here() {  # prints the version of this checkout's .venv, if it is set up
    "$root/.venv/bin/python" -c 'import sys; print("{}.{}".format(*sys.version_info))' 2>/dev/null || true
}

renewed_copy() {  # of this checkout into folder $1; packages and compiled functions stay there
    mkdir -p "$1/crowdbot"
    find "$1" -mindepth 1 -maxdepth 1 ! -name .venv ! -name crowdbot -exec rm -rf {} +
    find "$1/crowdbot" -type f ! -path '*/__pycache__/*' -delete
    "$1/.venv/bin/python" -c pass 2>/dev/null || rm -rf "$1/.venv"  # of a Python that is gone
    if [ -z "$(git -C "$root" status --porcelain 2>&1)" ]; then
        git -C "$root" ls-files -z | tar -C "$root" --null -T - -cf -
    else
        tar -C "$root" --exclude=./.git --exclude=./.venv --exclude=./runs --exclude='./.*_cache' \
            --exclude=__pycache__ --exclude=node_modules -cf - .
    fi | tar -C "$1" -xf -
}

three_commands() {  # in checkout $1, with the interpreter $2
    local out
    # Byte code of what is imported is written on the way; that of all packages takes longer.
    make -C "$1" --no-print-directory demo PYTHON="$2" BYTE_CODE=true
    out=$(mktemp -d -p "$work")
    "$1/.venv/bin/crowdbot" doctor --out "$out"
    "$1/.venv/bin/crowdbot" campaign challenge-2020 --only 'in-d0125-slow-c01-r02*' \
        --planner goal_seek --set robots.robot.task.time_limit=2 --no-floors --jobs 1 --out "$out"
}

run_on() {  # version $1, interpreter $2; prints one line, and all that was printed if it fails
    local checkout=$root log="$work/$1.log" begin=$SECONDS
    if [ "$1" != "$(version_here)" ]; then
        checkout="$root/.venv/pythons/$1"
        renewed_copy "$checkout"
    fi
    if ! three_commands "$checkout" "$2" >"$log" 2>&1; then
        cat "$log"
        echo "demo, doctor and campaign on Python $1: failed"
        return 1
    fi
    echo "demo, doctor and campaign on Python $1: ok, $((SECONDS - begin)) s"
}

jobs=()
for version in "${versions[@]}"; do
    python=$(find_python "$version")
    if [ -z "$python" ]; then
        echo "demo, doctor and campaign on Python $version: skipped, this machine has none"
        continue
    fi
    run_on "$version" "$python" &
    jobs+=($!)
done
failed=0
for job in "${jobs[@]}"; do
    wait "$job" || failed=1
done
exit $failed
