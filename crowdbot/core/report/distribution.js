// Distribution of one score over the runs: dots with a box, or cumulative curves.

const RIGHT = 118; // room for counts

function drawDistribution() {
  const box = byId("distribution");
  const series = report.series[state.series];
  const rows = shownPlanners().map((p) => {
    const runs = selectedRuns(p);
    return { planner: p, runs, about: describeSelected(state.series, p) };
  });
  const frame = frameOf(box, rows);
  const values = rows.flatMap(({ runs, about }) => [...about.sorted, ...runs.flatMap(boundsOf)]);
  const marks = series.reference ? [series.reference.value] : [];
  const x = scale(spanOf(values, marks), [frame.left, frame.right], frame.narrow ? 4 : 7);
  const picture = state.chart === "ecdf" ? drawCurves(rows, x, frame) : drawStrips(rows, x, frame);
  picture.setAttribute("aria-label", distributionText(series, rows));
  box.replaceChildren(picture);
  offer(byId("distribution-save"), `${series.metric}-${series.variant}-${state.chart}`, picture, () => distributionRows(rows));
  byId("distribution-note").textContent = distributionNote(series, rows, x);
  for (const name of ["strip", "ecdf"]) {
    byId(`chart-${name}`).setAttribute("aria-pressed", String(state.chart === name));
  }
}

/** Margins of the picture: on narrow screens names are above the dots instead of beside them. */
function frameOf(box, rows) {
  const width = Math.max(280, box.clientWidth || 900);
  const narrow = width < 620;
  const names = Math.min(230, 70 + 7 * Math.max(0, ...rows.map((row) => shortened(row.planner).length)));
  const curves = state.chart === "ecdf";
  return { width, narrow, left: narrow ? (curves ? 44 : 14) : names, right: narrow ? width - 14 : width - RIGHT };
}

function canvas(width, height, ...children) {
  return svg("svg", { viewBox: `0 0 ${width} ${height}`, class: "chart", role: "img" }, children);
}

function axisTitle(x, y, text) {
  return label(text, (x.place(x.low) + x.place(x.high)) / 2, y, "axis", "middle");
}

/** A planner's name, truncated to the space available; the table has it in full. */
function shortened(planner) {
  const name = report.planners[planner].label;
  return name.length > 22 ? `${name.slice(0, 21)}…` : name;
}

function label(text, x, y, kind = "label", anchor = "start") {
  return svg("text", { class: kind, x: round(x), y: round(y), "text-anchor": anchor, text });
}

function distributionText(series, rows) {
  const parts = rows.map(({ planner, about }) => `${report.planners[planner].label}: ` +
    `${series.centre} ${estimateText(about).join(" ").trim()}, quartiles ${digits(about.q1)}, ${digits(about.median)}, ` +
    `${digits(about.q3)}, ${about.ok} values, ${about.censored} censored, ${about.undefined} undefined`);
  return `${words(series.metric)}, ${words(series.variant)}. ${parts.join(". ")}.`;
}

function distributionNote(series, rows, x) {
  const parts = [];
  if (state.chart === "strip") {
    parts.push(`Each dot is a run; click it to open its replay at the worst moment; the bar is the middle half of the runs, the tick its median, the mark the ${series.centre}.`);
    if (selectionName() === null) parts.push("Intervals are computed only for all runs and for single values of one parameter, so there is none here.");
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

/** The runs of the picture as a table. */
function distributionRows(rows) {
  const head = ["scenario", "planner", "seed", "run_status", "status", "reason", "value", "lower", "upper", "worst_moment_s"];
  const lines = rows.flatMap(({ runs }) => runs.map((run) => {
    const { scenario, planner, seed, status } = attemptOf(run);
    const score = scoreOf(state.series, run);
    return [scenario, report.planners[planner].label, String(seed), status, score.status, score.reason,
      score.value, score.lower, score.upper, report.runs.moment[run]?.[0]];
  }));
  return [head, ...lines];
}
