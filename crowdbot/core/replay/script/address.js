// The view is stored in the address: #t= and all settings that differ from the defaults.

const SWITCHES = ["lidar", "sonar", "thoughts", "trails", "ghost"];
const ON_AT_FIRST = { lidar: true, sonar: true, thoughts: true, trails: false, ghost: true };
let addressDue = 0;

const fragment = () => new URLSearchParams(location.hash.slice(1));

/** Restores the view from the address. */
function readAddress() {
  const fields = fragment();
  if (fields.has("t")) state.time = clamp(Number(fields.get("t")) || shown.first, shown.first, shown.last);
  const span = Number(fields.get("span"));
  if (span > 0) state.span = clamp(span, 2, widest());
  for (const name of SWITCHES) if (fields.has(name)) state[name] = fields.get(name) !== "0";
  state.plots = new Set((fields.get("plot") ?? "").split(",").filter(Boolean).map(decodeURIComponent));
  if (VIEWS.includes(fields.get("view"))) state.view = fields.get("view");
  if (fields.has("follow")) state.follow = fields.get("follow") === "0" ? "" : fields.get("follow");
  const [x, y] = ["x", "y"].map((name) => Number.parseFloat(fields.get(name)));
  if (Number.isFinite(x) && Number.isFinite(y)) state.middle = { x, y };
  setTheme(["light", "dark"].includes(fields.get("theme")) ? fields.get("theme") : "");
}

/** Returns the address of the current view. */
function addressNow() {
  const fields = fragment();
  const put = (name, value) => (value === null ? fields.delete(name) : fields.set(name, value));
  put("t", state.time.toFixed(2));
  put("span", Math.abs(state.span - SPAN_AT_FIRST) < 1e-9 ? null : state.span.toFixed(2));
  for (const name of SWITCHES) put(name, state[name] === ON_AT_FIRST[name] ? null : String(Number(state[name])));
  put("view", state.view === "plan" ? null : state.view);
  put("plot", state.plots.size ? [...state.plots].map(encodeURIComponent).join(",") : null);
  const whom = state.follow || "0";
  put("follow", whom === (shown.hasRobot ? "robot" : "0") ? null : whom);
  put("x", state.follow ? null : state.middle.x.toFixed(2));
  put("y", state.follow ? null : state.middle.y.toFixed(2));
  put("theme", document.documentElement.dataset.theme ?? null);
  return `#${fields.toString().replaceAll("%2F", "/")}`;
}

/** Updates the address after a delay: browsers limit the changes per second. */
function keepAddress() {
  if (addressDue) return;
  addressDue = setTimeout(() => {
    addressDue = 0;
    history.replaceState(null, "", addressNow());
  }, 200);
}

/** Copies a link to this moment; older browsers use a text selection. */
async function copyLink() {
  const link = new URL(addressNow(), location.href).href;
  try {
    await navigator.clipboard.writeText(link);
  } catch {
    const box = el("textarea", { text: link, readonly: true, "aria-label": "Link" });
    document.body.append(box);
    box.select();
    document.execCommand("copy");
    box.remove();
  }
  say("The link to this moment is in the clipboard.");
}

/** Shows a link back to the report that opened this page, if it has the same origin. */
function offerReport() {
  const fields = fragment().get("report");
  const url = fields ? new URL(fields, location.href) : null;
  const safe = url && url.protocol === location.protocol && url.host === location.host;
  byId("report").hidden = !safe;
  if (safe) byId("report").href = url.href;
}

/** Shows a status message, also to screen readers. */
function say(text) {
  byId("said").textContent = text;
}
