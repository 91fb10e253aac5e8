// Tables that sort by their headers.

/**
 * Makes the headers of a table sort it.
 *
 * `columns`: {text, key, numeric}; `key(row)` is what a row is sorted by, and a column without it
 * does not sort. `drawRow(row)` gives the row's element.
 */
function sortable(table, columns, rows, drawRow, sorted = { column: -1, up: true }) {
  const show = () => {
    const { column, up } = sorted;
    const order = column < 0 ? rows : [...rows].sort(comparing(columns[column].key, up));
    table.tBodies[0].replaceChildren(...order.map(drawRow));
    [...table.tHead.rows[0].cells].forEach((cell, c) => {
      if (!columns[c].key) return;
      cell.setAttribute("aria-sort", c !== column ? "none" : up ? "ascending" : "descending");
    });
  };
  const head = columns.map((column, c) => headerCell(column, () => {
    Object.assign(sorted, { column: c, up: sorted.column === c ? !sorted.up : true });
    show();
  }));
  table.replaceChildren(table.caption ?? "", el("thead", {}, el("tr", {}, head)), el("tbody"));
  show();
}

function headerCell({ text, node, key, numeric, kind: own }, onclick) {
  const inside = [node ?? text].flat();
  const kind = numeric ? "number" : own;
  if (!key) return el("th", { scope: "col", class: kind }, inside);
  return el("th", { scope: "col", class: kind, "aria-sort": "none" },
    el("button", { type: "button", class: "sort", onclick }, inside));
}

/** Compares numbers by size and other values as text; missing values come last in either direction. */
function comparing(key, up) {
  return (a, b) => {
    const [x, y] = [key(a), key(b)];
    const missing = (v) => v === null || v === undefined || Number.isNaN(v);
    if (missing(x) || missing(y)) return missing(x) - missing(y);
    const order = typeof x === "number" ? x - y : String(x).localeCompare(String(y), "en", { numeric: true });
    return up ? order : -order;
  };
}

function numberCell(text, more) {
  return el("td", { class: "number" }, text, more ? el("small", { text: more }) : null);
}

/** Hatched boxes with the counts of runs without a value; empty if there are none. */
function missingChips(about) {
  return WITHOUT_VALUE.filter(([kind]) => about[kind]).map(([kind, name]) =>
    el("span", { class: "missing", title: `${about[kind]} of ${about.runs} runs ${name}` },
      el("i", { class: kind, "aria-hidden": "true" }), `${about[kind]} ${name}`));
}

/** A planner's mark and name. */
function planned(planner) {
  return el("span", { class: "planner" }, badge(planner), el("span", {}, foldable(report.planners[planner].label)));
}
