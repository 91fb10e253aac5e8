// List of events: contacts, near misses, arrivals, the end. A click on one jumps to its time.

const NEAR = 0.1; // m between surfaces: nearer without contact is a near miss
const EARLIER = 0.5; // s before a contact at which its playback starts
const AROUND = 1; // s around a contact in which no near miss is listed

function eventsOf(run) {
  const found = [...contactEvents(run), ...run.robots.flatMap((robot, i) => nearMisses(run, robot, i))];
  run.robots.forEach(({ goalTime }, i) => {
    if (goalTime !== null) found.push({ kind: "arrival", t: goalTime, text: `${robotName(run, i)} arrives` });
  });
  if (run.status !== "arrived") {
    const why = run.status ? `end: ${run.status.replaceAll("_", " ")}` : "end";
    found.push({ kind: "end", t: run.t[run.n - 1], text: why });
  }
  return found.map((event) => ({ ...event, run })).sort((a, b) => a.t - b.t);
}

const robotName = (run, i) => (run.robots.length > 1 ? run.robots[i].name : "robot");
const personName = (run, p) => `person ${run.people.id[p]}`;

function contactEvents(run) {
  return run.contacts.map((contact) => {
    const whom = contact.person < 0 ? "a wall" : personName(run, contact.person);
    const force = contact.impulse === null ? "" : `, ${digits(contact.impulse, "N s")}`;
    const who = run.robots.length > 1 ? `${robotName(run, contact.robot ?? 0)}: ` : "";
    return { kind: "contact", t: contact.t0, to: contact.t0 - EARLIER,
      text: `${who}contact with ${whom}, ${contact.side}${force}` };
  });
}

/** Returns the time of least distance in each interval in which a person is near without contact. */
function nearMisses(run, robot, index) {
  const found = [];
  for (let p = 0; p < (run.people?.count ?? 0); p++) {
    let best = null;
    for (let k = 0; k <= run.n; k++) {
      const gap = k < run.n ? gapAt(run, robot, p, k) : Infinity;
      if (gap < NEAR) best = best && best.gap <= gap ? best : { gap, t: run.t[k] };
      else if (best) {
        if (!isContact(run, p, index, best.t)) {
          const text = `${withUnit(best.gap, 2, "m")} from ${personName(run, p)}`;
          found.push({ kind: "near miss", t: best.t, text });
        }
        best = null;
      }
    }
  }
  return found;
}

function isContact(run, person, robot, t) {
  return run.contacts.some((c) => c.person === person && (c.robot ?? 0) === robot &&
    t > c.t0 - AROUND && t < c.t1 + AROUND);
}

function offerEvents() {
  shown.events = shown.runs.flatMap((run) => run.events).sort((a, b) => a.t - b.t);
  byId("event-list").replaceChildren(...shown.events.map((event) => el("li", {}, eventButton(event))));
  writeEvents();
}

function eventButton({ kind, t, to = t, text, run }) {
  const several = shown.runs.length > 1;
  return el("button", { type: "button", "data-kind": kind, "data-t": t, onclick: () => { setPlaying(false); seek(to); } },
    el("span", { class: "when", text: withUnit(t, 1, "s") }), " ",
    ...(several ? [el("b", { class: "of-run", "data-run": run.index % RUN_COLOURS, text: run.label }), " "] : []), text);
}

/** Shows the selected kinds of events, with their counts. */
function writeEvents() {
  for (const box of document.querySelectorAll("#event-kinds input")) {
    const count = shown.events.filter(({ kind }) => kind === box.value).length;
    box.parentElement.hidden = !count;
    box.parentElement.lastChild.textContent = ` ${box.dataset.name} (${count})`;
  }
  const wanted = new Set([...document.querySelectorAll("#event-kinds input:checked")].map((b) => b.value));
  for (const item of byId("event-list").children) {
    item.hidden = !wanted.has(item.firstChild.dataset.kind) && item.firstChild.dataset.kind !== "end";
  }
}

/** Jumps to the next event of these kinds; after the last one, to the first. */
function nextEvent(kinds) {
  const wanted = shown.events.filter(({ kind }) => kinds.includes(kind));
  const event = wanted.find(({ t, to = t }) => to > state.time + 0.01) ?? wanted[0];
  if (event) seek(event.to ?? event.t);
}
