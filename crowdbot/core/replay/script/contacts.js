// Draws contacts while they last.

const FLASH = 0.9; // s that a contact stays visible at least

/** Returns true if a contact is shown at this time; short ones are shown for at least FLASH. */
function isShown(contact, time) {
  return time >= contact.t0 && time <= Math.max(contact.t1, contact.t0 + FLASH);
}

/** Draws rings that widen and fade around bodies in contact. */
function drawContacts(g, run, frame, px) {
  for (const contact of run.contacts) {
    if (!isShown(contact, frame.time)) continue;
    const end = Math.max(contact.t1, contact.t0 + FLASH);
    const robot = frame.robots[contact.robot ?? 0];
    const { place, radius } = touched(run, frame, contact, robot);
    if (place) drawRings(g, place, radius, (frame.time - contact.t0) / (end - contact.t0), px);
    if (robot && contact.bearing !== null) drawTouchedPoint(g, robot, contact, px);
  }
}

/** The body to mark: the person or robot touched; for a wall, the robot itself. */
function touched(run, frame, contact, robot) {
  const i = placeOf(frame.people, contact.person);
  if (i < 0) return { place: robot, radius: run.robots[contact.robot ?? 0]?.radius ?? 0.3 };
  const place = { x: frame.people.x[i], y: frame.people.y[i] };
  return { place, radius: radiusOf(run.people, contact.person) };
}

function drawRings(g, place, radius, age, px) {
  g.strokeStyle = colours.contact;
  for (const [grow, width, alpha] of [[0.06, 3, 1], [0.1 + 0.9 * age, 2, 1 - age]]) {
    g.beginPath();
    g.arc(place.x, place.y, Math.max(radius, 4 * px) + grow * (1 + 6 * px), 0, 2 * Math.PI);
    g.lineWidth = width * px;
    g.globalAlpha = alpha;
    g.stroke();
  }
  g.globalAlpha = 1;
}

/** Draws the place on the robot where the contact began. */
function drawTouchedPoint(g, robot, contact, px) {
  const along = robot.theta + contact.bearing;
  const [x, y] = [robot.x + contact.reach * Math.cos(along), robot.y + contact.reach * Math.sin(along)];
  g.beginPath();
  g.arc(x, y, Math.max(0.045, 4 * px), 0, 2 * Math.PI);
  g.fillStyle = colours.contact;
  g.fill();
  g.lineWidth = 1.5 * px;
  g.strokeStyle = colours.floor;
  g.stroke();
}
