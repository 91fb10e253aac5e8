// Drag with one pointer, pinch with two, zoom with the wheel, and click.

const STILL = 4; // px that a click may move

function pointers(canvas, { drag, pinch, at, click }) {
  const down = new Map();
  let moved = 0;
  const spread = () => {
    const [a, b] = [...down.values()];
    return Math.hypot(a.x - b.x, a.y - b.y) || 1;
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    moved = down.size ? STILL + 1 : 0;
    down.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
    at?.(event.offsetX, event.offsetY);
  });
  canvas.addEventListener("pointermove", (event) => {
    const old = down.get(event.pointerId);
    if (!old) return;
    const apart = down.size === 2 ? spread() : 0;
    down.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
    at?.(event.offsetX, event.offsetY);
    moved += Math.hypot(event.offsetX - old.x, event.offsetY - old.y);
    if (apart) pinch?.(apart / spread());
    else if (moved > STILL) drag?.(event.offsetX - old.x, event.offsetY - old.y);
  });
  canvas.addEventListener("pointerup", (event) => {
    if (down.delete(event.pointerId) && moved <= STILL) click?.(event.offsetX, event.offsetY);
  });
  canvas.addEventListener("pointercancel", (event) => down.delete(event.pointerId));
  if (pinch) {
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      pinch(Math.exp(Math.sign(event.deltaY) * 0.15));
    }, { passive: false });
  }
}

function toWorld(view, x, y) {
  return [view.x + (x - widthOf(view) / 2) / view.scale, view.y - (y - heightOf(view) / 2) / view.scale];
}
