// Canvases that fit their boxes.

/** Fits the canvas to its box, or to a given size; returns a context in CSS pixels. */
function prepareCanvas({ canvas, size }) {
  const ratio = size ? size.ratio : window.devicePixelRatio || 1;
  const width = size ? size.width : canvas.clientWidth;
  const height = size ? size.height : canvas.clientHeight;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const g = canvas.getContext("2d");
  g.setTransform(ratio, 0, 0, ratio, 0, 0);
  return { g, width, height };
}

const widthOf = ({ canvas, size }) => (size ? size.width : canvas.clientWidth);
const heightOf = ({ canvas, size }) => (size ? size.height : canvas.clientHeight);
