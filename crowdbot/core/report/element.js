"use strict";
// Creates elements and markers, and formats numbers.

const byId = (id) => document.getElementById(id);
const SVG = "http://www.w3.org/2000/svg";

/** Creates an HTML element; `text` becomes its text, never markup. */
function el(tag, attributes = {}, ...children) {
  return fill(document.createElement(tag), attributes, children);
}

function svg(tag, attributes = {}, ...children) {
  return fill(document.createElementNS(SVG, tag), attributes, children);
}

function fill(node, { text, ...attributes }, children) {
  if (text !== undefined) node.textContent = text;
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) node[name] = value;
    else if (value !== null && value !== undefined && value !== false) {
      node.setAttribute(name, value === true ? "" : value);
    }
  }
  node.append(...children.flat().filter((c) => c !== null && c !== undefined));
  return node;
}

/** A name that a narrow column may break after its marks, and nowhere else. */
function foldable(name) {
  return name.split(/(?<=[_+-])/).flatMap((part, i) => (i ? [el("wbr"), part] : [part]));
}

const SHAPES = [
  (r) => `M${-r} 0a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0z`,
  (r) => `M${-r * 0.9} ${-r * 0.9}h${1.8 * r}v${1.8 * r}h${-1.8 * r}z`,
  (r) => `M0 ${-1.15 * r}l${1.15 * r} ${2 * r}h${-2.3 * r}z`,
  (r) => `M0 ${-1.3 * r}l${1.2 * r} ${1.3 * r}l${-1.2 * r} ${1.3 * r}l${-1.2 * r} ${-1.3 * r}z`,
  (r) => `M${-r * 0.4} ${-r}h${0.8 * r}v${0.6 * r}h${0.6 * r}v${0.8 * r}h${-0.6 * r}v${0.6 * r}` +
    `h${-0.8 * r}v${-0.6 * r}h${-0.6 * r}v${-0.8 * r}h${0.6 * r}z`,
  (r) => `M0 ${1.15 * r}l${1.15 * r} ${-2 * r}h${-2.3 * r}z`,
];

/** The mark of a planner: colour and shape both identify it. */
function marker(planner, x, y, r, extra = "") {
  return svg("path", {
    class: `mark p${planner % SHAPES.length} ${extra}`,
    d: SHAPES[planner % SHAPES.length](r),
    transform: `translate(${round(x)} ${round(y)})`,
  });
}

/** A marker for running text. */
function badge(planner) {
  const picture = svg("svg", { class: "badge", viewBox: "-7 -7 14 14", "aria-hidden": "true" });
  picture.append(marker(planner, 0, 0, 5));
  return picture;
}

const round = (x) => Math.round(10 * x) / 10;

/** Decimals that show three digits of the largest number, and two of what the numbers differ by. */
function decimalsFor(numbers) {
  const known = numbers.filter(Number.isFinite);
  return decimalsOf(Math.max(0, ...known.map(Math.abs)), known.length ? Math.max(...known) - Math.min(...known) : 0);
}

/** Three digits of a size, and two of a spread that is more than rounding. */
function decimalsOf(size, spread) {
  const power = (x) => Number(x.toExponential().split("e")[1]);
  const places = (x, shown) => (x > 0 && Number.isFinite(x) ? shown - 1 - power(x) : 0);
  const seen = spread > 1e-6 * size ? places(spread, 2) : 0;
  return Math.min(9, Math.max(0, places(Math.max(size, spread), 3), seen));
}

/** Formats with this number of decimals, or two digits instead of zero; very large and very small numbers as powers of ten. */
function format(number, decimals) {
  if (!Number.isFinite(number)) return "–";
  if (number === 0 && decimals > 6) return "0";
  const text = number.toFixed(Math.min(decimals, 12));
  const zero = Number(text) === 0;
  if (zero && Math.abs(number) >= 1e-4 && decimals <= 6) return number.toPrecision(2).replace("-", "−");
  const hidden = number !== 0 && (zero || Math.abs(number) >= 1e6 || decimals > 6);
  return (hidden ? number.toExponential(2) : zero ? text.replace("-", "") : text).replaceAll("-", "−");
}

/** Formats a number with four significant digits. */
function digits(number) {
  if (!Number.isFinite(number)) return "–";
  if (Number.isInteger(number) && Math.abs(number) < 1e6) return String(number).replace("-", "−");
  return String(Number(number.toPrecision(4))).replaceAll("-", "−");
}

const interval = (low, high, decimals) =>
  Number.isFinite(low) ? `[${format(low, decimals)}, ${format(high, decimals)}]` : "";

/** A centre and its interval, the same on every page: `estimate_text.py` has this rule, too. */
function estimateText({ centre, low, high }) {
  const width = Number.isFinite(high - low) ? high - low : NaN;
  const decimals = decimalsOf(Math.abs(centre), width || 0);
  return [format(centre, decimals), Number.isFinite(centre) && Number.isFinite(width) ? interval(low, high, decimals) : ""];
}

/** Copies a text; without the permission it is shown, to be copied by hand. */
async function copyText(text, button) {
  try {
    await navigator.clipboard.writeText(text);
    button.textContent = "copied";
  } catch {
    button.replaceWith(el("code", { text }));
  }
}

const words = (name) => name.replaceAll("_", " ");
const plural = (count, noun) => `${count} ${noun}${count === 1 ? "" : "s"}`;
