// The hand on the stick: joins keyboard, pad and gamepad, and says when no hand is there.

const BEAT = 100; // ms between two words to the run; it waits half a second for one
const POLL = 10; // ms between two looks at the gamepad, also where pictures come seldom
const TURN = 2.2; // rad/s of the view of a person who walks
const hand = { drives: false, number: 0, last: "", yaw: 0, gain: 1, before: 0 };

/** Why no hand is on the stick; "" if one is. */
function awayNow() {
  if (document.hidden) return "hidden";
  return document.hasFocus() ? "" : "not in focus";
}

/** Deflections of all devices together. */
function stickNow() {
  const typed = keysNow();
  const join = (axis) => hand.gain * clamp(typed[axis] + (pad[axis] ?? 0) + gamepad[axis], -1, 1) || 0;
  return { ahead: join("ahead"), left: join("left"), aside: join("aside") };
}

/** Sends the stick if it moved; `stamp` is the time of the hand's motion. */
function handMoved(stamp) {
  const stick = awayNow() ? { ahead: 0, left: 0, aside: 0 } : stickNow();
  showKnob(stick);
  if (!hand.drives) return;
  if (document.documentElement.dataset.mode === "walk") {
    stick.left = 0;
    stick.yaw = Math.round(1e4 * hand.yaw) / 1e4;
  }
  const text = JSON.stringify(stick);
  if (text === hand.last) return;
  hand.last = text;
  hand.number += 1;
  if (stamp !== null) noteSent(hand.number, stamp);
  send("stick", { n: hand.number, ...stick });
}

/** Lets go of everything that is held. */
function letGo() {
  keys.down.clear();
  centrePad();
  beat();
}

/** Tells the run that the page is there, and whether a hand is on its stick. */
function beat() {
  const away = awayNow();
  if (away) handMoved(null);
  if (hand.drives) send("here", { away });
  if (!away) handMoved(null);
}

/** Turns the view of a person who walks, and reads the gamepad. */
function pollHand(now) {
  const { stamp, pressed } = readGamepad();
  if (pressed) startRun();
  if (stamp !== null) handMoved(stamp);
  if (document.documentElement.dataset.mode === "walk" && !awayNow()) {
    const turned = hand.yaw + TURN * stickNow().left * Math.min(0.1, (now - hand.before) / 1000);
    if (turned !== hand.yaw) {
      hand.yaw = Math.atan2(Math.sin(turned), Math.cos(turned));
      handMoved(null);
    }
  }
  hand.before = now;
}

function startRun() {
  if (!hand.drives || !link.open) return;
  beat();
  send("begin");
}

function bindHand() {
  listenToKeys(handMoved, startRun);
  listenToPad(handMoved);
  byId("gain").oninput = ({ target }) => {
    hand.gain = Number(target.value) / 100;
    byId("gain-text").textContent = `${target.value} %`;
    handMoved(performance.now());
  };
  for (const kind of ["blur", "pagehide"]) addEventListener(kind, letGo);
  addEventListener("focus", beat);
  document.addEventListener("visibilitychange", letGo);
  setInterval(beat, BEAT);
  setInterval(() => pollHand(performance.now()), POLL);
  setInterval(sayLatency, 1000);
}
