// Draws what the planner thought at a time: the people that it tracks, paths, points and texts.

const THOUGHT_AGE = 0.5; // s; older drawings are not shown
const AHEAD = 1; // s; a track's line ends where it would be then

/** Draws the latest drawing of each name. */
function drawThoughts(g, run, time, px) {
  for (const drawing of run.drawings) {
    const j = lastBefore(drawing.t, time);
    if (j < 0 || time - drawing.t[j] > THOUGHT_AGE) continue;
    const [from, to] = [drawing.starts[j], drawing.starts[j] + drawing.rows[j]];
    const show = drawing.which?.[from] >= 0 ? drawTexts : drawingOf(drawing);
    show(g, drawing, from, to, px);
  }
}

/** Returns the function that draws a drawing: tracks, or by the beginning of its name. */
function drawingOf({ name, tracks }) {
  if (tracks) return drawTracks;
  if (name.startsWith("points")) return drawPoints;
  return name.startsWith("arrows") ? drawArrows : drawPath;
}

/** Draws a dot on each row. */
function drawPoints(g, { columns: [x, y] }, from, to, px) {
  g.beginPath();
  for (let i = from; i < to; i++) {
    g.moveTo(x[i], y[i]);
    g.arc(x[i], y[i], 2.5 * px, 0, 2 * Math.PI);
  }
  g.fillStyle = colours.thought;
  g.fill();
}

/** Writes a text at each row, upright whatever the scale. */
function drawTexts(g, { columns: [x, y], texts, which }, from, to, px) {
  g.font = "600 13px system-ui, sans-serif";
  g.textAlign = "center";
  g.textBaseline = "middle";
  g.lineJoin = "round";
  g.lineWidth = 4;
  g.strokeStyle = colours.floor;
  g.fillStyle = colours.thought;
  for (let i = from; i < to; i++) {
    g.save();
    g.translate(x[i], y[i]);
    g.scale(px, -px);
    g.strokeText(texts[which[i]], 0, 0);
    g.fillText(texts[which[i]], 0, 0);
    g.restore();
  }
  g.textAlign = "start";
  g.textBaseline = "alphabetic";
  g.lineJoin = "miter";
}

/** Draws an arrow from each row to the next one, two rows each. */
function drawArrows(g, { columns: [x, y] }, from, to, px) {
  g.beginPath();
  for (let i = from; i + 1 < to; i += 2) {
    const angle = Math.atan2(y[i + 1] - y[i], x[i + 1] - x[i]);
    g.moveTo(x[i], y[i]);
    g.lineTo(x[i + 1], y[i + 1]);
    for (const side of [-1, 1]) {
      const barb = angle + side * 2.6;
      g.moveTo(x[i + 1], y[i + 1]);
      g.lineTo(x[i + 1] + 7 * px * Math.cos(barb), y[i + 1] + 7 * px * Math.sin(barb));
    }
  }
  g.strokeStyle = colours.thought;
  g.lineWidth = 2 * px;
  g.stroke();
}

/** Draws a cross on each track, and a line to where it would be. */
function drawTracks(g, { columns: [x, y, vx, vy] }, from, to, px) {
  const r = Math.max(0.1, 3 * px);
  g.beginPath();
  for (let i = from; i < to; i++) {
    g.moveTo(x[i] - r, y[i]);
    g.lineTo(x[i] + r, y[i]);
    g.moveTo(x[i], y[i] - r);
    g.lineTo(x[i], y[i] + r);
    g.moveTo(x[i], y[i]);
    g.lineTo(x[i] + AHEAD * vx[i], y[i] + AHEAD * vy[i]);
  }
  g.strokeStyle = colours.thought;
  g.lineWidth = 1.5 * px;
  g.stroke();
}

/** Draws rows as a line with a dot at its end. */
function drawPath(g, { columns: [x, y] }, from, to, px) {
  if (from === to) return;
  g.beginPath();
  for (let i = from; i < to; i++) g[i === from ? "moveTo" : "lineTo"](x[i], y[i]);
  g.strokeStyle = g.fillStyle = colours.thought;
  g.lineWidth = 2 * px;
  g.stroke();
  g.beginPath();
  g.arc(x[to - 1], y[to - 1], 3 * px, 0, 2 * Math.PI);
  g.fill();
}
