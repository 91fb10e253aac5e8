// Legend: lists what is drawn; without layers that are off or that no run has.

function legendEntries() {
  const any = (test) => shown.runs.some(test);
  const several = shown.runs.length > 1;
  const kinds = WALLS.filter(({ whom }) => any((run) => run.walls.some((wall) => wall[4] === whom)));
  const entries = [
    [any((run) => run.robots.length), several ? "" : "robot", "robot"],
    [any((run) => run.robots.length), several ? "" : "trail", "its path"],
    ...(several ? shown.runs.map((run) => [true, `run run-${run.index % RUN_COLOURS}`, run.label]) : []),
    [several && state.ghost, "ghost", "other run, where it differs"],
    [any((run) => run.people?.count), "ramp", `people, 0–${digits(shown.topSpeed)} m/s`],
    [state.trails && any((run) => run.people?.count), "way", `where people were ${TRAIL} s before`],
    [chosenPerson() !== null || state.follow.startsWith("robot"), "chosen", "followed"],
    [state.lidar && any((run) => run.scans.length), "lidar", "lidar"],
    [state.sonar && any((run) => run.cones.length), "sonar", "ultrasound, infrared"],
    [state.thoughts && any((run) => run.drawings.length), "thought", "what the planner thinks"],
    [any((run) => run.contacts.length), "contact", "contact"],
    [any((run) => run.zone.length || run.robots.some(({ goal }) => goal)), "goal", "goal"],
    [any((run) => run.robots.some(({ wanted }) => wanted.length)), "wanted", "person of the robot's task"],
    ...kinds.map(({ whom, text }) => [true, `wall wall-${whom}`, text]),
    [any((run) => run.blocks.length), "block", "block"],
    [any((run) => run.steps.length), "block step", "block that people step over"],
    [any((run) => run.pillars.length), "pillar", "pillar"],
  ];
  return entries.filter(([seen, mark]) => seen && mark).map(([, mark, text]) => [mark, text]);
}

function writeLegend() {
  const entries = legendEntries();
  const list = byId("legend");
  const content = JSON.stringify(entries);
  if (list.dataset.content === content) return;
  list.dataset.content = content;
  list.replaceChildren(...entries.map(([mark, text]) =>
    el("li", {}, el("i", { class: mark.split(" ").map((m) => `k-${m}`).join(" ") }), text)));
}
