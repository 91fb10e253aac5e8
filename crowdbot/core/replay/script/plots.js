// Plots of chosen series under the timeline: all runs in one plot, with axes and the value now.

const MARGIN = 46; // px for the numbers of the axis

/** Offers everything that any run can plot. */
function offerPlots() {
  const offered = new Map();
  for (const run of shown.runs) {
    for (const { key, name, unit } of run.series) offered.set(key, unit ? `${name}, ${unit}` : name);
  }
  byId("plot-choice").replaceChildren(...[...offered].map(([key, text]) => el("label", {},
    el("input", { type: "checkbox", value: key, checked: state.plots.has(key),
      onchange: (event) => choosePlot(key, event.target.checked) }), ` ${text}`)));
  byId("plots").hidden = !offered.size;
  byId("plots").open = state.plots.size > 0;
  makePlots();
}

function choosePlot(key, wanted) {
  state.plots[wanted ? "add" : "delete"](key);
  makePlots();
  keepAddress();
  ask();
}

function makePlots() {
  const figures = [...state.plots].flatMap((key) => {
    const all = shown.runs.map((run) => oneOf(run, key));
    const one = all.find(Boolean);
    return one ? [plotFigure(one, all)] : [];
  });
  byId("plot-figures").replaceChildren(...figures);
}

function plotFigure(one, all) {
  const canvas = el("canvas", { role: "img", "aria-label": `${one.name} over time` });
  const value = el("span", { class: "now" });
  const figure = el("figure", { class: "plot" },
    el("figcaption", {}, el("b", { text: one.unit ? `${one.name}, ${one.unit}` : one.name }), " ", value), canvas);
  const axis = axisOf(all.filter(Boolean));
  figure.plot = { canvas, value, all, axis, unit: one.unit };
  canvas.onpointerdown = (event) => seek(timeAtPlot(canvas, event.offsetX));
  canvas.onpointermove = (event) => event.buttons && seek(timeAtPlot(canvas, event.offsetX));
  return figure;
}

function timeAtPlot(canvas, x) {
  const f = (x - MARGIN) / (canvas.clientWidth - MARGIN || 1);
  return shown.first + f * (shown.last - shown.first);
}

function drawPlots(time) {
  for (const { plot } of byId("plot-figures").children) {
    drawPlot(plot, time);
    plot.value.replaceChildren(...plot.all.flatMap((series, i) => (series
      ? [el("span", { class: "of-run", "data-run": i % RUN_COLOURS, text: digits(valueAt(series, time), plot.unit) }), " "] : [])));
  }
}

function drawPlot({ canvas, all, axis }, time) {
  const { g, width, height } = prepareCanvas({ canvas });
  const at = (t) => MARGIN + ((t - shown.first) / (shown.last - shown.first || 1)) * (width - MARGIN);
  const up = (v) => height - 6 - ((v - axis.low) / (axis.high - axis.low)) * (height - 12);
  g.clearRect(0, 0, width, height);
  g.font = "11px system-ui, sans-serif";
  g.textAlign = "right";
  g.fillStyle = colours.ink;
  g.strokeStyle = colours["grid-strong"];
  for (const v of axis.ticks) {
    g.fillText(digits(v), MARGIN - 6, clamp(up(v) + 4, 10, height - 2));
    g.beginPath();
    g.moveTo(MARGIN, up(v));
    g.lineTo(width, up(v));
    g.stroke();
  }
  g.textAlign = "left";
  all.forEach((series, i) => series && drawSeries(g, series, at, up, i));
  g.fillStyle = colours.ink;
  g.fillRect(at(time) - 0.5, 0, 1.5, height);
}

/** A line that is broken where there is no value. */
function drawSeries(g, { t, values }, at, up, index) {
  g.beginPath();
  let drawn = false;
  values.forEach((v, k) => {
    if (Number.isFinite(v)) g[drawn ? "lineTo" : "moveTo"](at(t[k]), up(v));
    drawn = Number.isFinite(v);
  });
  g.strokeStyle = shown.runs.length > 1 ? colourOfRun(index) : colours.accent;
  g.lineWidth = 1.4;
  g.stroke();
}
