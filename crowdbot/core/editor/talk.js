// Requests to the server, one after the other, and the texts before and after each change.

const past = [], future = [];
let queue = Promise.resolve();

function ask(path, content) {
  const answer = queue.then(async () => {
    const reply = await fetch(path, { method: "POST", body: JSON.stringify(content),
      headers: { "Content-Type": "application/json", "X-Crowdbot-Token": document.body.dataset.token } });
    const found = await reply.json();
    if (!reply.ok) throw Object.assign(new Error(found.error), { status: reply.status });
    return found;
  });
  queue = answer.catch(() => null);
  return answer;
}

const say = (text) => { $("status").textContent = text; };
const unsaved = () => state.text !== state.saved;

function show(found, keepText = false) {
  state.text = found.text;
  state.errors = found.errors;
  if (found.data && Object.keys(found.data).length) state.data = found.data;
  if (!found.errors.length) Object.assign(state, { walls: found.walls, pillars: found.pillars, people: found.people });
  state.items = itemsOf(state.data);
  const drawnAlone = new Set(state.items.filter((i) => i.kind === "person").map((i) => i.points[0].join()));
  state.people = state.people.filter((p) => !drawnAlone.has(p.slice(0, 2).join()));
  if (!keepText) $("text").value = state.text;
  redraw();
  showPicked();
  showErrors();
  $("undo").disabled = !past.length;
  $("redo").disabled = !future.length;
  say(`${found.errors.length ? `${found.errors.length} messages` : "valid"}${unsaved() ? ", not saved" : ", saved"}`);
  document.documentElement.dataset.ready = "true";
}

function remember(text) {
  past.push(text);
  future.length = 0;
}

async function apply(changes) {
  if (!changes.length) return;
  try {
    const before = state.text, found = await ask("/change", { text: before, changes });
    if (found.text !== before) remember(before);
    show(found);
  } catch (error) { say(error.message); redraw(); }
}

async function step(from, into) {
  if (!from.length) return;
  into.push(state.text);
  show(await ask("/check", { text: from.pop() }));
}

async function typed() {
  const before = state.text, text = $("text").value;
  if (text === before) return;
  remember(before);
  try { show(await ask("/check", { text }), true); } catch (error) { say(error.message); }
}

async function save(anyway = false) {
  try {
    const found = await ask("/save", { text: state.text, hash: state.hash, anyway });
    state.hash = found.hash;
    state.saved = state.text;
    say(found.errors.length ? `saved with ${found.errors.length} messages` : "saved");
  } catch (error) {
    if (error.status !== 409) { say(error.message); return; }
    $("why").textContent = error.message;
    $("conflict").showModal();
  }
}

async function load() {
  const found = await ask("/open", {});
  state.hash = found.hash;
  state.saved = found.hash === "new" ? "" : found.text;
  show(found);
}

async function play() {
  say("simulating …");
  try {
    const film = await ask("/play", { text: state.text });
    let k = 0;
    const next = () => {
      if (k >= film.t.length) { state.frame = null; redraw(); say("played 10 s"); return; }
      state.frame = { people: film.people[k] || [], radius: film.radius, robots: Object.values(film.robots).map((way) => way[k]) };
      redraw();
      say(`${film.t[k].toFixed(1)} s`);
      k += 1;
      setTimeout(next, 125);
    };
    document.documentElement.dataset.frames = film.t.length;
    next();
  } catch (error) { say(error.message); }
}
