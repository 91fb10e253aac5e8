// Saves pictures as SVG, PNG or CSV.

const INLINED = ["fill", "fill-opacity", "stroke", "stroke-width", "stroke-opacity", "stroke-dasharray",
  "stroke-linecap", "paint-order", "font-family", "font-size", "font-weight", "text-anchor"];
const PIXELS = 2; // of a PNG per pixel of the page

/** Adds buttons that save a picture, and its numbers. */
function offer(box, name, picture, rows) {
  const file = `${report.suite}-${name}`.replace(/[^\w.-]+/g, "-");
  const buttons = [
    ["SVG", () => download(new Blob([svgText(picture)], { type: "image/svg+xml" }), `${file}.svg`)],
    ["PNG", () => savePng(picture, `${file}.png`)],
    ["CSV", () => download(new Blob([csvText(rows())], { type: "text/csv" }), `${file}.csv`)],
  ].filter(([kind]) => picture || kind === "CSV");
  box.replaceChildren(...buttons.map(([kind, onclick]) => el("button", {
    type: "button", class: "save", onclick, "aria-label": `Save ${words(name)} as ${kind}`, text: kind,
  })));
}

function download(blob, name) {
  const url = URL.createObjectURL(blob);
  const link = el("a", { href: url, download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

/** Returns a picture without a style sheet: its current style is written into the elements. */
function svgText(picture) {
  const copy = picture.cloneNode(true);
  const [, , width, height] = picture.getAttribute("viewBox").split(" ").map(Number);
  const from = [picture, ...picture.querySelectorAll("*")];
  [copy, ...copy.querySelectorAll("*")].forEach((node, i) => {
    const style = getComputedStyle(from[i]);
    for (const name of INLINED) {
      const value = style.getPropertyValue(name);
      if (value) node.setAttribute(name, value);
    }
    for (const name of ["class", "data-run", "tabindex"]) node.removeAttribute(name);
  });
  for (const link of copy.querySelectorAll("a")) link.replaceWith(...link.childNodes); // relative links break in a saved file
  const paper = getComputedStyle(document.querySelector("section")).backgroundColor;
  copy.prepend(svg("rect", { x: 0, y: 0, width, height, fill: paper }));
  copy.setAttribute("xmlns", SVG);
  copy.setAttribute("width", width);
  copy.setAttribute("height", height);
  return new XMLSerializer().serializeToString(copy);
}

function savePng(picture, name) {
  const [, , width, height] = picture.getAttribute("viewBox").split(" ").map(Number);
  const url = URL.createObjectURL(new Blob([svgText(picture)], { type: "image/svg+xml" }));
  const image = new Image();
  image.onload = () => {
    const paper = el("canvas", { width: Math.round(PIXELS * width), height: Math.round(PIXELS * height) });
    paper.getContext("2d").drawImage(image, 0, 0, paper.width, paper.height);
    URL.revokeObjectURL(url);
    paper.toBlob((blob) => download(blob, name), "image/png");
  };
  image.src = url;
}

/** Formats rows as RFC 4180 CSV; an apostrophe before a text keeps it from being a formula. */
function csvText(rows) {
  const cell = (value) => {
    if (typeof value === "number") return Number.isFinite(value) ? String(Number(value.toPrecision(5))) : "";
    const text = String(value ?? "");
    const safe = /^[=+\-@\t\r]/.test(text) ? `'${text}` : text;
    return /[",\r\n]/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
  };
  return `${rows.map((row) => row.map(cell).join(",")).join("\r\n")}\r\n`;
}
