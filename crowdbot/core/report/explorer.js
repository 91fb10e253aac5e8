// The failure explorer: runs that did not arrive, and the worst of one score.

const WORST = 15;
const FAILED = 50;
let worstShown = WORST;
let failedShown = FAILED;

function drawExplorer() {
  drawFailed();
  drawWorst();
}

function drawFailed() {
  const rows = shownPlanners().flatMap((p) => selectedRuns(p)).map(attemptOf)
    .filter(({ status }) => status !== "arrived");
  const columns = [
    { text: "what", key: (row) => row.status }, { text: "scenario", key: (row) => row.scenario },
    { text: "planner", key: (row) => report.planners[row.planner].label },
    { text: "seed", numeric: true, key: (row) => row.seed },
    { text: "after, s", numeric: true, key: (row) => row.time },
    { text: "why", key: (row) => row.reason }, { text: "replay" },
  ];
  sortable(byId("failed-table"), columns, rows.slice(0, failedShown), drawFailedRow);
  byId("failed-more").hidden = rows.length <= failedShown;
  byId("failed-table").hidden = !rows.length;
  byId("failed-note").textContent = rows.length ? failedText(rows) : "Every run shown has arrived.";
}

function failedText(rows) {
  const count = (status) => rows.filter((row) => row.status === status).length;
  const found = Object.entries(report.endings).filter(([status]) => count(status));
  return `${found.map(([status, { past }]) => `${count(status)} ${past}`).join(", ")}.`;
}

function attemptOf(run) {
  const { runs } = report;
  return {
    run, planner: runs.planner[run], scenario: report.scenarios[runs.scenario[run]], seed: runs.seed[run],
    status: report.statuses[runs.status[run]], reason: report.reasons[runs.reason[run]], time: runs.time[run],
    traceback: runs.traceback[run], replay: runs.replay[run],
  };
}

function drawFailedRow(row) {
  const why = row.traceback
    ? el("details", {}, el("summary", { text: row.reason }), el("pre", { text: row.traceback }))
    : row.reason;
  return el("tr", {}, el("td", {}, el("span", { class: "status", "data-ending": row.status, text: words(row.status) })),
    el("th", { scope: "row", class: "id", text: row.scenario }), el("td", {}, planned(row.planner)),
    numberCell(String(row.seed)), numberCell(row.time === null ? "–" : format(row.time, 1)),
    el("td", { class: "why" }, why), el("td", {}, replayLink(row)));
}

/** Link to the replay of a run at its worst moment. */
function replayLink({ run, scenario, planner, seed, replay }) {
  if (!replay) return el("small", { text: "–" });
  const moment = report.runs.moment[run];
  const when = moment ? ` at ${format(moment[0], 1)} s` : "";
  const name = `replay${when} of ${scenario}, ${report.planners[planner].label}, seed ${seed}`;
  return el("a", { href: replayAt(run), title: moment?.[1], "aria-label": name, text: `replay${when}` });
}

/** Badness of a score for sorting: larger is worse; a bound counts as the value, on the side that it leaves open. */
function badness(series, score) {
  const known = score.status === "ok" ? score.value : [score.upper, score.lower].find(Number.isFinite);
  if (known === undefined) return NaN;
  const { better, reference } = report.series[series];
  if (better === "higher") return -known;
  if (better === "reference" && reference) return Math.abs(known - reference.value);
  return known;
}

function drawWorst() {
  const series = report.series[state.series];
  const rows = shownPlanners().flatMap((p) => selectedRuns(p)).map((run) => {
    const score = scoreOf(state.series, run);
    return { ...attemptOf(run), score, bad: badness(state.series, score) };
  }).filter((row) => Number.isFinite(row.bad)).sort((a, b) => b.bad - a.bad || a.run - b.run);
  const shown = rows.slice(0, worstShown);
  const decimals = decimalsFor(shown.map((row) => -row.bad));
  const columns = [
    { text: `${words(series.metric)}${series.unit === "1" ? "" : `, ${series.unit}`}`, numeric: true, key: (row) => -row.bad },
    { text: "scenario", key: (row) => row.scenario }, { text: "planner", key: (row) => report.planners[row.planner].label },
    { text: "seed", numeric: true, key: (row) => row.seed }, { text: "what", key: (row) => row.status }, { text: "replay" },
  ];
  sortable(byId("worst-table"), columns, shown, (row) => el("tr", {}, numberCell(valueText(row.score, decimals)),
    el("th", { scope: "row", class: "id", text: row.scenario }), el("td", {}, planned(row.planner)), numberCell(String(row.seed)),
    el("td", {}, el("span", { class: "status", "data-ending": row.status, text: words(row.status) })), el("td", {}, replayLink(row))));
  byId("worst-more").hidden = rows.length <= worstShown;
  byId("worst-note").textContent = { none: "No direction is better: the largest values first.",
    reference: "Farthest from the reference first." }[series.better] ?? `Worst first: ${ARROWS[series.better][1]}.`;
}

function valueText({ status, value, lower, upper }, decimals) {
  if (status === "ok") return format(value, decimals);
  return Number.isFinite(upper) ? `≤ ${format(upper, decimals)}` : `≥ ${format(lower, decimals)}`;
}
