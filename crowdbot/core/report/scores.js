// The table of scores: a row for each score, a column for each planner, and a small picture.

const ARROWS = {
  higher: ["↑", "higher is better"], lower: ["↓", "lower is better"],
  reference: ["◎", "like the reference is best"], none: ["", ""],
};
const SPREAD = 260;

function drawScores(choose) {
  const planners = shownPlanners();
  const runs = Object.fromEntries(planners.map((p) => [p, selectedRuns(p)]));
  const all = shownSeries().map((s) => scoreRow(s, planners));
  const rows = all.filter((row) => row.abouts.some((a) => a.ok || a.censored));
  const compared = rows.some((row) => row.verdicts.length);
  const columns = [
    { text: "score", key: (row) => `${report.series[row.series].metric} ${row.series}` },
    ...planners.map((p, i) => ({ node: [planned(p), endings(runs[p])], numeric: true, key: (row) => row.abouts[i].centre })),
    { text: "spread", kind: "spread" },
    ...(compared ? [{ text: "difference", kind: "verdict", key: (row) => row.evidence }] : []),
  ];
  const sorted = { metric: { column: 0, up: true }, evidence: compared ? { column: columns.length - 1, up: true } : null };
  const table = byId("scores-table");
  table.classList.toggle("many", planners.length > 4);
  const drawRow = (row) => drawScoreRow(row, planners, choose);
  sortable(table, columns, rows, drawRow, sorted[state.order] ?? { column: -1, up: true });
  if (state.order === "category") groupByCategory(table, rows);
  const silent = all.filter((row) => !rows.includes(row));
  byId("scores-silent").replaceChildren(...silentText(silent));
  byId("scores-note").textContent = scoresNote();
  offer(byId("scores-save"), "scores", null, () => scoreRows(rows, planners));
}

/** The table as it is shown, planner below planner. */
function scoreRows(rows, planners) {
  const head = ["metric", "variant", "unit", "better", "planner", "centre", "low", "high", "q1", "median", "q3", "runs", "with_value"];
  return [head, ...rows.flatMap((row) => row.abouts.map((about, i) => {
    const series = report.series[row.series];
    return [series.metric, series.variant, series.unit, series.better, report.planners[planners[i]].label, about.centre,
      about.low, about.high, about.q1, about.median, about.q3, String(about.runs), String(about.ok)];
  }))];
}

function scoreRow(series, planners) {
  const abouts = planners.map((p) => describeSelected(series, p));
  const verdicts = verdictsOf(series, planners);
  const evidence = Math.min(...verdicts.map((v) => v.p_holm).filter(Number.isFinite), Infinity);
  return { series, abouts, verdicts, evidence: Number.isFinite(evidence) ? evidence : null };
}

function drawScoreRow(row, planners, choose) {
  const series = report.series[row.series];
  const cells = row.abouts.map((about) => centreCell(about, series));
  return el("tr", { "data-score": `${series.metric}.${series.variant}`, class: row.series === state.series ? "chosen" : null },
    scoreHead(row.series, choose), cells, el("td", { class: "spread" }, spreadPicture(row, planners)),
    row.verdicts.length ? el("td", { class: "verdict" }, verdictText(row.verdicts)) : null);
}

/** Summary of some runs, with its interval, or the quartiles if there is none. */
function centreCell(about, series) {
  const range = about.known || series.centre === "share" ? about : { ...about, low: about.q1, high: about.q3 };
  const [value, ends] = estimateText(range); // quartiles of yes and no say nothing
  return el("td", { class: "number" }, el("b", { text: value }),
    el("small", { text: ends, class: about.known ? null : "quartile" }), missingChips(about));
}

const centreWord = (series) => ({ share: "Shares", rate: "Rates of all runs together", mean: "Means" })[series.centre];

/** Name, symbol, unit and direction of a score; opens its card, and shows it below. */
function scoreHead(s, choose) {
  const series = report.series[s];
  const [arrow, meaning] = ARROWS[series.better];
  const button = el("button", { type: "button", class: "metric", "data-card": s, onclick: () => choose(s) },
    words(series.metric));
  const variant = series.variant === "corrected" ? null : el("span", { class: "variant", text: words(series.variant) });
  return el("th", { scope: "row" }, button, variant, el("span", { class: "about" },
    el("i", { text: series.symbol }), series.unit === "1" ? "" : ` in ${series.unit}`,
    series.centre === "mean" ? "" : ` · ${series.centre}`,
    arrow ? el("span", { class: "arrow", title: meaning, role: "img", "aria-label": meaning, text: arrow }) : null));
}

/** For each planner the middle half of its runs and its mean on one scale. */
function spreadPicture(row, planners) {
  const height = 8 + 13 * planners.length;
  const { reference, centre } = report.series[row.series];
  const share = centre === "share";
  const ends = row.abouts.flatMap((a) => (!a.ok ? [] : share ? [a.centre] : [a.q1, a.q3, a.centre]));
  const x = scale(wholeSpan(ends, reference ? [reference.value] : []), [8, SPREAD - 8]);
  const picture = svg("svg", { viewBox: `0 0 ${SPREAD} ${height}`, class: "mini", "aria-hidden": "true" });
  if (reference && reference.value >= x.low && reference.value <= x.high) {
    const place = round(x.place(reference.value));
    picture.append(svg("line", { class: "reference", x1: place, x2: place, y1: 0, y2: height }));
  }
  row.abouts.forEach((about, i) => {
    const y = 10 + 13 * i;
    if (!about.ok) return;
    if (!share) {
      picture.append(svg("line", { class: `middle p${planners[i] % SHAPES.length}`, x1: round(x.place(about.q1)), x2: round(x.place(about.q3)), y1: y, y2: y }));
    }
    if (Number.isFinite(about.centre)) picture.append(marker(planners[i], x.place(about.centre), y, 4, "ringed"));
  });
  return picture;
}

function groupByCategory(table, rows) {
  let last = "";
  rows.forEach((row, i) => {
    const { category } = report.series[row.series];
    if (category === last) return;
    last = category;
    const head = el("th", { scope: "colgroup", colspan: table.tHead.rows[0].cells.length, text: category });
    table.querySelector(`tr[data-score="${CSS.escape(`${report.series[rows[i].series].metric}.${report.series[rows[i].series].variant}`)}"]`)
      .before(el("tr", { class: "category" }, head));
  });
}

/** Number of runs in a column, and how many of them failed. */
function endings(runs) {
  const failed = runs.filter((run) => report.endings[report.statuses[report.runs.status[run]]]?.failed).length;
  return el("small", { text: plural(runs.length, "run") }, failed ? ` · ${failed} failed` : "");
}

/** Scores that no run has a value for: named, with the reason. */
function silentText(rows) {
  if (!rows.length) return [];
  const reasons = new Map();
  for (const { series } of rows) {
    const found = new Set();
    for (const run of shownPlanners().flatMap((p) => selectedRuns(p))) {
      const { status, reason } = scoreOf(series, run);
      if (status === "undefined") found.add(reason);
    }
    const reason = [...found].filter(Boolean).map(words).join(", ") || "not scored";
    reasons.set(reason, [...(reasons.get(reason) ?? []), series]);
  }
  const parts = [...reasons].map(([reason, list]) => el("li", {}, el("b", { text: `${reason}: ` }),
    list.map((s) => `${words(report.series[s].metric)} ${words(report.series[s].variant)}`).join(", ")));
  return [el("p", { text: `${plural(rows.length, "score")} without a value in any run shown:` }), el("ul", {}, parts)];
}

function scoresNote() {
  const { stats } = report;
  const range = selectionName() === null
    ? "in brackets, in italics, the quartiles of the runs, since this selection has no intervals"
    : `in brackets its ${stats.level} % interval over whole crowd draws`;
  return `Mean of the runs with a value (share: share of yes; rate: rate of all runs together); ${range}. Hatched: runs without a value, which the numbers leave out. In comparisons, runs in which the planner failed are worse than any other. ${differenceNote()}`;
}

function differenceNote() {
  if (shownPlanners().length < 2) return "";
  return selectionName() === ""
    ? "Difference: which planners are significantly better than which, after Holm's correction."
    : "Comparisons are computed for all runs only: each further selection would be another chance to find a difference that is not there.";
}
