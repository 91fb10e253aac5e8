// State, controls and the clock.

const byId = (id) => document.getElementById(id);

function start(run) {
  const [first, last] = [run.t[0], run.t[run.n - 1]];
  const bounds = boundsOf(run);
  const middle = { x: (bounds.x0 + bounds.x1) / 2, y: (bounds.y0 + bounds.y1) / 2 };
  const wide = { canvas: byId("overview"), ...middle, scale: 1 };
  const close = { canvas: byId("closeup"), ...middle, scale: 1 };
  const state = { time: first, playing: false, follow: Boolean(run.robot), lidar: true, sonar: true, span: 12 };
  const count = run.people ? run.people.count : 0;
  const room = () => new Float64Array(count);
  const people = { x: room(), y: room(), speed: room(), heading: room(), person: room(), size: 0 };
  prepare(run);
  const topSpeed = topSpeedOf(run);
  const curve = curveOf(run);
  readColours();

  function frameAt(time) {
    return {
      time,
      topSpeed,
      k: sampleAt(run, time).k,
      robot: run.robot ? robotAt(run, time) : null,
      people: run.people ? peopleAt(run, time, people) : people,
      scans: run.scans.map((s) => scanAt(run, s, time)).filter(Boolean),
      cones: run.cones.flatMap((group) => conesAt(run, group, time)),
    };
  }

  function aim(frame) {
    const w = wide.canvas;
    const fit = [w.clientWidth / (bounds.x1 - bounds.x0), w.clientHeight / (bounds.y1 - bounds.y0)];
    wide.scale = Math.min(...fit);
    close.scale = Math.max(close.canvas.clientWidth, 320) / state.span;
    if (state.follow && frame.robot) [close.x, close.y] = [frame.robot.x, frame.robot.y];
  }

  let queued = false;
  let before = 0;
  function render(now) {
    queued = false;
    if (state.playing) {
      const passed = Math.min(0.1, Math.max(0, (now - before) / 1000));
      state.time += passed * Number(byId("speed").value);
      if (state.time >= last) {
        state.time = last;
        setPlaying(false);
      }
    }
    before = now;
    paint();
    if (state.playing) ask();
  }

  function paint() {
    const frame = frameAt(state.time);
    aim(frame);
    const [w, h] = [close.canvas.clientWidth / close.scale, close.canvas.clientHeight / close.scale];
    const box = { x: close.x - w / 2, y: close.y - h / 2, w, h };
    drawView(run, wide, frame, { grid: 1, lidar: state.lidar, sonar: false, frame: box });
    const { g, height } = drawView(run, close, frame, { grid: 0.5, lidar: state.lidar, sonar: state.sonar });
    drawScaleBar(g, close, height);
    drawTimeline(run, byId("timeline"), curve, state.time);
    report(run, frame, curve, last);
  }

  function ask() {
    if (!queued) requestAnimationFrame(render);
    queued = true;
  }

  function setPlaying(on) {
    state.playing = on;
    before = performance.now();
    document.body.classList.toggle("playing", on);
    byId("play").setAttribute("aria-label", on ? "Pause" : "Play");
    ask();
  }

  function seek(time) {
    state.time = Math.min(last, Math.max(first, time));
    ask();
  }

  function step(by) {
    setPlaying(false);
    const { k, f } = sampleAt(run, state.time);
    const at = by < 0 ? Math.ceil(k + f - 1e-6) : Math.floor(k + f + 1e-6);
    seek(run.t[Math.min(run.n - 1, Math.max(0, at + by))]);
  }

  function toggle(name, on = !state[name]) {
    state[name] = on;
    byId(name).setAttribute("aria-pressed", String(on));
    ask();
  }

  function zoom(factor) {
    state.span = Math.min(2 * (bounds.x1 - bounds.x0), Math.max(2, state.span * factor));
    ask();
  }

  function nextContact() {
    const later = run.contacts.find((c) => c.t0 - 0.5 > state.time + 0.01);
    const contact = later || run.contacts[0];
    if (contact) seek(contact.t0 - 0.5);
  }

  function changeSpeed(by) {
    const select = byId("speed");
    const at = select.selectedIndex + by;
    select.selectedIndex = Math.min(select.length - 1, Math.max(0, at));
  }

  const play = () => {
    if (!state.playing && state.time >= last) state.time = first;
    setPlaying(!state.playing);
  };
  byId("play").onclick = play;
  byId("back").onclick = () => step(-1);
  byId("forward").onclick = () => step(1);
  byId("follow").onclick = () => toggle("follow");
  byId("lidar").onclick = () => toggle("lidar");
  byId("sonar").onclick = () => toggle("sonar");
  byId("touch").onclick = nextContact;
  byId("in").onclick = () => zoom(1 / 1.4);
  byId("out").onclick = () => zoom(1.4);
  byId("scrub").min = first;
  byId("scrub").max = last;
  byId("scrub").oninput = (event) => seek(Number(event.target.value));
  const keys = {
    " ": play,
    f: () => run.robot && toggle("follow"),
    l: () => run.scans.length && toggle("lidar"),
    s: () => run.cones.length && toggle("sonar"),
    c: nextContact,
    "+": () => changeSpeed(1),
    "-": () => changeSpeed(-1),
    Home: () => seek(first),
    End: () => seek(last),
  };
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target.matches("select, input[type=checkbox]")) return;
    if (event.key === " " && event.target.matches("button")) return; // the button acts
    const arrow = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    const act = arrow
      ? () => (event.shiftKey ? seek(state.time + arrow) : step(arrow))
      : keys[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  });

  const look = (x, y) => {
    if (run.robot) toggle("follow", false);
    [close.x, close.y] = [x, y];
    ask();
  };
  pointers(close.canvas, {
    drag: (dx, dy) => look(close.x - dx / close.scale, close.y + dy / close.scale),
    pinch: zoom,
  });
  pointers(wide.canvas, { at: (x, y) => look(...toWorld(wide, x, y)) });
  const fitted = new ResizeObserver(paint); // before the browser shows the new size
  for (const id of ["overview", "closeup", "timeline"]) fitted.observe(byId(id));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    readColours();
    ask();
  });
  byId("variants")?.addEventListener("change", (event) => {
    document.body.classList.toggle("all-variants", event.target.checked);
  });

  offer(run, topSpeed, bounds);
  toggle("follow", state.follow);
  toggle("lidar", true);
  toggle("sonar", true);
  const fragment = new URLSearchParams(location.hash.slice(1));
  if (fragment.has("t")) seek(Number(fragment.get("t")) || first);
  if (fragment.has("span")) state.span = Number(fragment.get("span")) || state.span;
  for (const name of ["lidar", "sonar"]) if (fragment.get(name) === "0") toggle(name, false);
  if (fragment.get("follow") === "0") toggle("follow", false);
  const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
  setPlaying(!fragment.has("paused") && !still);
}

function toWorld(view, x, y) {
  const { clientWidth: w, clientHeight: h } = view.canvas;
  return [view.x + (x - w / 2) / view.scale, view.y - (y - h / 2) / view.scale];
}

/** Drag with one pointer, pinch with two, zoom with the wheel. */
function pointers(canvas, { drag, pinch, at }) {
  const down = new Map();
  const spread = () => {
    const [a, b] = [...down.values()];
    return Math.hypot(a.x - b.x, a.y - b.y) || 1;
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    down.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
    at?.(event.offsetX, event.offsetY);
  });
  canvas.addEventListener("pointermove", (event) => {
    const old = down.get(event.pointerId);
    if (!old) return;
    const apart = down.size === 2 ? spread() : 0;
    down.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
    at?.(event.offsetX, event.offsetY);
    if (apart) pinch?.(apart / spread());
    else drag?.(event.offsetX - old.x, event.offsetY - old.y);
  });
  for (const name of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(name, (event) => down.delete(event.pointerId));
  }
  if (pinch) {
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      pinch(Math.exp(Math.sign(event.deltaY) * 0.15));
    }, { passive: false });
  }
}

/** The speed at which the colour ramp ends: nearly everybody is slower. */
function topSpeedOf(run) {
  if (!run.people || !run.people.count) return 1;
  const sorted = run.people.speed.filter((_, i) => i % 7 === 0).sort();
  return Math.max(0.5, Math.ceil(10 * sorted[Math.floor(0.97 * (sorted.length - 1))]) / 10);
}

/** Shows only what the run has. */
function offer(run, topSpeed, bounds) {
  const has = {
    robot: run.robot,
    people: run.people?.count,
    scans: run.scans.length,
    cones: run.cones.length,
    contacts: run.contacts.length,
    goal: run.robot && (run.zone.length || run.robot.goal),
  };
  for (const item of document.querySelectorAll("[data-for]")) item.hidden = !has[item.dataset.for];
  byId("follow").hidden = !run.robot;
  byId("lidar").hidden = !run.scans.length;
  byId("sonar").hidden = !run.cones.length;
  byId("touch").hidden = !run.contacts.length;
  byId("ramp").textContent = `people, 0–${topSpeed.toFixed(1)} m/s`;
  const ratio = (bounds.x1 - bounds.x0) / (bounds.y1 - bounds.y0);
  document.documentElement.style.setProperty("--ratio", Math.min(12, Math.max(1, ratio)));
}

/** Writes the numbers of this moment beside the pictures. */
function report(run, frame, curve, last) {
  byId("clock").textContent = `${frame.time.toFixed(2)} / ${last.toFixed(1)} s`;
  const scrub = byId("scrub");
  scrub.value = frame.time;
  scrub.setAttribute("aria-valuetext", `${frame.time.toFixed(1)} of ${last.toFixed(1)} seconds`);
  const rows = [];
  if (frame.robot) rows.push(["speed", `${frame.robot.v.toFixed(2)} m/s`.replace("-", "−")]);
  if (curve.gaps && Number.isFinite(curve.gaps[frame.k])) {
    rows.push(["nearest person", `${curve.gaps[frame.k].toFixed(2)} m`.replace("-", "−")]);
  }
  const so = run.contacts.filter((c) => c.t0 <= frame.time).length;
  if (run.contacts.length) rows.push(["contacts", `${so} of ${run.contacts.length}`]);
  const now = run.contacts.findLast((c) => isShown(c, frame.time));
  if (now) {
    const force = now.impulse === null ? "" : `, ${now.impulse.toFixed(1)} N s`;
    rows.push([now.person < 0 ? "touches a wall" : "touches a person", now.side + force]);
  }
  if (!frame.robot && run.people) rows.push(["people", String(frame.people.size)]);
  const parts = rows.map(([name, text]) => {
    const row = document.createElement("div");
    row.append(document.createElement("dt"), document.createElement("dd"));
    row.firstChild.textContent = name;
    row.lastChild.textContent = text;
    return row;
  });
  byId("readout").replaceChildren(...parts);
}

decode().then(start).catch((error) => {
  byId("failure").hidden = false;
  byId("failure").textContent = `The replay cannot be shown: ${error.message}`;
});
