// Filters: the controls, their state in the address, and the runs selected.

const state = {
  axes: {}, seed: "", category: "", variant: "headline", hidden: new Set(),
  series: 0, chart: "strip", pair: 0, theme: "", order: "category", sort: "name",
};
const HEADLINE = "headline";

/** Builds the controls for the axes of the suite. */
function buildFilters(onchange) {
  const box = byId("filters");
  for (const axis of report.axes) {
    const options = [["", "all"], ...axis.labels.map((name, l) => [name, wordAndLabel(axis, l)])];
    box.append(choice(`axis-${axis.name}`, axis.title, options, (v) => {
      state.axes[axis.name] = v;
      onchange();
    }));
  }
  const seeds = report.seeds.map((s) => [String(s), String(s)]);
  const simple = (name, options) => choice(name, name, options, (v) => {
    state[name] = v;
    onchange();
  });
  if (seeds.length > 1) box.append(simple("seed", [["", "all"], ...seeds]));
  const categories = [...new Set(report.series.map((s) => s.category))];
  box.append(simple("category", [["", "all"], ...categories.map((c) => [c, c])]));
  const variants = [HEADLINE, "corrected", "literal", "all"].map((v) => [v, v]);
  box.append(simple("variant", variants));
  box.append(plannerChips(onchange));
  byId("clear").onclick = () => {
    Object.assign(state, { axes: {}, seed: "", category: "", variant: HEADLINE });
    state.hidden.clear();
    onchange();
  };
}

function choice(id, name, options, onpick) {
  const select = el("select", { id, onchange: (event) => onpick(event.target.value) },
    options.map(([value, text]) => el("option", { value, text })));
  return el("label", { class: "field" }, el("span", { text: name }), select);
}

function plannerChips(onchange) {
  const chips = report.planners.map((planner, p) => el("button", {
    type: "button", class: "chip", id: `planner-${p}`, "aria-pressed": "true",
    onclick: () => {
      if (!state.hidden.delete(p)) state.hidden.add(p);
      onchange();
    },
  }, badge(p), el("span", { text: planner.label })));
  return el("div", { class: "field chips", role: "group", "aria-label": "Planners" },
    el("span", { text: "planners" }), el("div", {}, chips));
}

/** Updates the controls from the state. */
function showFilters() {
  for (const axis of report.axes) byId(`axis-${axis.name}`).value = state.axes[axis.name] || "";
  for (const name of ["seed", "category", "variant"]) {
    if (byId(name)) byId(name).value = state[name];
  }
  report.planners.forEach((_, p) =>
    byId(`planner-${p}`).setAttribute("aria-pressed", String(!state.hidden.has(p))));
  const shown = shownPlanners().reduce((sum, p) => sum + selectedRuns(p).length, 0);
  const text = filterText();
  byId("shown").textContent = `${shown} of ${plural(report.runs.count, "run")}`;
  byId("filter-text").textContent = text ? `Only ${text}.` : "All runs.";
  byId("clear").disabled = !text && state.variant === HEADLINE;
}

function filterText() {
  const parts = report.axes.filter((a) => state.axes[a.name])
    .map((a) => `${a.title} = ${wordOf(a, state.axes[a.name])}`);
  if (state.seed) parts.push(`seed = ${state.seed}`);
  if (state.category) parts.push(`category ${state.category}`);
  if (state.variant !== HEADLINE) parts.push(`variants: ${state.variant}`);
  if (state.hidden.size) {
    parts.push(`planners ${shownPlanners().map((p) => report.planners[p].label).join(", ")}`);
  }
  return parts.join("; ");
}

/** Planners that are not hidden, by name or the best in the chosen score first. */
function shownPlanners() {
  const shown = report.planners.map((_, p) => p).filter((p) => !state.hidden.has(p));
  if (state.sort !== "value" || !report.series.length) return shown;
  const bad = new Map(shown.map((p) => {
    const about = describeSelected(state.series, p);
    return [p, Number.isFinite(about.centre) ? badness(state.series, { status: "ok", value: about.centre }) : Infinity];
  }));
  return shown.sort((a, b) => (bad.get(a) === bad.get(b) ? a - b : bad.get(a) - bad.get(b)));
}

function matches(run, but = "") {
  return report.axes.every((axis, a) => {
    const wanted = axis.name === but ? "" : state.axes[axis.name];
    return !wanted || axis.labels[report.runs.axes[a][run]] === wanted;
  }) && (!state.seed || String(report.runs.seed[run]) === state.seed);
}

const selectedRuns = (planner) => report.byPlanner[planner].filter((run) => matches(run));

/** Name of the current selection if Python has computed its intervals; null otherwise. */
function selectionName(axes = state.axes) {
  const set = report.axes.map((a) => a.name).filter((name) => axes[name]);
  if (state.seed || set.length > 1) return null;
  return set.length ? `${set[0]}=${axes[set[0]]}` : "";
}

/** Indices of the series selected by category and variant. */
function shownSeries() {
  return report.series.map((_, s) => s).filter((s) => {
    const series = report.series[s];
    if (state.category && series.category !== state.category) return false;
    if (state.variant === HEADLINE) return series.headline;
    if (state.variant === "corrected") return series.plain;
    return state.variant === "all" || series.variant === "literal";
  });
}

function writeAddress() {
  const query = new URLSearchParams();
  for (const [name, value] of Object.entries(state.axes)) if (value) query.set(`axis.${name}`, value);
  for (const name of ["seed", "category", "theme"]) if (state[name]) query.set(name, state[name]);
  if (state.variant !== HEADLINE) query.set("variant", state.variant);
  if (state.chart !== "strip") query.set("chart", state.chart);
  if (state.order !== "category") query.set("order", state.order);
  if (state.sort !== "name") query.set("sort", state.sort);
  if (state.hidden.size) query.set("planners", shownPlanners().sort((a, b) => a - b).join("."));
  const series = report.series[state.series];
  if (series && state.series !== report.first) query.set("score", `${series.metric}.${series.variant}`);
  if (state.pair) query.set("pair", state.pair);
  const text = query.toString();
  if (location.hash.slice(1) !== text) {
    history.replaceState(null, "", `${location.href.split("#")[0]}${text && "#"}${text}`);
  }
}

/** Restores the state from the address; ignores values that this report does not have. */
function readAddress() {
  const query = new URLSearchParams(location.hash.slice(1));
  const has = (id, value) => [...(byId(id)?.options ?? [])].some((o) => o.value === value);
  state.axes = {};
  for (const { name } of report.axes) {
    const value = query.get(`axis.${name}`);
    if (value && has(`axis-${name}`, value)) state.axes[name] = value;
  }
  for (const name of ["seed", "category", "variant"]) {
    const wanted = query.get(name) ?? "";
    state[name] = has(name, wanted) ? wanted : name === "variant" ? HEADLINE : "";
  }
  state.chart = query.get("chart") === "ecdf" ? "ecdf" : "strip";
  state.order = ["metric", "evidence"].includes(query.get("order")) ? query.get("order") : "category";
  state.sort = query.get("sort") === "value" ? "value" : "name";
  state.theme = ["light", "dark"].includes(query.get("theme")) ? query.get("theme") : "";
  const shown = query.get("planners")?.split(".").map(Number);
  const hidden = report.planners.map((_, p) => p).filter((p) => shown && !shown.includes(p));
  state.hidden = new Set(hidden);
  const series = report.series.findIndex((s) => `${s.metric}.${s.variant}` === query.get("score"));
  state.series = series < 0 ? report.first : series;
  const pair = Number(query.get("pair"));
  state.pair = report.stats.pairs[pair] ? pair : 0;
}
