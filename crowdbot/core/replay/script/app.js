// State of the page, and its start.

const SPAN_AT_FIRST = 12; // m across a close-up
const shown = { runs: [], panels: [], events: [], wide: { canvas: null }, hasRobot: false };
const state = {
  time: 0, playing: false, follow: "", middle: { x: 0, y: 0 }, span: SPAN_AT_FIRST, plots: new Set(), view: "plan",
  ...ON_AT_FIRST,
};

/** Prepares one more run, with a view of its own. */
function addRun(run) {
  run.index = shown.runs.length;
  const same = shown.runs.filter(({ label }) => label === run.label || label.startsWith(`${run.label} (`)).length;
  if (same) run.label = `${run.label} (${same + 1})`;
  prepare(run);
  run.series = seriesOf(run);
  run.lane = laneOf(run);
  run.events = eventsOf(run);
  shown.runs.push(run);
  shown.panels.push(makePanel(run));
}

function makePanel(run) {
  const canvas = el("canvas", { tabindex: 0, role: "img",
    "aria-label": `Close-up of ${run.label}. Click a person or robot to follow, drag to move, scroll or pinch to zoom.` });
  const readout = el("dl", { class: "readout" });
  const name = el("p", { class: "of-run name", "data-run": run.index % RUN_COLOURS, text: run.label });
  byId("closeups").append(el("div", { class: "closeup" }, canvas, el("div", { class: "caption" }, name, readout)));
  const panel = { run, readout, view: { canvas, x: 0, y: 0, scale: 1 } };
  const { view } = panel;
  pointers(canvas, {
    drag: (dx, dy) => look(view.x - dx / view.scale, view.y + dy / view.scale),
    pinch: zoom,
    click: (x, y) => {
      const whom = under(panel, x, y);
      if (whom) follow(whom);
    },
  });
  return panel;
}

/** Adapts the page to the runs shown. */
function arrange() {
  const { runs } = shown;
  shown.first = Math.min(...runs.map((run) => run.t[0]));
  shown.last = Math.max(...runs.map((run) => run.t[run.n - 1]));
  shown.bounds = boundsOf(runs);
  shown.topSpeed = topSpeedOf(runs);
  shown.hasRobot = runs.some((run) => run.robots.length > 0);
  const { x0, x1, y0, y1 } = shown.bounds;
  shown.ratio = clamp((x1 - x0) / (y1 - y0), 1, 12);
  document.documentElement.style.setProperty("--ratio", shown.ratio);
  document.documentElement.style.setProperty("--lanes", runs.length);
  document.body.classList.toggle("several", runs.length > 1);
  byId("scrub").min = shown.first;
  byId("scrub").max = shown.last;
  const has = { lidar: (run) => run.scans.length, sonar: (run) => run.cones.length,
    thoughts: (run) => run.drawings.length,
    trails: (run) => run.people?.count, touch: (run) => run.contacts.length };
  for (const [id, test] of Object.entries(has)) byId(id).hidden = !runs.some(test);
  byId("ghost").hidden = runs.length < 2;
  offerFollowing();
  offerEvents();
  offerPlots();
  offerCameras();
  offerViews();
  showState();
}

/** Updates the controls from the state. */
function showState() {
  for (const name of SWITCHES) byId(name).setAttribute("aria-pressed", String(state[name]));
  byId("whom").value = state.follow;
  byId("follow").setAttribute("aria-pressed", String(state.follow.startsWith("robot")));
  ask();
}

function fail(error) {
  byId("failure").hidden = false;
  byId("failure").textContent = `The replay cannot be shown: ${error.message}`;
}

async function start() {
  shown.wide.canvas = byId("overview");
  await addRuns(packedRuns());
  for (const address of fragment().getAll("with")) {
    await runsAt(address).then(addRuns).catch(({ message }) => say(`A run cannot be shown: ${message}`));
  }
  readColours();
  arrange();
  const { x0, x1, y0, y1 } = shown.bounds;
  state.time = shown.first;
  state.middle = { x: (x0 + x1) / 2, y: (y0 + y1) / 2 };
  state.follow = shown.hasRobot ? "robot" : "";
  const paused = fragment().has("paused");
  readAddress();
  arrange();
  offerReport();
  byId("clip-format").options[0].disabled = !videoType();
  if (!videoType()) byId("clip-format").selectedIndex = 1;
  bindButtons();
  bindPage();
  bindViews();
  await chooseView(state.view).catch(({ message }) => say(message));
  const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
  setPlaying(!paused && !still);
  paint();
  document.documentElement.dataset.ready = "";
}

if (!handOver()) start().catch(fail);
