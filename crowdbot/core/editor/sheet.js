// The drawing: floor, walls, people, items with handles, and what is played.

const state = { text: "", hash: "", data: {}, walls: [], pillars: [], people: [], errors: [], items: [], picked: "", tool: "select", frame: null, draft: null };
const $ = (id) => document.getElementById(id);

function floorOf(data) {
  const area = (data.environment || {}).area;
  return area && Array.isArray(area.x) ? [area.x[0], area.y[0], area.x[1] - area.x[0], area.y[1] - area.y[0]] : null;
}

const isFloor = (points) => JSON.stringify(between(...points)) === JSON.stringify(floorOf(state.data));

function extent() {
  const floor = floorOf(state.data), xs = [], ys = [];
  if (floor) { xs.push(floor[0], floor[0] + floor[2]); ys.push(floor[1], floor[1] + floor[3]); }
  for (const w of state.walls) { xs.push(w[0], w[2]); ys.push(w[1], w[3]); }
  for (const item of state.items) for (const p of item.kind === "person" ? item.points.slice(0, 1) : item.points) { xs.push(p[0]); ys.push(p[1]); }
  if (!xs.length) return [0, 0, 20, 10];
  const [x, y] = [Math.min(...xs), Math.min(...ys)];
  return [x, y, Math.max(Math.max(...xs) - x, 1), Math.max(Math.max(...ys) - y, 1)];
}

function redraw(points = {}) {
  const plan = $("plan"), [x, y, w, h] = extent(), rim = 0.05 * Math.max(w, h) + 0.5;
  plan.setAttribute("viewBox", [x - rim, -(y + h) - rim, w + 2 * rim, h + 2 * rim].join(" "));
  plan.replaceChildren();
  const g = drawn("g", { transform: "scale(1,-1)" }, plan), floor = floorOf(state.data);
  if (floor) rectangle(g, floor, "floor");
  for (const [x1, y1, x2, y2] of state.walls) drawn("line", { x1, y1, x2, y2, class: "solid" }, g);
  for (const [cx, cy, r] of state.pillars) drawn("circle", { cx, cy, r, class: "body" }, g);
  if (!state.frame) for (const [cx, cy, r] of state.people) drawn("circle", { cx, cy, r, class: "person" }, g);
  for (const item of state.items) drawItem(g, item, points[item.key] || item.points);
  if (state.frame) drawFrame(g, state.frame);
  if (state.draft) drawDraft(g, state.draft);
}

function drawItem(g, item, points) {
  const shape = item.draw(g, points);
  shape.classList.add("item");
  shape.dataset.key = item.key;
  if (item.kind === "zone" && isFloor(item.points)) shape.setAttribute("pointer-events", "none");
  drawn("title", {}, shape).textContent = `${item.kind} ${item.name}`;
  if (item.key !== state.picked) return;
  shape.classList.add("picked");
  const size = 0.012 * Math.max(...extent().slice(2));
  if (points.length < 2) return;
  points.forEach((p, k) => {
    const handle = drawn("circle", { cx: p[0], cy: p[1], r: size, class: "handle" }, g);
    handle.dataset.key = item.key;
    handle.dataset.point = k;
  });
}

function drawFrame(g, { people, radius, robots }) {
  people.forEach((p, k) => p && drawn("circle", { cx: p[0], cy: p[1], r: radius[k] || 0.33, class: "person" }, g));
  for (const p of robots) drawn("circle", { cx: p[0], cy: p[1], r: 0.3, class: "robot" }, g);
}

function drawDraft(g, { tool, from, to }) {
  if (tool === "wall") drawn("line", { x1: from[0], y1: from[1], x2: to[0], y2: to[1], class: "draft" }, g);
  else rectangle(g, between(from, to), "draft");
}

function showPicked() {
  const item = state.items.find((one) => one.key === state.picked), form = $("numbers");
  $("what").textContent = item ? `${item.kind} ${item.name}` : "Floor";
  const floor = (state.data.environment || {}).area, area = [...HERE, "environment", "area"];
  const ground = floor && Array.isArray(floor.x) ? [["x", 0, "left"], ["x", 1, "right"], ["y", 0, "bottom"], ["y", 1, "top"]].map(([a, k, n]) => number(n, [...area, a, k], floor[a][k])) : [];
  form.replaceChildren();
  for (const one of item ? item.numbers : ground) {
    const label = document.createElement("label"), input = document.createElement("input");
    label.textContent = one.name;
    Object.assign(input, { type: "number", step: "any", value: one.value, name: one.name, id: `number-${one.path.join("-")}` });
    label.htmlFor = input.id;
    input.addEventListener("change", () => { if (input.value !== "") apply(numbered(one.path, Number(input.value), Boolean(item))); });
    form.append(label, input);
  }
}

// A zone that is the whole floor stays so when the floor's sides change.
function numbered(path, value, isItem) {
  const whole = state.items.find((one) => one.kind === "zone" && isFloor(one.points));
  const follows = !isItem && whole ? [{ path: [...whole.path, ...path.slice(-2)], value }] : [];
  return [{ path, value }, ...follows];
}

function showErrors() {
  const list = $("errors");
  list.replaceChildren();
  for (const one of state.errors) {
    const entry = document.createElement("li"), button = document.createElement("button");
    button.type = "button";
    button.textContent = `${one.line}:${one.column} ${one.code} ${one.message}${one.hint ? `; ${one.hint}` : ""}`;
    button.addEventListener("click", () => goTo(one.line, one.column));
    entry.append(button);
    list.append(entry);
  }
  if (!state.errors.length) list.append(Object.assign(document.createElement("li"), { textContent: "valid" }));
}

function goTo(line, column) {
  const at = state.text.split("\n").slice(0, line - 1).join("\n").length + (line > 1 ? 1 : 0) + column - 1;
  $("text").focus();
  $("text").setSelectionRange(at, at + 1);
}
