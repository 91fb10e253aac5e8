// The second view of the replay: from above | 3-D | as a person sees it | as the robot's camera sees it.

const VIEWS = ["plan", "solid", "person", "camera"];
const NO_WEBGL = "This browser has no WebGL, so the view from above is shown.";

/** Chooses the view; three.js is unpacked when the first one in three dimensions is asked for. */
async function chooseView(name) {
  const wanted = VIEWS.includes(name) && solidOffered() ? name : "plan";
  if (wanted !== "plan" && !hasWebGL()) {
    say(NO_WEBGL);
    byId("view").value = state.view = "plan";
    return;
  }
  state.view = byId("view").value = wanted;
  document.body.dataset.view = wanted;
  keepAddress();
  if (wanted !== "plan") {
    await loadThree();
    shown.panels.forEach(preparePanel);
  }
  ask();
}

/** Runs of pages that were made before have no heights. */
const solidOffered = () => shown.runs.every((run) => run.solids);

function offerViews() {
  byId("view").parentElement.hidden = !solidOffered();
  const camera = byId("view").querySelector("[value=camera]");
  camera.hidden = camera.disabled = !shown.hasRobot;
  const person = byId("view").querySelector("[value=person]");
  person.hidden = person.disabled = !shown.runs.some((run) => run.people?.count);
}

function preparePanel(panel) {
  if (panel.solid || !panel.run.solids) return;
  const canvas = el("canvas", { class: "solid", tabindex: 0, role: "img",
    "aria-label": `${panel.run.label} in three dimensions. Drag to look around, scroll or pinch to come nearer.` });
  panel.view.canvas.after(canvas);
  panel.solid = makeSolid(canvas, panel.run, shown.bounds);
  panel.around = { ...BEHIND };
  panel.gaze = { yaw: 0, pitch: 0 };
  pointers(canvas, {
    drag: (dx, dy) => lookAround(panel, dx, dy),
    pinch: (factor) => {
      panel.around.far = clamp(panel.around.far * factor, 2, 60);
      ask();
    },
  });
  canvas.addEventListener("keydown", (event) => {
    const [dx, dy] = { ArrowLeft: [-20, 0], ArrowRight: [20, 0], ArrowUp: [0, -20], ArrowDown: [0, 20] }[event.key] ?? [];
    if (dx === undefined || event.ctrlKey) return;
    event.preventDefault();
    event.stopPropagation();
    lookAround(panel, dx, dy);
  });
}

function lookAround({ around, gaze }, dx, dy) {
  if (state.view === "solid") {
    around.yaw -= 0.008 * dx;
    around.pitch = clamp(around.pitch + 0.006 * dy, 0.05, 1.5);
  } else {
    gaze.yaw += 0.005 * dx;
    gaze.pitch = clamp(gaze.pitch + 0.004 * dy, -1, 1);
  }
  ask();
}

/** The person through whose eyes is looked: the followed one, or the nearest to the robot. */
function lookingPerson(run, frame) {
  const followed = followedIn(run, frame);
  if (followed?.person >= 0) return placeOf(frame.people, followed.person);
  const from = frame.robots[followed?.robot ?? 0] ?? state.middle;
  let [best, least] = [-1, Infinity];
  for (let i = 0; i < frame.people.size; i++) {
    const away = Math.hypot(frame.people.x[i] - from.x, frame.people.y[i] - from.y);
    if (away < least) [best, least] = [i, away];
  }
  return best;
}

/** The eye of a panel, and what it does not see. */
function panelEye({ run, view, solid, around, gaze }, frame) {
  const robot = followedIn(run, frame)?.robot ?? 0;
  const options = { low: false, points: state.lidar, cones: state.sonar, thoughts: state.thoughts };
  if (state.view === "camera" && Number.isFinite(frame.robots[robot]?.x)) {
    const eye = eyeOfRobot(frame.robots[robot], run.solids.robots[robot], reachOf(run.robots[robot]), gaze);
    return [eye, { ...options, hiddenRobot: robot }];
  }
  const i = state.view === "person" ? lookingPerson(run, frame) : -1;
  if (i >= 0) {
    const { x, y, heading, person } = frame.people;
    const facing = Number.isNaN(heading[i]) ? solid.parts.people.facing[person[i]] : heading[i];
    const eye = eyeOfPerson(x[i], y[i], facing, solid.parts.people.height(person[i]), gaze);
    return [eye, { ...options, hiddenPerson: person[i] }];
  }
  return [eyeAround(view, around), { ...options, low: true }];
}

/** Draws a panel in three dimensions; returns false if it is shown from above. */
function paintPanelSolid(panel, frame) {
  if (state.view === "plan" || !panel.solid) return false;
  drawSolid(panel.solid, frame, ...panelEye(panel, frame));
  return true;
}

function paintSolids() {
  for (const { solid } of shown.panels) if (solid) paintSolid(solid);
}

function bindViews() {
  byId("view").onchange = ({ target }) => chooseView(target.value).catch(({ message }) => say(message));
  const first = () => shown.panels[0];
  const eye = () => panelEye(first(), frameAt(first().run, state.time))[0];
  offerHeadset(byId("headset"), () => first().solid, eye, render).catch(() => {});
}
