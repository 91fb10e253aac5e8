// The keyboard as a stick: each key is a full deflection.

const AXES = {
  drive: {
    ArrowUp: ["ahead", 1], KeyW: ["ahead", 1], ArrowDown: ["ahead", -1], KeyS: ["ahead", -1],
    ArrowLeft: ["left", 1], KeyA: ["left", 1], ArrowRight: ["left", -1], KeyD: ["left", -1],
    KeyQ: ["aside", 1], KeyE: ["aside", -1],
  },
  walk: {
    ArrowUp: ["ahead", 1], KeyW: ["ahead", 1], ArrowDown: ["ahead", -1], KeyS: ["ahead", -1],
    ArrowLeft: ["left", 1], KeyQ: ["left", 1], ArrowRight: ["left", -1], KeyE: ["left", -1],
    KeyA: ["aside", 1], KeyD: ["aside", -1],
  },
};
const keys = { down: new Set(), axes: AXES[document.documentElement.dataset.mode] };

/** Deflections of the keys that are down. */
function keysNow() {
  const stick = { ahead: 0, left: 0, aside: 0 };
  for (const code of keys.down) stick[keys.axes[code][0]] += keys.axes[code][1];
  for (const axis of Object.keys(stick)) stick[axis] = clamp(stick[axis], -1, 1);
  return stick;
}

/** Listens to the keyboard; `moved` gets the time of each change. */
function listenToKeys(moved, begin) {
  const typing = (target) => target instanceof Element && target.matches("input, select, textarea");
  addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const onButton = event.target instanceof Element && event.target.matches("button, a, summary, select");
    if (event.code === "Enter" && !onButton) begin();
    if (event.code === "Space" && !onButton && !typing(event.target)) {
      event.preventDefault();
      keys.down.clear();
      moved(event.timeStamp);
    }
    if (!keys.axes[event.code] || (typing(event.target) && event.code.startsWith("Arrow"))) return;
    event.preventDefault();
    if (event.repeat || keys.down.has(event.code)) return;
    keys.down.add(event.code);
    moved(event.timeStamp);
  });
  addEventListener("keyup", (event) => {
    if (keys.down.delete(event.code)) moved(event.timeStamp);
  });
}
