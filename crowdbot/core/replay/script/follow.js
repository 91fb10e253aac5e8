// Body that the views follow: "robot", "robot 2", "person 17" by id, or "" for none.

const REACH = 10; // px beside a body that still count as a click on it

/** The followed person's id, or null. */
function chosenPerson() {
  const match = /^person (-?\d+)$/.exec(state.follow);
  return match ? Number(match[1]) : null;
}

/** Returns the body that a run's view follows: {place, radius, and robot or person}; null for none. */
function followedIn(run, frame) {
  const id = chosenPerson();
  if (id !== null) {
    const person = run.people ? run.people.id.indexOf(id) : -1;
    const i = person < 0 ? -1 : placeOf(frame.people, person);
    if (i < 0) return null;
    return { person, place: { x: frame.people.x[i], y: frame.people.y[i] }, radius: radiusOf(run.people, person) };
  }
  const match = /^robot(?: (\d+))?$/.exec(state.follow);
  const index = match ? Number(match[1] ?? 1) - 1 : -1;
  const pose = frame.robots[index];
  return pose && Number.isFinite(pose.x) ? { robot: index, place: pose, radius: reachOf(run.robots[index]) } : null;
}

/** Follows a body, and updates the list, the button and the address. */
function follow(whom) {
  if (!whom && state.follow) rest();
  state.follow = whom;
  byId("whom").value = whom;
  byId("follow").setAttribute("aria-pressed", String(whom.startsWith("robot")));
  keepAddress();
  ask();
}

/** Keeps the views where they are when following ends. */
function rest() {
  state.middle = { x: shown.panels[0].view.x, y: shown.panels[0].view.y };
}

/** Returns the name of the body at a point of a view; "" if there is none. */
function under(panel, px, py) {
  const { run, view } = panel;
  const frame = frameAt(run, state.time);
  const [x, y] = toWorld(view, px, py);
  const slack = REACH / view.scale;
  const robot = run.robots.findIndex((r, i) => {
    const pose = frame.robots[i];
    return fromRobot(r, pose.theta, x - pose.x, y - pose.y) < slack;
  });
  if (robot >= 0) return robot ? `robot ${robot + 1}` : "robot";
  let [best, least] = [-1, slack];
  for (let i = 0; i < frame.people.size; i++) {
    const away = Math.hypot(frame.people.x[i] - x, frame.people.y[i] - y) - radiusOf(run.people, frame.people.person[i]);
    if (away < least) [best, least] = [i, away];
  }
  return best < 0 ? "" : personName(run, frame.people.person[best]);
}

/** Returns the list's text for a body; with several robots, with the names that runs give it. */
function followText(whom) {
  const match = /^robot(?: (\d+))?$/.exec(whom);
  if (!match) return whom;
  const index = match[1] ? Number(match[1]) - 1 : 0;
  const names = new Set(shown.runs.map((run) => run.robots[index]?.name).filter(Boolean));
  return names.size ? `${whom}: ${[...names].join(", ")}` : whom;
}

/** Fills the list of bodies to follow. */
function offerFollowing() {
  const most = Math.max(...shown.runs.map((run) => run.robots.length));
  const ids = new Set(shown.runs.flatMap((run) => run.people?.id ?? []));
  const names = [
    ...Array.from({ length: most }, (_, i) => (i ? `robot ${i + 1}` : "robot")),
    ...[...ids].sort((a, b) => a - b).map((id) => `person ${id}`),
  ];
  byId("whom").replaceChildren(el("option", { value: "", text: "no one" }),
    ...names.map((name) => el("option", { value: name, text: followText(name) })));
  byId("follow").hidden = !most;
}
