// What the page says: who drives, why the run waits, speed, goal, latency.

const words = { connected: false, drives: false, taken: false, waits: "preparing", end: null };

const WAITS = {
  "not begun": "The run waits for its start.",
  preparing: "The run is being prepared: people alone, compiled code.",
  paused: "Paused. The run goes on when Pause is released.",
  hidden: "The run waits: the page was hidden.",
  disconnected: "The run waits for its page.",
  silent: "The run waits: the page fell silent.",
};

function bannerText() {
  if (words.end) return `The run has ended: ${words.end.reason}`;
  if (!words.connected) return "Not connected: the stick is centred, and the run waits.";
  if (!words.drives) {
    return words.taken ? "Another page has the seat. You watch." : "The seat is free. You watch; take it to go on.";
  }
  if (words.waits === "not begun") return "Press Start, Enter or a gamepad’s first button.";
  if (words.waits) return WAITS[words.waits] ?? `The run waits: ${words.waits}.`;
  return awayNow() ? "No hand on the stick: click the page to go on." : "";
}

function statusText() {
  if (words.end) return "ended";
  if (!words.connected) return "not connected";
  if (!words.drives) return "watching";
  if (words.waits) return "waiting";
  return awayNow() ? "stick centred" : "in control";
}

const setText = (node, text) => node.textContent === text || (node.textContent = text);

function writeWords() {
  const banner = bannerText();
  byId("banner").hidden = !banner;
  setText(byId("banner"), banner);
  setText(byId("status"), statusText());
  const over = Boolean(words.end);
  byId("begin").hidden = over || !words.drives || words.waits !== "not begun";
  byId("sit").hidden = over || words.drives || words.taken || !words.connected;
  byId("pause").hidden = over || !words.drives || ["not begun", "preparing"].includes(words.waits);
  byId("pause").setAttribute("aria-pressed", String(words.waits === "paused"));
}

function writeReadout(frame) {
  const own = ownBody(frame);
  const goal = shown.run.robots[shown.driven]?.goal;
  const rows = [["time", withUnit(frame.time, 1, "s")]];
  if (own) rows.push(["speed", withUnit(own.v, 2, "m/s")]);
  if (own && goal && shown.walker < 0) rows.push(["to the goal", withUnit(Math.hypot(goal[0] - own.x, goal[1] - own.y), 1, "m")]);
  rows.push(["key to step", withUnit(medianLatency(), 0, "ms")]);
  writeFacts(byId("readout"), rows);
}

function writeControls() {
  const stick = stickNow();
  const rows = [["ahead", withUnit(100 * stick.ahead, 0, "%")], ["turn left", withUnit(100 * stick.left, 0, "%")]];
  if (stick.aside) rows.push(["sideways", withUnit(100 * stick.aside, 0, "%")]);
  rows.push(["gamepad", gamepad.name ? gamepad.name.slice(0, 40) : "none"]);
  writeFacts(byId("facts"), rows);
}
