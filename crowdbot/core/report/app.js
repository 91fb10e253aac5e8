// Builds the page and keeps it up to date.

function start() {
  buildFilters(changed);
  buildCards();
  buildDots();
  readAddress();
  buildScorePick();
  for (const name of ["strip", "ecdf"]) {
    byId(`chart-${name}`).onclick = () => update({ chart: name });
  }
  byId("order").onchange = (event) => update({ order: event.target.value });
  byId("planner-order").onchange = (event) => update({ sort: event.target.value });
  byId("failed-more").onclick = () => {
    failedShown *= 4;
    drawExplorer();
  };
  byId("worst-more").onclick = () => {
    worstShown *= 2;
    drawExplorer();
  };
  byId("differences-more").onclick = () => {
    differencesShown *= 2;
    drawDifferences();
  };
  byId("methods-copy").onclick = (event) => copyText(byId("methods").textContent, event.target);
  byId("theme").onclick = switchTheme;
  for (const name of document.querySelectorAll("[data-planner]")) {
    name.lastElementChild.replaceChildren(...foldable(name.textContent));
    name.prepend(badge(Number(name.dataset.planner)));
  }
  for (const link of document.querySelectorAll("a[data-to]")) {
    link.onclick = (event) => {
      event.preventDefault(); // the address keeps the filters
      goTo(byId(link.dataset.to));
    };
  }
  addEventListener("hashchange", () => {
    readAddress();
    draw();
  });
  let width = innerWidth;
  addEventListener("resize", () => {
    if (innerWidth !== width) {
      drawChosen();
      reachWideTables();
    }
    width = innerWidth;
  });
  addEventListener("beforeprint", () => openDetails(true));
  addEventListener("afterprint", () => openDetails(false));
  draw();
  document.documentElement.dataset.ready = performance.now().toFixed(0);
}

function changed() {
  worstShown = WORST;
  failedShown = FAILED;
  differencesShown = DIFFERENCES;
  draw();
}

function update(change) {
  Object.assign(state, change);
  changed();
}

function draw() {
  applyTheme();
  showFilters();
  byId("order").value = state.order;
  byId("planner-order").value = state.sort;
  byId("score-pick").value = state.series;
  drawScores(chooseScore);
  drawChosen();
  reachWideTables();
  writeAddress();
}

/** Lets keyboard users scroll content that is wider than the page. */
function reachWideTables() {
  for (const box of document.querySelectorAll(".wide")) {
    const wide = box.scrollWidth > box.clientWidth + 1;
    const about = { tabindex: "0", role: "region", "aria-label": box.querySelector("caption")?.textContent ?? "table" };
    for (const [name, value] of Object.entries(about)) {
      if (wide) box.setAttribute(name, value);
      else box.removeAttribute(name);
    }
  }
}

function drawChosen() {
  const bare = !report.series.length;
  for (const id of ["scores", "one-score", "against", "worst-part"]) byId(id).hidden = bare;
  if (bare) return drawFailed();
  const series = report.series[state.series];
  const [arrow, meaning] = ARROWS[series.better];
  byId("chosen").replaceChildren(
    el("button", { type: "button", class: "metric", "data-card": state.series, text: words(series.metric) }),
    el("span", { class: "variant", text: words(series.variant) }),
    el("span", { class: "about" }, el("i", { text: series.symbol }), series.unit === "1" ? "" : ` in ${series.unit}`,
      arrow ? ` · ${arrow} ${meaning}` : ""));
  drawDistribution();
  drawParameters();
  drawPairs((pair) => update({ pair }));
  return drawExplorer();
}

function chooseScore(series) {
  update({ series });
  goTo(byId("one-score"));
}

function goTo(section) {
  section.scrollIntoView({ block: "start" });
  section.focus({ preventScroll: true });
}

function buildScorePick() {
  const groups = new Map();
  report.series.forEach(({ category }, s) => groups.set(category, [...(groups.get(category) ?? []), s]));
  byId("score-pick").append(...[...groups].map(([category, list]) => el("optgroup", { label: category },
    list.map((s) => el("option", { value: s, text: `${words(report.series[s].metric)}, ${words(report.series[s].variant)}` })))));
  byId("score-pick").onchange = (event) => update({ series: Number(event.target.value) });
}

function switchTheme() {
  const dark = state.theme ? state.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  state.theme = dark ? "light" : "dark";
  applyTheme();
  writeAddress();
}

function applyTheme() {
  if (state.theme) document.documentElement.dataset.theme = state.theme;
  else delete document.documentElement.dataset.theme;
}

/** Opens folded parts for printing. */
function openDetails(open) {
  for (const details of document.querySelectorAll("details:not([data-screen])")) {
    if (open && !details.open) details.dataset.closed = "";
    if (open) details.open = true;
    else if ("closed" in details.dataset) details.open = false;
    if (!open) delete details.dataset.closed;
  }
}

decode().then(start).catch((error) => {
  byId("failure").hidden = false;
  byId("failure").textContent = `The report cannot be shown: ${error.message}`;
});
