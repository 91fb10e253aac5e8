// A gamepad: its left stick drives or walks, its right stick moves sideways or turns the view.

const DEAD = 0.12; // deflection of a stick at rest
const gamepad = { name: "", ahead: 0, left: 0, aside: 0, begin: false };

function deflection(value = 0) {
  const size = Math.abs(value);
  return size < DEAD ? 0 : (Math.sign(value) * (size - DEAD)) / (1 - DEAD);
}

/** Reads the first gamepad that is there; returns the time of a change, or null. */
function readGamepad() {
  const found = [...(navigator.getGamepads?.() ?? [])].find((one) => one?.connected);
  gamepad.name = found?.id ?? "";
  const [x, y, right] = found ? found.axes.map(deflection) : [0, 0, 0];
  const walks = document.documentElement.dataset.mode === "walk";
  const now = { ahead: -y || 0, left: -(walks ? right ?? 0 : x) || 0, aside: -(walks ? x : right ?? 0) || 0 };
  const begin = Boolean(found?.buttons[0]?.pressed || found?.buttons[9]?.pressed);
  const pressed = begin && !gamepad.begin;
  const changed = ["ahead", "left", "aside"].some((axis) => now[axis] !== gamepad[axis]);
  Object.assign(gamepad, now, { begin });
  return { stamp: changed ? performance.now() : null, pressed };
}
