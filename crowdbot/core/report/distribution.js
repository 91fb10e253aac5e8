// How one score is distributed over the runs: dots with a box, or cumulative curves.

let namesWidth = 150; // room for the names of planners
const RIGHT = 118;
const ROW = 74;

function drawDistribution() {
  const box = byId("distribution");
  const series = report.series[state.series];
  const rows = shownPlanners().map((p) => {
    const runs = selectedRuns(p);
    return { planner: p, runs, about: describe(state.series, runs) };
  });
  namesWidth = Math.min(230, 70 + 7 * Math.max(0, ...rows.map((row) => shortened(row.planner).length)));
  const width = Math.max(480, box.clientWidth || 900);
  const values = rows.flatMap(({ runs, about }) => [...about.sorted, ...runs.flatMap(boundsOf)]);
  const marks = series.reference ? [series.reference.value] : [];
  const x = scale(spanOf(values, marks), [namesWidth, width - RIGHT], 7);
  const picture = state.chart === "ecdf" ? drawCurves(rows, x, width) : drawStrips(rows, x, width);
  picture.setAttribute("aria-label", distributionText(series, rows));
  box.replaceChildren(picture);
  byId("distribution-note").textContent = distributionNote(series, rows, x);
  for (const name of ["strip", "ecdf"]) {
    byId(`chart-${name}`).setAttribute("aria-pressed", String(state.chart === name));
  }
}

function drawStrips(rows, x, width) {
  const bottom = 10 + ROW * rows.length;
  const reference = report.series[state.series].reference;
  const picture = canvas(width, bottom + 24, bottomAxis(x, 6, bottom, reference));
  rows.forEach((row, i) => picture.append(strip(row, x, 10 + ROW * i, width)));
  return picture;
}

function canvas(width, height, ...children) {
  return svg("svg", { viewBox: `0 0 ${width} ${height}`, class: "chart", role: "img" }, children);
}

function strip({ planner, runs, about }, x, top, width) {
  const middle = top + ROW / 2 - 8;
  const group = svg("g", {}, top < ROW ? null : svg("line", { class: "rule", x1: 0, x2: width, y1: top, y2: top }));
  group.append(marker(planner, 10, top + 22, 5), label(shortened(planner), 22, top + 26));
  const dots = svg("g", { class: `dots p${planner % SHAPES.length}` });
  const beyond = [0, 0];
  runs.forEach((run, k) => {
    const { status, value, lower, upper } = scoreOf(state.series, run);
    const y = middle - 14 + 34 * ((k * 0.618034) % 1);
    if (status === "ok" && value < x.low) beyond[0]++;
    else if (status === "ok" && value > x.high) beyond[1]++;
    else if (status === "ok") dots.append(svg("circle", { cx: round(x.place(value)), cy: round(y), r: 2.4 }));
    else if (status === "censored") dots.append(...bound(x, y, lower, upper));
  });
  group.append(dots);
  if (about.ok) group.append(boxOf(planner, about, x, middle + 34));
  if (beyond[0]) group.append(label(`◂ ${beyond[0]} beyond`, x.place(x.low) + 2, top + 12, "tick"));
  if (beyond[1]) group.append(label(`${beyond[1]} beyond ▸`, x.place(x.high) - 2, top + 12, "tick", "end"));
  group.append(counts(about, width - RIGHT + 14, top + 20));
  return group;
}

/** What is known of a censored value. */
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

/** The middle half of the runs, their median, and the interquartile mean with its interval. */
function boxOf(planner, about, x, y) {
  const inside = (v) => round(Math.min(x.place(x.high), Math.max(x.place(x.low), x.place(v))));
  const group = svg("g", { class: `p${planner % SHAPES.length}` },
    svg("rect", { class: "quartiles", x: inside(about.q1), y: y - 4, height: 8, width: Math.max(1, inside(about.q3) - inside(about.q1)) }),
    svg("line", { class: "median", x1: inside(about.median), x2: inside(about.median), y1: y - 7, y2: y + 7 }));
  const known = intervalOf(selectionName(), state.series, planner);
  if (known && Number.isFinite(known.low)) {
    group.append(svg("line", { class: "whisker", x1: inside(known.low), x2: inside(known.high), y1: y, y2: y }));
  }
  group.append(marker(planner, inside(about.centre), y, 5, "ringed"));
  return group;
}

/** A planner's name, cut to what there is room for; the table has it in full. */
function shortened(planner) {
  const name = report.planners[planner].label;
  return name.length > 22 ? `${name.slice(0, 21)}…` : name;
}

function label(text, x, y, kind = "label", anchor = "start") {
  return svg("text", { class: kind, x: round(x), y: round(y), "text-anchor": anchor, text });
}

/** What has no value, beside the picture: hatched boxes with numbers. */
function counts(about, x, y) {
  const lines = [`${about.ok} with a value`];
  const group = svg("g", {}, label(lines[0], x, y, "tick"));
  let line = y;
  for (const [kind, text] of WITHOUT_VALUE) {
    if (!about[kind]) continue;
    line += 16;
    group.append(svg("rect", { class: `no-value ${kind}`, x, y: line - 9, width: 12, height: 10 }),
      label(`${about[kind]} ${text}`, x + 17, line, "tick"));
  }
  return group;
}

/** Share of all runs, those without a value among them, up to each value. */
function drawCurves(rows, x, width) {
  const height = 260;
  const y = scale([0, 1], [height - 8, 12], 4);
  const reference = report.series[state.series].reference;
  const picture = canvas(width, height + 18, bottomAxis(x, 12, height - 8, reference));
  for (const tick of y.ticks) {
    picture.append(svg("line", { class: "grid", x1: namesWidth, x2: width - RIGHT, y1: round(y.place(tick)), y2: round(y.place(tick)) }),
      label(`${Math.round(100 * tick)} %`, namesWidth - 8, y.place(tick) + 4, "tick", "end"));
  }
  rows.forEach(({ planner, runs, about }, i) => {
    let path = `M${round(x.place(x.low))} ${round(y.place(0))}`;
    let last = 0;
    about.sorted.forEach((value, k) => {
      const place = round(Math.min(x.place(x.high), Math.max(x.place(x.low), x.place(value))));
      last = (k + 1) / runs.length;
      path += `H${place}V${round(y.place(last))}`;
    });
    path += `H${round(x.place(x.high))}`;
    picture.append(svg("path", { class: `curve p${planner % SHAPES.length}`, d: path }));
    for (const q of [0.25, 0.5, 0.75]) {
      const k = Math.ceil(q * runs.length) - 1;
      if (k >= 0 && k < about.ok) picture.append(marker(planner, Math.min(x.place(x.high), Math.max(x.place(x.low), x.place(about.sorted[k]))), y.place((k + 1) / runs.length), 4.5, "ringed"));
    }
    const top = 24 + 56 * i;
    picture.append(marker(planner, 10, top, 5), label(shortened(planner), 22, top + 4), counts(about, width - RIGHT + 14, top));
  });
  return picture;
}

function distributionText(series, rows) {
  const parts = rows.map(({ planner, about }) => `${report.planners[planner].label}: ` +
    `${series.centre} ${digits(about.centre)}, quartiles ${digits(about.q1)}, ${digits(about.median)}, ` +
    `${digits(about.q3)}, ${about.ok} values, ${about.censored} censored, ${about.undefined} undefined`);
  return `${words(series.metric)}, ${words(series.variant)}. ${parts.join(". ")}.`;
}

function distributionNote(series, rows, x) {
  const parts = [];
  if (state.chart === "strip") {
    parts.push(`A dot is a run; the bar is the middle half of the runs, the tick its median, the mark the ${series.centre}.`);
    if (selectionName() === null) parts.push("Intervals are worked out for all runs and for one value of one parameter only, so there is none here.");
    else parts.push(`The thin line is the ${report.stats.level} % interval of the ${series.centre}.`);
    if (rows.some(({ about }) => about.censored)) parts.push("Hollow arrows are censored runs: the value lies on the side to which they point.");
  } else {
    parts.push("Share of all runs with a value up to this; a curve that ends below 100 % has runs without a value.");
  }
  const { reference } = series;
  if (reference) {
    const seen = reference.value >= x.low && reference.value <= x.high;
    parts.push(`${seen ? "Dashed line" : "Reference, outside the picture"}: ${digits(reference.value)}, ${reference.meaning}.`);
  }
  return parts.join(" ");
}
