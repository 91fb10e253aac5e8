import crowdbot

scenario = crowdbot.load("challenge-2020", "counter-d0250-dispersed-c20-r05")
run = crowdbot.simulate(scenario, planner="dwa", seed=0, out="runs")

print(run.directory, run.status, f"{run.trajectories.t[-1]:.2f} s")
for score in crowdbot.evaluate(run):
    print(score.metric, score.variant, score.value, score.unit, score.status, score.reason)
