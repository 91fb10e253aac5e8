// Planner against planner: paired by scenario and seed, as computed in Python.

/** Comparisons of the planners shown for a score; empty if the selection has none. */
function verdictsOf(series, planners) {
  return report.stats.pairs.map(([a, b], pair) => ({ a, b, pair, ...comparisonOf(series, pair) }))
    .filter(({ a, b, verdict }) => verdict !== undefined && planners.includes(a) && planners.includes(b));
}

/** Shows which planner is better, with marks; no order if the difference may be chance. */
function verdictText(verdicts) {
  const decided = verdicts.filter(isClear);
  if (!decided.length) {
    const none = verdicts.every((v) => v.verdict === "not ranked");
    return el("small", { text: none ? "not ranked" : "not distinguishable" });
  }
  return decided.map(({ a, b, verdict }) => {
    const [first, second] = verdict === "worse" ? [b, a] : [a, b];
    const text = `${report.planners[first].label} better than ${report.planners[second].label}`;
    return el("span", { class: "decided", title: text, role: "img", "aria-label": text },
      badge(first), el("span", { text: "›" }), badge(second));
  });
}

function drawPairs(choosePair) {
  const planners = shownPlanners();
  const rows = verdictsOf(state.series, planners);
  const series = report.series[state.series];
  const decimals = decimalsFor(rows.flatMap((v) => [v.difference, v.low, v.high]));
  const columns = [
    { text: "pair", key: (v) => `${report.planners[v.a].label} ${report.planners[v.b].label}` },
    { text: `difference${series.unit === "1" ? "" : `, ${series.unit}`}`, numeric: true, key: (v) => v.difference },
    { text: "effect size", numeric: true, key: (v) => v.effect },
    { text: "probability of improvement", numeric: true, key: (v) => v.improvement },
    { text: "p, Holm", numeric: true, key: (v) => v.p_holm },
    { text: "detectable", numeric: true, key: (v) => v.detectable },
    { text: "pairs", numeric: true, key: (v) => v.pairs },
    { text: "verdict", key: (v) => v.verdict },
  ];
  sortable(byId("pairs-table"), columns, rows, (v) => el("tr", {},
    el("th", { scope: "row" }, planned(v.a), el("span", { class: "against", text: " − " }), planned(v.b)),
    numberCell(format(v.difference, decimals), interval(v.low, v.high, decimals)),
    numberCell(format(v.effect, 2), interval(v.effect_low, v.effect_high, 2)),
    numberCell(format(v.improvement, 2), interval(v.improvement_low, v.improvement_high, 2)),
    numberCell(probability(v.p_holm)),
    el("td", { class: "number" }, format(v.detectable, decimals), el("small", { class: "folds", text: neededText(v) })),
    numberCell(format(v.pairs, 0), v.undecided ? `${v.undecided} undecided` : ""),
    el("td", { class: isClear(v) ? "verdict clear" : "verdict" }, foldable(sentence(v)), el("small", { text: v.why }))));
  byId("pairs-table").hidden = !rows.length;
  byId("pairs-note").textContent = pairsNote(rows);
  drawForest(planners, choosePair);
}

/** Crowd draws that would find this difference, and how many there are; breaks at the comma only. */
function neededText({ needed, draws, verdict }) {
  if (isClear({ verdict }) || !Number.isFinite(needed)) return "";
  return [plural(needed, "draw"), `now ${draws}`].map((part) => part.replaceAll(" ", "\u00a0")).join(", ");
}

function sentence({ a, b, verdict }) {
  const [one, other] = [a, b].map((p) => report.planners[p].label);
  return { better: `${one} is better`, worse: `${other} is better` }[verdict] ?? verdict;
}

const isClear = ({ verdict }) => verdict === "better" || verdict === "worse";

function probability(p) {
  if (!Number.isFinite(p)) return "–";
  return p < 0.001 ? "< 0.001" : p.toFixed(3);
}

function pairsNote(rows) {
  if (report.planners.length < 2) return "There is only one planner.";
  if (!rows.length) return "To see comparisons, clear the filters of parameters and seeds, and show at least two planners.";
  const { tests, alpha, level } = report.stats;
  return `Difference: mean over pairs of the same scenario and seed; effect size: the same in standard deviations; in brackets ${level} % intervals. ` +
    "Undefined, censored and failed runs count as far as they are known. " +
    `p: chance of a mean difference at least as large between equal planners, corrected for the ${tests} tests of ${report.stats.family}; a verdict needs ${alpha} or less. ` +
    "All other scores are corrected among themselves. Detectable: the mean difference that this number of draws would find in four cases of five. " +
    "Below it: how many crowd draws you need to find the difference that was seen; where every scenario has a crowd of its own, that many scenarios.";
}

/** All scores of one pair: probability that the first is better, with its interval. */
function drawForest(planners, choosePair) {
  const select = byId("pair");
  select.replaceChildren(...report.stats.pairs.map(([a, b], i) =>
    el("option", { value: i, text: `${report.planners[a].label} against ${report.planners[b].label}` })));
  select.value = state.pair;
  select.onchange = () => choosePair(Number(select.value));
  drawDifferences();
  const box = byId("forest");
  const pair = report.stats.pairs[state.pair];
  const rows = pair ? shownSeries().map((s) => ({ series: s, ...comparisonOf(s, state.pair) }))
    .filter((row) => Number.isFinite(row.improvement)) : [];
  byId("forest-part").hidden = !rows.length;
  if (!rows.length) return;
  const frame = forestFrame(box.clientWidth || 900);
  const { width, left, right, top, step } = frame;
  const bottom = top + step * rows.length;
  const x = scale([0, 1], [left, right], 5);
  const better = report.planners[pair[0]].label;
  const picture = canvas(width, bottom + 42, bottomAxis(x, top - 6, bottom, { value: 0.5 }),
    axisTitle(x, bottom + 36, frame.narrow ? "probability of improvement" : `probability that ${better} does better`));
  picture.append(ahead(pair[1], left + 2, "start", 14), ahead(pair[0], right - 2, "end", frame.narrow ? 30 : 14));
  rows.forEach((row, i) => picture.append(forestRow(row, pair, x, top + step * i, frame)));
  offer(byId("forest-save"), `${report.planners[pair[0]].label}-against-${report.planners[pair[1]].label}`, picture, () => forestRows(rows, pair));
  picture.setAttribute("aria-label", `Probability that ${report.planners[pair[0]].label} does better than ${report.planners[pair[1]].label}, score by score`);
  box.replaceChildren(picture);
}

/** Labels which side of the picture favours which planner. */
function ahead(planner, x, anchor, y) {
  const name = shortened(planner);
  return label(anchor === "end" ? `${name} better →` : `← ${name} better`, x, y, "tick", anchor);
}

/** On narrow screens the names of scores are above their lines. */
function forestFrame(room) {
  const narrow = room < 700;
  const width = narrow ? Math.max(280, room) : 900;
  return narrow ? { narrow, width, left: 12, right: width - 12, top: 48, step: 38 }
    : { narrow, width, left: 290, right: width - 150, top: 30, step: 20 };
}

function forestRows(rows, pair) {
  const head = ["metric", "variant", "a", "b", "probability_a_better", "low", "high", "verdict"];
  return [head, ...rows.map((row) => [report.series[row.series].metric, report.series[row.series].variant,
    ...pair.map((p) => report.planners[p].label), row.improvement, row.improvement_low, row.improvement_high, row.verdict])];
}

function forestRow(row, pair, x, top, { width, narrow }) {
  const series = report.series[row.series];
  const clear = isClear(row);
  const winner = row.verdict === "worse" ? pair[1] : pair[0];
  const name = `${words(series.metric)}${series.variant === "corrected" ? "" : `, ${words(series.variant)}`}`;
  const place = round(x.place(row.improvement));
  const y = top + (narrow ? 26 : 10);
  const group = svg("g", { class: clear ? `p${winner % SHAPES.length}` : "unclear" },
    narrow ? label(linesOf(name, 34, 1)[0], 12, y - 10) : label(name, 280, y + 4, "label", "end"));
  if (Number.isFinite(row.improvement_low)) {
    group.append(svg("line", { class: "whisker", x1: round(x.place(row.improvement_low)), x2: round(x.place(row.improvement_high)), y1: y, y2: y }));
  }
  group.append(clear ? marker(winner, place, y, 4.5, "ringed") : svg("circle", { class: "open", cx: place, cy: y, r: 4 }));
  const text = clear ? sentence({ a: pair[0], b: pair[1], verdict: row.verdict }) : row.verdict;
  group.append(narrow ? label(clear ? text : "", width - 8, y - 10, "label", "end") : label(text, width - 140, y + 4, clear ? "label" : "tick"));
  return group;
}
