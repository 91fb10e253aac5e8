"use strict";

// Sorts the rows of a table by the column whose button is pressed; a second press reverses the order.
// Cells without a value stay last, and equal ones stay in the order of the ranks.
for (const table of document.querySelectorAll("table.sortable")) {
  const body = table.tBodies[0];
  const rows = [...body.rows];
  const heads = [...table.tHead.rows[0].cells];

  const keyOf = (row, column) => {
    const text = row.cells[column].dataset.value;
    const number = Number(text);
    return text !== "" && Number.isFinite(number) ? number : text;
  };

  const compare = (a, b) => {
    if (a === "" || b === "") return (a === "") - (b === "");
    if (typeof a === "number" && typeof b === "number") return a - b;
    return String(a).localeCompare(String(b));
  };

  const sortBy = (column) => {
    const head = heads[column];
    const falling = head.getAttribute("aria-sort") === "ascending";
    for (const other of heads) other.removeAttribute("aria-sort");
    head.setAttribute("aria-sort", falling ? "descending" : "ascending");
    const sorted = [...rows].sort((x, y) => {
      const [a, b] = [keyOf(x, column), keyOf(y, column)];
      const missing = a === "" || b === "";
      return falling && !missing ? compare(b, a) : compare(a, b);
    });
    body.append(...sorted);
  };

  heads.forEach((head, column) => {
    head.querySelector("button").addEventListener("click", () => sortBy(column));
  });
}
