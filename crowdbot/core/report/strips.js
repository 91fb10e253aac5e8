// Every run of a score as a dot, planner below planner.

const ROW = 74;

function drawStrips(rows, x, frame) {
  const { width, narrow } = frame;
  const step = narrow ? ROW + 22 : ROW;
  const bottom = 10 + step * rows.length;
  const series = report.series[state.series];
  const picture = canvas(width, bottom + 42, bottomAxis(x, 6, bottom, series.reference), axisTitle(x, bottom + 36, measureOf(series)));
  picture.setAttribute("role", "group"); // it has links inside
  rows.forEach((row, i) => picture.append(strip(row, x, 10 + step * i, frame)));
  return picture;
}

function strip({ planner, runs, about }, x, top, { width, narrow }) {
  const middle = top + ROW / 2 - 8 + (narrow ? 22 : 0);
  const group = svg("g", {}, top < ROW ? null : svg("line", { class: "rule", x1: 0, x2: width, y1: top, y2: top }));
  const head = narrow ? top + 14 : top + 22;
  group.append(marker(planner, 10, head, 5), label(shortened(planner), 22, head + 4));
  const dots = svg("g", { class: `dots p${planner % SHAPES.length}` });
  const beyond = [0, 0];
  runs.forEach((run, k) => {
    const { status, value, lower, upper } = scoreOf(state.series, run);
    const y = middle - 14 + 34 * ((k * 0.618034) % 1);
    if (status === "ok" && value < x.low) beyond[0]++;
    else if (status === "ok" && value > x.high) beyond[1]++;
    else if (status === "ok") dots.append(dotOf(run, svg("circle", { cx: round(x.place(value)), cy: round(y), r: 2.4 })));
    else if (status === "censored") dots.append(...bound(x, y, lower, upper).map((mark) => dotOf(run, mark)));
  });
  group.append(dots);
  if (about.ok) group.append(boxOf(planner, about, x, middle + 34));
  if (beyond[0]) group.append(label(`◂ ${beyond[0]} beyond`, x.place(x.low) + 2, middle - 17, "tick"));
  if (beyond[1]) group.append(label(`${beyond[1]} beyond ▸`, x.place(x.high) - 2, middle - 17, "tick", "end"));
  group.append(narrow ? label(countText(about), width - 4, head + 4, "tick", "end") : counts(about, width - RIGHT + 14, top + 20));
  return group;
}

/** Bounds of a censored value; empty for other values. */
function boundsOf(run) {
  const { status, lower, upper } = scoreOf(state.series, run);
  return status === "censored" ? [lower, upper] : [];
}

/** A censored value: a hollow arrow at its bound, pointing to where the value may be. */
function bound(x, y, lower, upper) {
  return [[lower, 1], [upper, -1]].filter(([v]) => Number.isFinite(v) && v >= x.low && v <= x.high)
    .map(([v, to]) => svg("path", {
      class: "bound", d: `M${round(x.place(v))} ${round(y - 4)}l${to * 6} 4l${-to * 6} 4z`,
    }));
}

/** The middle half of the runs, their median, and the mean with its interval. */
function boxOf(planner, about, x, y) {
  const inside = (v) => round(Math.min(x.place(x.high), Math.max(x.place(x.low), x.place(v))));
  const group = svg("g", { class: `p${planner % SHAPES.length}` },
    svg("rect", { class: "quartiles", x: inside(about.q1), y: y - 4, height: 8, width: Math.max(1, inside(about.q3) - inside(about.q1)) }),
    svg("line", { class: "median", x1: inside(about.median), x2: inside(about.median), y1: y - 7, y2: y + 7 }));
  if (Number.isFinite(about.low)) {
    group.append(svg("line", { class: "whisker", x1: inside(about.low), x2: inside(about.high), y1: y, y2: y }));
  }
  if (Number.isFinite(about.centre)) group.append(marker(planner, inside(about.centre), y, 5, "ringed"));
  return group;
}

/** Counts of runs without a value, beside the picture: hatched boxes with numbers. */
function counts(about, x, y) {
  const group = svg("g", {}, label(`${about.ok} with a value`, x, y, "tick"));
  let line = y;
  for (const [kind, text] of WITHOUT_VALUE) {
    if (!about[kind]) continue;
    line += 16;
    group.append(svg("rect", { class: `no-value ${kind}`, x, y: line - 9, width: 12, height: 10 }),
      label(`${about[kind]} ${text}`, x + 17, line, "tick"));
  }
  return group;
}

/** The same in one line, where there is no room beside the picture. */
function countText(about) {
  const missing = WITHOUT_VALUE.filter(([kind]) => about[kind]).map(([kind, text]) => `${about[kind]} ${text}`);
  return [`${about.ok} with a value`, ...missing].join(", ");
}
