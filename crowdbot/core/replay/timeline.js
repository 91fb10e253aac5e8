// The strip under the slider: one curve of the run, contacts, arrival.

/** What is worth a curve, between 0 and 1 at each sample, and what it is called. */
function curveOf(run) {
  const samples = Array.from({ length: run.n }, (_, k) => k);
  const scaled = (values, top) => values.map((v) => Math.min(1, Math.max(0, v / top)));
  if (run.robot && run.people) {
    const gaps = samples.map((k) => clearanceAt(run, k));
    return { name: "distance to the nearest person (0–2 m)", gaps, values: scaled(gaps, 2) };
  }
  if (run.robot) {
    const top = Math.max(0.1, ...run.robot.v);
    return { name: `speed (0–${top.toFixed(1)} m/s)`, values: scaled([...run.robot.v], top) };
  }
  if (!run.people || !run.people.count) return { name: "", values: [] };
  const mean = samples.map((k) => {
    let [sum, there] = [0, 0];
    for (let p = 0; p < run.people.count; p++) {
      if (run.people.x[p * run.n + k] === ABSENT) continue;
      sum += run.people.speed[p * run.n + k];
      there++;
    }
    return there ? sum / there : 0;
  });
  const top = Math.max(0.1, ...mean);
  return { name: `mean walking speed (0–${top.toFixed(1)} m/s)`, values: scaled(mean, top) };
}

function drawTimeline(run, canvas, curve, time) {
  const { g, width, height } = prepareCanvas(canvas);
  const [first, last] = [run.t[0], run.t[run.n - 1]];
  const at = (t) => ((t - first) / (last - first || 1)) * width;
  g.clearRect(0, 0, width, height);
  const fill = (alpha) => {
    g.globalAlpha = alpha;
    g.fillStyle = colours.accent;
    g.fill();
    g.globalAlpha = 1;
  };
  const area = () => {
    g.beginPath();
    g.moveTo(0, height);
    curve.values.forEach((v, k) => g.lineTo(at(run.t[k]), height - 1 - v * (height - 17)));
    g.lineTo(width, height);
    g.closePath();
  };
  area();
  fill(0.16);
  g.save();
  g.beginPath();
  g.rect(0, 0, at(time), height);
  g.clip();
  area();
  fill(0.42);
  g.restore();
  g.fillStyle = colours.contact;
  for (const contact of run.contacts) {
    g.fillRect(at(contact.t0) - 1, 0, Math.max(2, at(contact.t1) - at(contact.t0)), height);
  }
  if (run.robot && run.robot.goalTime !== null) {
    g.fillStyle = colours.goal;
    g.fillRect(at(run.robot.goalTime) - 2, 0, 3, height);
  }
  g.fillStyle = colours.muted;
  g.font = "11px system-ui, sans-serif";
  if (width > 300) g.fillText(curve.name, 6, 12);
}
