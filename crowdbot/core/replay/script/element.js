"use strict";
// Creates elements, and formats numbers.

const byId = (id) => document.getElementById(id);

/** Creates an element; `text` becomes its text, never markup. */
function el(tag, { text, ...attributes } = {}, ...children) {
  const node = document.createElement(tag);
  if (text !== undefined) node.textContent = text;
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) node[name] = value;
    else if (value !== null && value !== undefined && value !== false) {
      node.setAttribute(name, value === true ? "" : value);
    }
  }
  node.append(...children);
  return node;
}

/** Formats a number with its unit, a minus sign and a non-breaking space. */
function withUnit(value, decimals, unit = "") {
  if (!Number.isFinite(value)) return "–";
  const text = value.toFixed(decimals);
  const sign = Number(text) === 0 ? text.replace("-", "") : text.replace("-", "−");
  return unit ? `${sign}\u00a0${unit}` : sign;
}

/** Formats a number with four significant digits. */
function digits(value, unit = "") {
  if (!Number.isFinite(value)) return "–";
  const text = String(Number(value.toPrecision(4))).replace("-", "−");
  return unit ? `${text}\u00a0${unit}` : text;
}

/** Replaces a list of names and values if it changed. */
function writeFacts(list, rows) {
  const content = JSON.stringify(rows);
  if (list.dataset.content === content) return;
  list.dataset.content = content;
  list.replaceChildren(...rows.map(([name, text]) =>
    el("div", {}, el("dt", { text: name }), el("dd", { text }))));
}

const clamp = (value, low, high) => Math.min(high, Math.max(low, value));
