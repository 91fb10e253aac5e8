// Marks of runs in pictures: each has a tooltip, and opens its replay at its worst moment.

/** Address of a run's replay at its worst moment, with the link back to this page. */
function replayAt(run, beside = null) {
  const [page, moment] = [report.runs.replay[run], report.runs.moment[run]];
  if (!page) return page;
  const options = [
    ...(moment ? [["t", moment[0]]] : []),
    ...(beside ? [["with", seenFrom(page, beside)]] : []),
    ["report", seenFrom(page, location.pathname.replace(/.*\//, ""))],
  ];
  return `${page}#${options.map(([name, value]) => `${name}=${encodeURI(value).replace(/[&#+]/g, encodeURIComponent)}`).join("&")}`;
}

/** An address relative to a page, where both are relative to this one. */
function seenFrom(page, address) {
  const [from, to] = [page.split("/").slice(0, -1), address.split("/")];
  while (from.length && to.length > 1 && from[0] === to[0]) {
    from.shift();
    to.shift();
  }
  if (!from.includes("..")) return [...from.map(() => ".."), ...to].join("/");
  const here = decodeURI(location.pathname).split("/").slice(0, -1); // folders on the way down have names
  const down = from.reduce((names, part) => (part === ".." ? names : [...names, ".."]), []);
  return [...down, ...here.slice(here.length - from.filter((part) => part === "..").length), ...to].join("/");
}

/** A mark of a run; a link where it has a replay. Tables list the same links for the keyboard. */
function dotOf(run, mark) {
  mark.classList.add("dot");
  mark.dataset.run = run;
  const address = replayAt(run);
  return address ? svg("a", { href: address, tabindex: -1, "aria-label": runText(run) }, mark) : mark;
}

function runText(run) {
  const { scenario, planner, seed, status } = attemptOf(run);
  return `${scenario}, ${report.planners[planner].label}, seed ${seed}: ${words(status)}`;
}

/** Shows a tooltip while the pointer is over a dot. */
function buildDots() {
  const tip = byId("tip");
  const close = () => { tip.hidden = true; };
  document.addEventListener("pointerover", (event) => {
    const dot = event.target.closest?.(".dot");
    if (!dot) return close();
    tip.replaceChildren(...tipOf(Number(dot.dataset.run)));
    tip.hidden = false;
    return placeCard(tip, dot);
  });
  document.addEventListener("scroll", close, { passive: true });
}

function tipOf(run) {
  const { scenario, planner, seed, status, time } = attemptOf(run);
  const moment = report.runs.moment[run];
  const score = scoreOf(state.series, run);
  const value = score.status === "ok" ? digits(score.value) : valueText(score, 3);
  return [
    el("b", { text: scenario }),
    el("div", {}, planned(planner), ` · seed ${seed} · ${words(status)}`, time === null ? "" : ` after ${format(time, 1)} s`),
    el("div", { text: `${measureOf(report.series[state.series])}: ${value}` }),
    el("div", { class: "muted", text: !report.runs.replay[run] ? "no replay"
      : moment ? `opens at ${format(moment[0], 1)} s: ${moment[1]}` : "opens its replay" }),
  ];
}
