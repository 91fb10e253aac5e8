"use strict";
// Numbers of the plan: metres, rounded to a decimetre, and elements of SVG.

const SVG = "http://www.w3.org/2000/svg";
const snapped = (value) => Math.round(value * 10) / 10;
const clamped = (value, low, high) => Math.min(Math.max(value, low), high);

function drawn(tag, attributes, parent) {
  const element = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  if (parent) parent.append(element);
  return element;
}

// Place of a pointer on the floor, m.
function placeOf(event, plan) {
  const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(plan.getScreenCTM().inverse());
  return [at.x, -at.y];
}

// x, y, width and height of the rectangle between two places.
function between(a, b) {
  return [Math.min(a[0], b[0]), Math.min(a[1], b[1]), Math.abs(a[0] - b[0]), Math.abs(a[1] - b[1])];
}

const areaOf = ([x, y, w, h]) => ({
  centre: [snapped(x + w / 2), snapped(y + h / 2)], size: [Math.max(snapped(w), 0.5), Math.max(snapped(h), 0.5)],
});
const boxOf = ([x, y, w, h]) => ({
  x: [snapped(x), snapped(x + Math.max(w, 0.5))], y: [snapped(y), snapped(y + Math.max(h, 0.5))],
});
