// One score by the parameters of the suite: a picture for each, and the numbers in a table.

const PANEL = { height: 226, left: 46, right: 6, top: 24, bottom: 50, least: 212, gap: 18 };

function drawParameters() {
  byId("parameters").hidden = !report.axes.length;
  if (!report.axes.length) return;
  const planners = shownPlanners();
  const panels = report.axes.map((axis, a) => panelRows(axis, a, planners));
  const numbers = panels.flatMap((rows) => rows.flatMap((row) =>
    row.cells.flatMap(({ about }) => (about.ok ? [about.centre, about.low, about.high] : []))));
  const { reference } = report.series[state.series];
  const y = scale(wholeSpan(numbers, reference ? [reference.value] : []), [PANEL.height - PANEL.bottom, PANEL.top], 4);
  const width = panelWidth(byId("panels").clientWidth || 900);
  byId("panels").replaceChildren(...report.axes.map((axis, a) => drawPanel(axis, a, panels[a], { y, width }, planners)));
  drawParameterTable(panels.flat(), planners);
  byId("parameters-note").textContent = parametersNote();
}

/** Results of each planner for each label of an axis; the axis's own filter is ignored. */
function panelRows(axis, a, planners) {
  return axis.labels.map((text, l) => {
    const word = axis.words[l];
    const inside = (run) => report.runs.axes[a][run] === l && matches(run, axis.name);
    const chosen = { ...state.axes, [axis.name]: text };
    const cells = planners.map((planner) => {
      const runs = report.byPlanner[planner].filter(inside);
      return { about: describe(state.series, runs, intervalOf(selectionName(chosen), state.series, planner)), runs };
    });
    return { axis, text, word, l, cells, density: densityOf(cells.flatMap((c) => c.runs)) };
  });
}

/** Least, mean and largest realised density, 1/m². */
function densityOf(runs) {
  const seen = runs.map((run) => report.runs.density[run]).filter((d) => d !== null);
  if (!seen.length) return null;
  return { low: Math.min(...seen), mean: seen.reduce((s, d) => s + d, 0) / seen.length, high: Math.max(...seen) };
}

/** As many panels in a row as there is room for. */
function panelWidth(room) {
  const columns = Math.max(1, Math.floor((room + PANEL.gap) / (PANEL.least + PANEL.gap)));
  return (room - PANEL.gap * (columns - 1)) / columns;
}

function drawPanel(axis, a, rows, { y, width }, planners) {
  const { height, left, right, bottom } = PANEL;
  const x = (l) => left + ((l + 0.5) * (width - left - right)) / rows.length;
  const spread = Math.min(13, (width - left - right) / rows.length / (planners.length + 1));
  const picture = canvas(width, height);
  for (const tick of y.ticks) {
    picture.append(svg("line", { class: "grid", x1: left, x2: width - right, y1: round(y.place(tick)), y2: round(y.place(tick)) }),
      label(y.label(tick), left - 7, y.place(tick) + 4, "tick", "end"));
  }
  const { reference } = report.series[state.series];
  if (reference && reference.value >= y.low && reference.value <= y.high) {
    picture.append(svg("line", { class: "reference", x1: left, x2: width - right, y1: round(y.place(reference.value)), y2: round(y.place(reference.value)) }));
  }
  picture.append(label(linesOf(measureOf(report.series[state.series]), 34, 1)[0], 2, 12, "axis"));
  const letters = Math.max(5, Math.floor((width - left - right) / rows.length / 6.2));
  const fits = rows.every((row) => !linesOf(row.word, letters, 2).some((line) => line.endsWith("…")));
  rows.forEach((row, l) => linesOf(fits ? row.word : row.text, letters, 2).forEach((text, n) =>
    picture.append(label(text, x(l), height - bottom + 16 + 13 * n, "label", "middle"))));
  picture.append(label(axis.title, left + (width - left - right) / 2, height - 6, "axis", "middle"));
  planners.forEach((planner, i) => {
    const place = (l) => x(l) + (i - (planners.length - 1) / 2) * spread;
    picture.append(trend(planner, rows.map((row) => row.cells[i]), place, y));
  });
  picture.setAttribute("aria-label", `${axis.title}: the numbers are in the table below`);
  const effects = axisEffectText(a, planners);
  const save = el("span", { class: "saves" });
  const series = report.series[state.series];
  offer(save, `${series.metric}-${series.variant}-by-${axis.name}`, picture, () => parameterRows(rows, planners));
  return el("figure", { class: state.axes[axis.name] ? "panel filtered" : "panel" },
    el("figcaption", {}, el("b", { text: axis.title }), el("span", { class: "effects" }, effects)), picture, save);
}

function trend(planner, cells, place, y) {
  const kind = `p${planner % SHAPES.length}`;
  const group = svg("g", { class: kind });
  const inside = (v) => round(Math.min(y.place(y.low), Math.max(y.place(y.high), y.place(v))));
  const points = cells.map(({ about }, l) => (Number.isFinite(about.centre) ? [round(place(l)), inside(about.centre)] : null));
  const path = points.map((p, l) => (p ? `${points[l - 1] ? "L" : "M"}${p[0]} ${p[1]}` : "")).join("");
  group.append(svg("path", { class: `trend ${kind}`, d: path || "M0 0" }));
  cells.forEach(({ about }, l) => {
    if (Number.isFinite(about.low)) {
      group.append(svg("line", { class: "whisker", x1: round(place(l)), x2: round(place(l)), y1: inside(about.low), y2: inside(about.high) }));
    }
    if (Number.isFinite(about.centre)) group.append(marker(planner, place(l), inside(about.centre), 4.5, "ringed"));
  });
  return group;
}

/** The numbers of one picture. */
function parameterRows(rows, planners) {
  const head = ["parameter", "label", "value", "planner", "centre", "low", "high", "q1", "q3", "runs", "with_value"];
  return [head, ...rows.flatMap((row) => row.cells.map(({ about }, i) => [row.axis.title, row.text, row.word,
    report.planners[planners[i]].label, about.centre, about.low, about.high, about.q1, about.q3, String(about.runs), String(about.ok)]))];
}

/** Share of variance that each parameter explains, for each planner, from all runs. */
function axisEffectText(a, planners) {
  return planners.map((planner) => [planner, effectOf(a, state.series, planner)])
    .filter(([, share]) => Number.isFinite(share))
    .map(([planner, share]) => el("span", { class: "effect" }, badge(planner), `${Math.round(100 * share)} %`));
}

function drawParameterTable(rows, planners) {
  const columns = [
    { text: "parameter", key: (row) => row.axis.title },
    { text: "value", key: (row) => row.word },
    { text: "people per m², realised", numeric: true, key: (row) => row.density?.mean },
    ...planners.map((p, i) => ({ node: planned(p), numeric: true, key: (row) => row.cells[i].about.centre })),
  ];
  sortable(byId("parameters-table"), columns, rows, (row) => el("tr", {},
    el("th", { scope: "row", text: row.axis.title }), el("td", { text: wordAndLabel(row.axis, row.l) }),
    row.density ? numberCell(format(row.density.mean, 3), interval(row.density.low, row.density.high, 3)) : numberCell("–"),
    row.cells.map(({ about }) => centreCell(about, report.series[state.series]))));
}

function parametersNote() {
  const other = Object.values(state.axes).some(Boolean) || state.seed;
  const set = other ? "The other parameters are filtered as above. " : "";
  const effects = report.axes.length ? "Percentages: share of the variance between runs explained by the parameter (η²), always over all runs. " : "";
  return `${centreWord(report.series[state.series])} with ${report.stats.level} % intervals where they are computed, else quartiles in italics. ${set}${effects}${densityText()}` +
    "Realised density: mean over the runs, and in brackets the least and the largest.";
}

/** Share of variance explained by the realised density of the crowds. */
function densityText() {
  const shares = shownPlanners().map((p) => [p, effectOf(report.axes.length, state.series, p)])
    .filter(([, share]) => Number.isFinite(share))
    .map(([p, share]) => `${report.planners[p].label} ${Math.round(100 * share)} %`);
  return shares.length ? `With the realised density as a straight line (r²): ${shares.join(", ")}. ` : "";
}
