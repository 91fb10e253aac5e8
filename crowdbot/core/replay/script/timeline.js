// The strip under the slider: one lane per run, with a curve, contacts and arrivals.

/** Returns the series of a run to show in its lane, and its range. */
function laneOf(run) {
  const best = ["clearance", "speed", "walking"].map((key) => oneOf(run, key)).find(Boolean);
  if (!best) return { name: "", series: null, top: 1 };
  const top = best.key === "clearance" ? 2 : Math.max(0.1, axisOf([best]).high);
  return { name: `${best.name} (0–${digits(top)} ${best.unit})`, series: best, top };
}

function drawTimeline(canvas, time) {
  const { g, width, height } = prepareCanvas({ canvas });
  g.clearRect(0, 0, width, height);
  const tall = height / shown.runs.length;
  shown.runs.forEach((run, i) => {
    g.save();
    g.translate(0, i * tall);
    g.beginPath();
    g.rect(0, 0, width, tall);
    g.clip();
    drawLane(g, run, { width, height: tall, time, label: width > 300 });
    g.restore();
  });
}

function drawLane(g, run, { width, height, time, label }) {
  const at = (t) => ((t - shown.first) / (shown.last - shown.first || 1)) * width;
  const colour = shown.runs.length > 1 ? colourOfRun(run.index) : colours.accent;
  if (run.lane.series) drawCurve(g, run.lane, { at, height, colour, time });
  g.fillStyle = colours.contact;
  for (const { t0, t1 } of run.contacts) g.fillRect(at(t0) - 1, 0, Math.max(2, at(t1) - at(t0)), height);
  g.fillStyle = colours.goal;
  for (const { goalTime } of run.robots) {
    if (goalTime !== null) g.fillRect(at(goalTime) - 2, 0, 3, height);
  }
  if (!label) return;
  const text = shown.runs.length > 1 ? `${run.label}: ${run.lane.name}` : run.lane.name;
  g.font = "11px system-ui, sans-serif";
  g.fillStyle = colours.floor;
  g.globalAlpha = 0.8;
  g.fillRect(4, 1, g.measureText(text).width + 4, 14);
  g.globalAlpha = 1;
  g.fillStyle = colours.ink;
  g.fillText(text, 6, 12);
}

function drawCurve(g, { series: { t, values }, top }, { at, height, colour, time }) {
  const area = new Path2D();
  const tall = height - Math.min(17, height / 3);
  area.moveTo(at(t[0]), height);
  values.forEach((v, k) =>
    area.lineTo(at(t[k]), height - 1 - clamp(Number.isNaN(v) ? top : v, 0, top) / top * tall));
  area.lineTo(at(t[t.length - 1]), height);
  area.closePath();
  g.fillStyle = colour;
  g.globalAlpha = 0.16;
  g.fill(area);
  g.save();
  g.beginPath();
  g.rect(0, 0, at(time), height);
  g.clip();
  g.globalAlpha = 0.42;
  g.fill(area);
  g.restore();
  g.globalAlpha = 1;
}
