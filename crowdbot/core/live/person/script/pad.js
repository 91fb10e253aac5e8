// The stick on the page, for a mouse or a finger.

const pad = { ahead: 0, left: 0, held: null };

function listenToPad(moved) {
  const box = byId("pad");
  const place = (event) => {
    const { left, top, width, height } = box.getBoundingClientRect();
    const reach = 0.5 * Math.min(width, height) - 24;
    const [x, y] = [event.clientX - left - width / 2, event.clientY - top - height / 2];
    const far = Math.max(1, Math.hypot(x, y) / reach);
    pad.left = -x / reach / far;
    pad.ahead = -y / reach / far;
    moved(event.timeStamp);
  };
  const release = (event) => {
    if (event.pointerId !== pad.held) return;
    centrePad();
    moved(event.timeStamp);
  };
  box.addEventListener("pointerdown", (event) => {
    box.setPointerCapture(event.pointerId);
    pad.held = event.pointerId;
    place(event);
  });
  box.addEventListener("pointermove", (event) => {
    if (event.pointerId === pad.held) place(event);
  });
  for (const kind of ["pointerup", "pointercancel", "lostpointercapture"]) box.addEventListener(kind, release);
}

function centrePad() {
  pad.held = null;
  pad.ahead = pad.left = 0;
}

/** Shows where the stick is, whatever moved it. */
function showKnob({ ahead, left }) {
  const reach = 0.5 * byId("pad").clientWidth - 24;
  byId("knob").style.transform = `translate(${-left * reach}px, ${-ahead * reach}px)`;
}
