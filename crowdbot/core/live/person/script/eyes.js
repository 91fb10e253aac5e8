// The picture in three dimensions: from behind, through the eyes of the person, or as the robot's camera sees.

const REST = 30; // ms; a little less than two frames of a screen
const EYE_VIEWS = ["plan", "solid", "eyes", "camera"];
const eyes = { view: "plan", solid: null, around: { ...BEHIND, far: 6, pitch: 0.45 }, look: { yaw: 0, pitch: 0 }, failed: false };

/** Chooses the picture; where the browser has no WebGL, the plan stays and the page says so. */
async function chooseEyes(name) {
  const wanted = EYE_VIEWS.includes(name) ? name : "plan";
  eyes.failed = wanted !== "plan" && !hasWebGL();
  eyes.view = byId("view").value = eyes.failed ? "plan" : wanted;
  byId("no-webgl").hidden = !eyes.failed;
  byId("solid").hidden = eyes.view === "plan";
  byId("plan").style.visibility = eyes.view === "plan" ? "" : "hidden";
  if (eyes.view !== "plan") await loadThree();
}

/** Prepares the picture of a run whose scene is known. */
function prepareEyes() {
  if (eyes.solid?.run === shown.run) return;
  eyes.solid?.renderer.dispose();
  eyes.solid = makeSolid(byId("solid"), shown.run, sceneBounds(shown.run));
}

function sceneBounds({ walls, robots, solids }) {
  const points = [
    ...walls.flatMap(([x0, y0, x1, y1]) => [[x0, y0], [x1, y1]]),
    ...solids.blocks.flatMap(([outline]) => outline),
    ...robots.flatMap((robot) => [robot.goal, robot.start]),
  ];
  if (!points.length) points.push([-10, -10], [10, 10]);
  const all = (i) => points.map((p) => p[i]);
  return { x0: Math.min(...all(0)), x1: Math.max(...all(0)), y0: Math.min(...all(1)), y1: Math.max(...all(1)) };
}

/** Returns true if it is time for the next picture: without a graphics card, 30 a second leave time to drive. */
function pictureDue(now) {
  const { ratio, before, renderer } = eyes.solid;
  return ratio === 1 || renderer.xr.isPresenting || now - before > REST;
}

/** Draws the picture; returns false where the plan is to be drawn. */
function drawEyes(frame) {
  if (eyes.view === "plan" || !globalThis.THREE) return false;
  prepareEyes();
  if (!pictureDue(performance.now())) return true;
  const own = ownBody(frame);
  if (!own || !Number.isFinite(own.x)) return false;
  const walks = shown.walker >= 0;
  const { solids } = shown.run;
  if (eyes.view === "eyes" || (eyes.view === "camera" && walks)) {
    const height = walks ? eyes.solid.parts.people.height(shown.walker) : 1.3;
    drawSolid(eyes.solid, frame, eyeOfPerson(own.x, own.y, own.theta, height, eyes.look), {
      hiddenPerson: shown.walker, hiddenRobot: walks ? -1 : shown.driven, points: true, thoughts: true,
    });
  } else if (eyes.view === "camera") {
    const eye = eyeOfRobot(own, solids.robots[shown.driven], reachOf(shown.run.robots[shown.driven]), eyes.look);
    drawSolid(eyes.solid, frame, eye, { hiddenRobot: shown.driven, points: true, thoughts: true });
  } else {
    drawSolid(eyes.solid, frame, eyeAround(own, { ...eyes.around, yaw: own.theta + eyes.look.yaw }), { low: true, points: true, thoughts: true });
  }
  return true;
}

function bindEyes() {
  const walks = document.documentElement.dataset.mode === "walk";
  byId("view").querySelector("[value=camera]").hidden = walks;
  byId("view").querySelector("[value=eyes]").textContent = walks ? "through your eyes" : "seated";
  byId("view").onchange = ({ target }) => chooseEyes(target.value).catch(({ message }) => { byId("banner").textContent = message; });
  pointers(byId("solid"), {
    drag: (dx, dy) => {
      if (walks) hand.yaw -= 0.005 * dx;
      else eyes.look.yaw += 0.006 * dx * (eyes.view === "solid" ? -1 : 1);
      eyes.look.pitch = clamp(eyes.look.pitch + 0.004 * dy, -0.8, 0.8);
      eyes.around.pitch = clamp(eyes.around.pitch + 0.004 * dy, 0.08, 1.4);
    },
    pinch: (factor) => { eyes.around.far = clamp(eyes.around.far * factor, 2, 40); },
  });
  const eyeNow = () => {
    const own = ownBody(frameNow(performance.now())) ?? { x: 0, y: 0, theta: 0 };
    return { x: own.x, y: own.y, yaw: own.theta };
  };
  offerHeadset(byId("headset"), () => eyes.solid, eyeNow, draw).catch(() => {});
  const address = new URLSearchParams(location.hash.slice(1)).get("view");
  return chooseEyes(address ?? (walks ? "eyes" : "solid"));
}
