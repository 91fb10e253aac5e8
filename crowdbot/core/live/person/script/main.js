// Joins the connection, the hand and the picture.

const WRITE = 90; // ms between two changes of the words; each costs a layout

function draw(now) {
  const frame = frameNow(now);
  if (frame) {
    if (!drawEyes(frame)) drawPlan(frame);
    if (now - shown.wrote > WRITE) writeReadout(frame);
  }
  if (now - shown.wrote > WRITE) {
    writeControls();
    shown.wrote = now;
  }
  if (!eyes.solid?.renderer.xr.isPresenting) requestAnimationFrame(draw);
}

function start() {
  readColours();
  const recolour = () => eyes.solid && paintSolid(eyes.solid);
  byId("theme").onclick = () => {
    setTheme(isDark() ? "light" : "dark");
    recolour();
  };
  wantsDark.addEventListener("change", () => {
    readColours();
    recolour();
  });
  byId("begin").onclick = () => {
    byId("pad").focus({ preventScroll: true });
    startRun();
  };
  byId("sit").onclick = () => send("sit");
  byId("pause").onclick = () => send("pause", { on: words.waits !== "paused" });
  bindHand();
  bindEyes().catch(({ message }) => { byId("banner").textContent = message; });
  connect({
    open: () => { words.connected = true; hand.last = ""; writeWords(); },
    close: () => { words.connected = words.drives = hand.drives = false; writeWords(); },
    role: ({ drives, taken }) => { words.drives = hand.drives = drives; words.taken = taken; hand.last = ""; beat(); writeWords(); },
    state: ({ waits, taken }) => { words.waits = waits; words.taken = taken; writeWords(); },
    scene: ({ scene }) => { words.end = null; takeScene(scene); writeWords(); },
    frame: takeFrame,
    taken: ({ n, at }) => noteTaken(n, at),
    end: (message) => { words.end = message; link.over = Boolean(message.last); writeWords(); },
  });
  setInterval(writeWords, 250);
  requestAnimationFrame(draw);
  document.documentElement.dataset.ready = "";
}

start();
