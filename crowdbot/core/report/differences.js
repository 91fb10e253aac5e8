// Where two planners differ most: the runs of the same scenario and seed, side by side.

const DIFFERENCES = 8;
let differencesShown = DIFFERENCES;

function drawDifferences() {
  const pair = report.stats.pairs[state.pair];
  const rows = pair ? differencesOf(...pair) : [];
  byId("differences-part").hidden = !rows.length;
  if (!rows.length) return;
  const series = report.series[state.series];
  const shown = rows.slice(0, differencesShown);
  const decimals = decimalsFor(shown.flatMap((row) => [row.a.value, row.b.value]));
  const names = pair.map((p) => report.planners[p].label);
  const columns = [
    { text: "scenario", key: (row) => row.scenario }, { text: "seed", numeric: true, key: (row) => row.seed },
    ...pair.map((p, i) => ({ node: planned(p), numeric: true, key: (row) => (i ? row.b : row.a).value })),
    { text: `difference${series.unit === "1" ? "" : `, ${series.unit}`}`, numeric: true, key: (row) => row.difference },
    { text: "both in one replay" },
  ];
  sortable(byId("differences-table"), columns, shown, (row) => el("tr", {},
    el("th", { scope: "row", class: "id", text: row.scenario }), numberCell(String(row.seed)),
    [row.a, row.b].map(({ run, value }) => el("td", { class: "number" }, el("b", { text: format(value, decimals) }), el("small", {}, replayLink(attemptOf(run))))),
    numberCell(format(row.difference, decimals)), el("td", {}, compareButton(row))));
  byId("differences-more").hidden = rows.length <= differencesShown;
  byId("differences-note").textContent = `${names[0]} and ${names[1]} in ${plural(rows.length, "pair")} of the same scenario and seed, by ${measureOf(series)}, ` +
    "the largest difference first. A link opens both in one replay; the button copies the command that writes one file with both, to run where this page lies.";
  offer(byId("differences-save"), `${series.metric}-${series.variant}-${names.join("-against-")}`, null, () => differenceRows(rows, names));
}

/** Pairs of runs in which both have a value, the farthest apart first. */
function differencesOf(a, b) {
  const { runs } = report;
  const place = (run) => `${runs.scenario[run]} ${runs.seed[run]}`;
  const others = new Map(selectedRuns(b).map((run) => [place(run), run]));
  return selectedRuns(a).filter((run) => others.has(place(run))).map((run) => {
    const [one, other] = [run, others.get(place(run))].map((r) => ({ run: r, ...scoreOf(state.series, r) }));
    const difference = one.value - other.value;
    return { a: one, b: other, difference, scenario: report.scenarios[runs.scenario[run]], seed: runs.seed[run] };
  }).filter((row) => row.a.status === "ok" && row.b.status === "ok" && row.difference !== 0)
    .sort((x, y) => Math.abs(y.difference) - Math.abs(x.difference) || x.a.run - y.a.run);
}

/** Folder of a run, as seen from this page. */
const folderOf = (replay) => (replay ? decodeURIComponent(replay).replace(/\/[^/]*$/, "") : "");

/** Command for a replay of both. */
function compareCommand(row) {
  const folders = [row.a, row.b].map(({ run }) => folderOf(report.runs.replay[run]));
  return folders.every(Boolean) ? `crowdbot view ${folders.map(quoted).join(" ")} --out compare.html` : "";
}

const quoted = (text) => (/^[\w@%+=:,./-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);

function compareButton(row) {
  const command = compareCommand(row);
  if (!command) return el("small", { text: "–" });
  const open = el("a", { href: replayAt(row.a.run, report.runs.replay[row.b.run]), text: "open both",
    "aria-label": `open both: the runs of ${row.scenario}, seed ${row.seed}, in one replay` });
  const button = el("button", { type: "button", title: command, text: "copy command",
    "aria-label": `copy command: for one replay of both runs of ${row.scenario}, seed ${row.seed}` });
  button.onclick = () => copyText(command, button);
  return el("span", { class: "pair" }, open, " ", button);
}

function differenceRows(rows, names) {
  return [["scenario", "seed", ...names, "difference", "command"],
    ...rows.map((row) => [row.scenario, String(row.seed), row.a.value, row.b.value, row.difference, compareCommand(row)])];
}
