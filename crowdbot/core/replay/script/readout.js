// The numbers of this moment beside each view.

function writeReadout(panel, frame) {
  const { run } = panel;
  const followed = followedIn(run, frame);
  const rows = followed?.person >= 0 ? personRows(run, frame, followed) : robotRows(run, frame, followed?.robot ?? 0);
  const { contacts } = run;
  if (contacts.length) {
    rows.push(["contacts", `${contacts.filter((c) => c.t0 <= frame.time).length} of ${contacts.length}`]);
  }
  const now = contacts.findLast((c) => isShown(c, frame.time));
  if (now) {
    const force = now.impulse === null ? "" : `, ${digits(now.impulse, "N s")}`;
    rows.push([now.person < 0 ? "touches a wall" : `touches ${personName(run, now.person)}`, now.side + force]);
  }
  if (frame.ended && shown.runs.length > 1) rows.push(["has ended", withUnit(frame.time, 1, "s")]);
  writeFacts(panel.readout, rows);
}

const degrees = (angle) => withUnit((angle * 180) / Math.PI, 0, "°");
const placeText = ({ x, y }) => `${withUnit(x, 2)}, ${withUnit(y, 2, "m")}`;

function robotRows(run, frame, index) {
  const pose = frame.robots[index];
  if (!pose) return run.people ? [["people", String(frame.people.size)]] : [];
  const rows = [["speed", withUnit(pose.v, 2, "m/s")]];
  if (state.follow.startsWith("robot") && shown.runs.length === 1) {
    rows.push(["turn rate", withUnit(pose.w, 2, "rad/s")], ["heading", degrees(pose.theta)], ["x, y", placeText(pose)]);
  }
  const gap = oneOf(run, index ? `clearance/${index}` : "clearance")?.values[frame.k];
  if (Number.isFinite(gap)) rows.push(["nearest person", withUnit(gap, 2, "m")]);
  return rows;
}

function personRows(run, frame, { person, place }) {
  const i = placeOf(frame.people, person);
  if (i < 0) return [["person", `${run.people.id[person]} is not there`]];
  const rows = [
    ["person", String(run.people.id[person])],
    ["speed", withUnit(frame.people.speed[i], 2, "m/s")],
    ["heading", degrees(frame.people.heading[i])],
    ["x, y", placeText(place)],
    ["radius", withUnit(radiusOf(run.people, person), 2, "m")],
  ];
  frame.robots.forEach((pose, r) => {
    const gap = fromRobot(run.robots[r], pose.theta, place.x - pose.x, place.y - pose.y);
    rows.push([`from ${robotName(run, r)}`, withUnit(gap - radiusOf(run.people, person), 2, "m")]);
  });
  return rows;
}

/** The clock and the slider. */
function writeClock() {
  const { time } = state;
  byId("clock").textContent = `${time.toFixed(2)} / ${shown.last.toFixed(1)} s`;
  byId("scrub").value = time;
  byId("scrub").setAttribute("aria-valuetext", `${time.toFixed(1)} of ${shown.last.toFixed(1)} seconds`);
}
