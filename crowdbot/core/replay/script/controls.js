// Buttons, keys and pointers.

function toggle(name, on = !state[name]) {
  state[name] = on;
  byId(name).setAttribute("aria-pressed", String(on));
  keepAddress();
  ask();
}

const widest = () => 2 * (shown.bounds.x1 - shown.bounds.x0);

function zoom(factor) {
  state.span = clamp(state.span * factor, 2, widest());
  keepAddress();
  ask();
}

function changeSpeed(by) {
  const select = byId("speed");
  select.selectedIndex = clamp(select.selectedIndex + by, 0, select.length - 1);
}

function look(x, y) {
  if (state.follow) follow("");
  state.middle = { x, y };
  keepAddress();
  ask();
}

const followRobot = () => follow(state.follow.startsWith("robot") ? "" : "robot");

function bindButtons() {
  const acts = {
    play, back: () => step(-1), forward: () => step(1), follow: followRobot,
    touch: () => nextEvent(["contact"]), in: () => zoom(1 / 1.4), out: () => zoom(1.4),
    link: copyLink, png: savePicture, clip: saveClip,
    theme: () => { setTheme(isDark() ? "light" : "dark"); paintSolids(); keepAddress(); ask(); },
  };
  for (const [id, act] of Object.entries(acts)) byId(id).onclick = act;
  for (const name of SWITCHES) byId(name).onclick = () => toggle(name);
  byId("whom").onchange = (event) => follow(event.target.value);
  byId("scrub").oninput = (event) => seek(Number(event.target.value));
  byId("event-kinds").onchange = writeEvents;
  byId("save").ontoggle = () => {
    byId("clip-from").value = state.time.toFixed(1);
    byId("clip-to").value = Math.min(shown.last, state.time + 5).toFixed(1);
  };
  byId("other").onchange = ({ target }) => target.files[0] && addFile(target.files[0]);
  byId("variants")?.addEventListener("change", ({ target }) => {
    document.body.classList.toggle("all-variants", target.checked);
  });
}

const KEYS = {
  " ": () => play(),
  f: () => shown.hasRobot && followRobot(),
  l: () => byId("lidar").click(),
  s: () => byId("sonar").click(),
  p: () => byId("thoughts").click(),
  t: () => byId("trails").click(),
  g: () => byId("ghost").click(),
  v: () => chooseView(VIEWS[(VIEWS.indexOf(state.view) + 1) % VIEWS.length]).catch(({ message }) => say(message)),
  c: () => nextEvent(["contact"]),
  e: () => nextEvent(["contact", "near miss", "arrival"]),
  "+": () => changeSpeed(1),
  "-": () => changeSpeed(-1),
  Home: () => seek(shown.first),
  End: () => seek(shown.last),
};

function onKey(event) {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  if (event.target.matches("select, input[type=number], input[type=file]")) return;
  if (event.key === " " && event.target.matches("button, a, summary, input[type=checkbox]")) return; // they handle the key themselves
  const arrow = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
  const act = arrow ? () => (event.shiftKey ? seek(state.time + arrow) : step(arrow)) : KEYS[event.key];
  if (!act) return;
  event.preventDefault();
  act();
}

function bindPage() {
  document.addEventListener("keydown", onKey);
  pointers(byId("overview"), { at: (x, y) => look(...toWorld(shown.wide, x, y)) });
  const again = new ResizeObserver(() => shown.onPaper || paint()); // before the browser shows the new size
  for (const id of ["overview", "closeups", "timeline", "plot-figures"]) again.observe(byId(id));
  wantsDark.addEventListener("change", () => { readColours(); paintSolids(); ask(); });
  addEventListener("beforeprint", toPaper);
  addEventListener("afterprint", fromPaper);
  addEventListener("hashchange", () => {
    readAddress();
    chooseView(state.view).catch(({ message }) => say(message));
    showState();
  });
}
