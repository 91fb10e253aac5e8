"""Commands of challenges: locks, draws, bundles, judging, leaderboards."""
