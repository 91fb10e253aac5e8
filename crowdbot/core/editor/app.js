// Pointer, keyboard and buttons.

let drag = null;
let wait = 0;

function choose(tool) {
  state.tool = tool;
  for (const button of $("tools").children) button.setAttribute("aria-pressed", String(button.id === `tool-${tool}`));
  say(TOOLS[tool][1]);
}

function pick(chosen) {
  state.picked = chosen;
  redraw();
  showPicked();
}

function down(event) {
  const at = placeOf(event, $("plan")), target = event.target.dataset || {};
  $("plan").focus();
  if (state.tool !== "select") {
    if (DRAGGED.includes(state.tool)) { drag = { tool: state.tool, from: at.map(snapped) }; $("plan").setPointerCapture(event.pointerId); }
    else add(state.tool, at);
    return;
  }
  const item = state.items.find((one) => one.key === target.key);
  pick(item ? item.key : "");
  if (!item) return;
  drag = { item, from: at, point: target.point === undefined ? null : Number(target.point), points: item.points };
  $("plan").setPointerCapture(event.pointerId);
}

function dragged(at) {
  const { item, from, point } = drag, by = [at[0] - from[0], at[1] - from[1]];
  const moves = (k) => (point === null ? k === 0 || !item.alone : k === point);
  return item.points.map((p, k) => (moves(k) ? [snapped(p[0] + by[0]), snapped(p[1] + by[1])] : p));
}

function move(event) {
  if (!drag) return;
  const at = placeOf(event, $("plan"));
  if (drag.tool) { state.draft = { tool: drag.tool, from: drag.from, to: at.map(snapped) }; redraw(); return; }
  drag.points = dragged(at);
  redraw({ [drag.item.key]: drag.points });
}

function up(event) {
  const was = drag, at = placeOf(event, $("plan"));
  drag = null;
  state.draft = null;
  if (!was) return;
  if (was.tool) {
    if (Math.hypot(at[0] - was.from[0], at[1] - was.from[1]) > 0.2) add(was.tool, was.from, at);
    else redraw();
    return;
  }
  if (JSON.stringify(was.points) !== JSON.stringify(was.item.points)) apply(was.item.moved(was.points));
}

function nudge(dx, dy, far) {
  const item = state.items.find((one) => one.key === state.picked);
  if (!item) return;
  const by = far ? 1 : 0.1;
  apply(item.moved(item.points.map((p, k) => (k === 0 || !item.alone ? [snapped(p[0] + dx * by), snapped(p[1] + dy * by)] : p))));
}

const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

function pressed(event) {
  const command = event.ctrlKey || event.metaKey, letter = event.key.toLowerCase();
  if (command && letter === "s") { event.preventDefault(); save(); return; }
  if (["TEXTAREA", "INPUT"].includes(event.target.tagName)) return;
  if (command && letter === "z") { event.preventDefault(); event.shiftKey ? step(future, past) : step(past, future); return; }
  if (command && letter === "y") { event.preventDefault(); step(future, past); return; }
  if (command) return;
  const tool = Object.keys(TOOLS).find((name) => TOOLS[name][0] === letter);
  if (event.key in ARROWS) { event.preventDefault(); nudge(...ARROWS[event.key], event.shiftKey); }
  else if (event.key === "Delete" || event.key === "Backspace") remove();
  else if (event.key === "Escape") { choose("select"); pick(""); }
  else if (event.key === " " && event.target.tagName !== "BUTTON") { event.preventDefault(); play(); }
  else if (event.key === "Tab" && event.target.id === "plan" && state.items.length && !event.shiftKey) {
    const at = state.items.findIndex((one) => one.key === state.picked);
    if (at + 1 < state.items.length) { event.preventDefault(); pick(state.items[at + 1].key); }
  } else if (tool) choose(tool);
}

for (const [name, [letter, title]] of Object.entries(TOOLS)) {
  const button = Object.assign(document.createElement("button"), { type: "button", id: `tool-${name}`, textContent: name, title: `${title} (${letter})` });
  button.addEventListener("click", () => choose(name));
  $("tools").append(button);
}
choose("select");
$("plan").addEventListener("pointerdown", down);
$("plan").addEventListener("pointermove", move);
$("plan").addEventListener("pointerup", up);
document.addEventListener("keydown", pressed);
$("numbers").addEventListener("submit", (event) => event.preventDefault());
$("text").addEventListener("input", () => { clearTimeout(wait); wait = setTimeout(typed, 400); });
$("undo").addEventListener("click", () => step(past, future));
$("redo").addEventListener("click", () => step(future, past));
$("play").addEventListener("click", play);
$("save").addEventListener("click", () => save());
$("theirs").addEventListener("click", () => { $("conflict").close(); remember(state.text); load(); });
$("mine").addEventListener("click", () => { $("conflict").close(); save(true); });
$("later").addEventListener("click", () => $("conflict").close());
window.addEventListener("beforeunload", (event) => { if (unsaved()) event.preventDefault(); });
load().catch((error) => say(error.message));
