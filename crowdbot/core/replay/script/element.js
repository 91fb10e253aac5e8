"use strict";
// Elements and numbers as text.

const byId = (id) => document.getElementById(id);

/** An element; `text` becomes its text, never markup. */
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

/** A number with its unit, with a minus sign and a space that does not break. */
function withUnit(value, decimals, unit = "") {
  if (!Number.isFinite(value)) return "–";
  const text = value.toFixed(decimals);
  const sign = Number(text) === 0 ? text.replace("-", "") : text.replace("-", "−");
  return unit ? `${sign}\u00a0${unit}` : sign;
}

/** Four significant digits. */
function digits(value, unit = "") {
  if (!Number.isFinite(value)) return "–";
  const text = String(Number(value.toPrecision(4))).replace("-", "−");
  return unit ? `${text}\u00a0${unit}` : text;
}

/** Replaces a list of names and values, where it changed. */
function writeFacts(list, rows) {
  const told = JSON.stringify(rows);
  if (list.dataset.told === told) return;
  list.dataset.told = told;
  list.replaceChildren(...rows.map(([name, text]) =>
    el("div", {}, el("dt", { text: name }), el("dd", { text }))));
}

const clamp = (value, low, high) => Math.min(high, Math.max(low, value));
