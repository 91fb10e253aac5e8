#!/usr/bin/env bash
# Simulates one second with numba's own compiler and with compile_parts: the trajectories must be
# equal. Without sensors, which goal_seek does not read: what they compile has the same decorators,
# and takes a quarter of the 54 s of processor time that the first needs where nothing is compiled.
set -euo pipefail
cd "$(dirname "$0")/.."
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

trajectory() {
	.venv/bin/crowdbot simulate challenge-2020 counter-d0250-dispersed-c20-r05 --planner goal_seek \
		--set robots.robot.task.time_limit=1 --set 'robots.robot.sensors={}' --no-references \
		--quiet --out "$out/$1"
	grep -h '"trajectory"' "$out/$1"/*/*/*/*/run.json
}

plain=$(CROWDBOT_PLAIN_NUMBA=1 trajectory plain)
parts=$(CROWDBOT_PLAIN_NUMBA=0 trajectory parts)
[ "$plain" = "$parts" ] || { echo "plain numba and compile_parts differ: $plain, $parts"; exit 1; }
echo "plain numba: the trajectory of compile_parts"
