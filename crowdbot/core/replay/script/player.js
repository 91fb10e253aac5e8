// The clock, and what is drawn at each moment.

let queued = false;
let before = 0;

function ask() {
  if (!queued) requestAnimationFrame(render);
  queued = true;
}

function render(now) {
  queued = false;
  if (state.playing) {
    const passed = clamp((now - before) / 1000, 0, 0.1);
    state.time += passed * Number(byId("speed").value);
    if (state.time >= shown.last) {
      state.time = shown.last;
      setPlaying(false);
    }
    keepAddress();
  }
  before = now;
  paint();
  if (state.playing) ask();
}

function setPlaying(on) {
  state.playing = on;
  before = performance.now();
  document.body.classList.toggle("playing", on);
  byId("play").setAttribute("aria-label", on ? "Pause" : "Play");
  keepAddress();
  ask();
}

function play() {
  if (!state.playing && state.time >= shown.last) state.time = shown.first;
  setPlaying(!state.playing);
}

function seek(time) {
  state.time = clamp(time, shown.first, shown.last);
  keepAddress();
  ask();
}

function step(by) {
  setPlaying(false);
  const [run] = shown.runs;
  const { k, f } = sampleAt(run, state.time);
  const at = by < 0 ? Math.ceil(k + f - 1e-6) : Math.floor(k + f + 1e-6);
  seek(run.t[clamp(at + by, 0, run.n - 1)]);
}

/** Content of the view of a run, apart from its centre. */
function optionsFor(run, frames, more) {
  const ghosts = !state.ghost ? [] : shown.runs.filter((other) => other !== run).map((other) =>
    ({ other, ghost: frames[other.index], colour: colourOfRun(other.index) }));
  const colour = shown.runs.length > 1 ? colourOfRun(run.index) : colours.robot;
  const followed = followedIn(run, frames[run.index]);
  return { grid: 0.5, lidar: state.lidar, sonar: state.sonar, thoughts: state.thoughts, trails: state.trails, ghosts, colour, followed, ...more };
}

/** Centres a view on the followed body, or on the chosen place. */
function aim(view, run, frame) {
  const { place } = followedIn(run, frame) ?? { place: state.follow ? view : state.middle };
  [view.x, view.y] = [place.x, place.y];
  view.scale = Math.max(widthOf(view), view.size ? 0 : 320) / state.span;
}

function aimWide(view) {
  const { x0, y0, x1, y1 } = shown.bounds;
  [view.x, view.y] = [(x0 + x1) / 2, (y0 + y1) / 2];
  view.scale = Math.min(widthOf(view) / (x1 - x0), heightOf(view) / (y1 - y0));
}

function framesNow() {
  return shown.runs.map((run) => frameAt(run, state.time));
}

function paint() {
  const frames = framesNow();
  for (const { view, run } of shown.panels) aim(view, run, frames[run.index]);
  const skipped = state.playing && state.view !== "plan" && (shown.panels[0].solid?.frames ?? 0) % 4;
  if (!skipped) paintWide(shown.wide, frames); // in three dimensions, the time is needed elsewhere
  for (const panel of shown.panels) paintPanel(panel, frames);
  if (shown.onPaper) return;
  drawTimeline(byId("timeline"), state.time);
  drawPlots(state.time);
  drawCameras(state.time);
  for (const panel of shown.panels) writeReadout(panel, frames[panel.run.index]);
  writeLegend();
  writeClock();
}

function paintWide(view, frames) {
  aimWide(view);
  const boxes = shown.panels.map(({ view: { x, y, scale }, view: close, run }) => ({
    x, y, w: widthOf(close) / scale, h: heightOf(close) / scale,
    colour: shown.runs.length > 1 ? colourOfRun(run.index) : colours.accent,
  }));
  const [run] = shown.runs;
  drawView(run, view, frames[0], optionsFor(run, frames, { grid: 1, sonar: false, thoughts: false, trails: false, frames: boxes }));
}

function paintPanel(panel, frames) {
  const { run, view, solid } = panel;
  if (paintPanelSolid(panel, frames[run.index])) {
    if (view.size) { // a picture that is saved
      const { g, width, height } = prepareCanvas(view);
      const scale = Math.max(width / solid.canvas.width, height / solid.canvas.height);
      const [w, h] = [scale * solid.canvas.width, scale * solid.canvas.height];
      g.drawImage(solid.canvas, (width - w) / 2, (height - h) / 2, w, h);
    }
    return;
  }
  const { g, height } = drawView(run, view, frames[run.index], optionsFor(run, frames, {}));
  drawScaleBar(g, view, height);
}
