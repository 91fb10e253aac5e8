// Draws people: discs coloured by speed, a line where they look, and their past paths.

const TRAIL = 4; // s

function drawPeople(g, run, frame, px) {
  const { x, y, speed, person, size } = frame.people;
  const least = 2 * px;
  const groups = Array.from({ length: BUCKETS }, () => []);
  for (let i = 0; i < size; i++) {
    const b = Math.round(clamp(speed[i] / shown.topSpeed, 0, 1) * (BUCKETS - 1));
    groups[b].push(i);
  }
  g.strokeStyle = colours["person-edge"];
  groups.forEach((group, b) => {
    g.beginPath();
    for (const i of group) {
      const r = Math.max(radiusOf(run.people, person[i]), least);
      g.moveTo(x[i] + r, y[i]);
      g.arc(x[i], y[i], r, 0, 2 * Math.PI);
    }
    g.fillStyle = colours.ramp[b];
    g.fill();
    g.lineWidth = px;
    g.stroke();
  });
  drawHeadings(g, run, frame, px);
}

function drawHeadings(g, run, { people: { x, y, heading, person, size } }, px) {
  g.beginPath();
  for (let i = 0; i < size; i++) {
    if (Number.isNaN(heading[i])) continue;
    const r = Math.max(radiusOf(run.people, person[i]), 2 * px);
    const [c, s] = [Math.cos(heading[i]), Math.sin(heading[i])];
    g.moveTo(x[i] + 0.35 * r * c, y[i] + 0.35 * r * s);
    g.lineTo(x[i] + r * c, y[i] + r * s);
  }
  g.lineWidth = Math.max(0.06, 1.3 * px);
  g.lineCap = "butt";
  g.stroke();
}

/** Draws the last seconds of all paths, interrupted where a person jumped. */
function drawPeopleTrails(g, run, frame, px) {
  g.beginPath();
  for (let i = 0; i < frame.people.size; i++) {
    pathOfPerson(g, run, frame.people.person[i], sampleAt(run, frame.time - TRAIL).k, frame.k);
    g.lineTo(frame.people.x[i], frame.people.y[i]);
  }
  g.strokeStyle = colours["person-edge"];
  g.globalAlpha = 0.45;
  g.lineWidth = 1.2 * px;
  g.stroke();
  g.globalAlpha = 1;
}

function pathOfPerson(g, run, p, from, to) {
  const { count, scale, x, y, jumps } = run.people;
  let joined = false;
  for (let k = from; k <= to; k++) {
    const i = p * run.n + k;
    if (x[i] === ABSENT) joined = false;
    else {
      g[joined ? "lineTo" : "moveTo"](x[i] * scale, y[i] * scale);
      joined = k === to || !jumps.has(k * count + p);
    }
  }
}

/** Draws the path of the followed person from the beginning on. */
function drawFollowedTrail(g, run, frame, person, px) {
  g.beginPath();
  pathOfPerson(g, run, person, 0, frame.k);
  g.strokeStyle = colours.chosen;
  g.lineWidth = 2 * px;
  g.lineJoin = "round";
  g.stroke();
}

/** Draws a ring around people that robots' tasks are about, with a line where they face. */
function drawWanted(g, run, { people: { x, y, heading, person, size } }, px) {
  const wanted = new Set(run.robots.flatMap((robot) => robot.wanted));
  if (!wanted.size) return;
  g.beginPath();
  for (let i = 0; i < size; i++) {
    if (!wanted.has(person[i])) continue;
    const r = radiusOf(run.people, person[i]) + 3 * px;
    g.moveTo(x[i] + r, y[i]);
    g.arc(x[i], y[i], r, 0, 2 * Math.PI);
    if (Number.isNaN(heading[i])) continue;
    g.moveTo(x[i] + r * Math.cos(heading[i]), y[i] + r * Math.sin(heading[i]));
    g.lineTo(x[i] + 1.6 * r * Math.cos(heading[i]), y[i] + 1.6 * r * Math.sin(heading[i]));
  }
  g.strokeStyle = colours.goal;
  g.lineWidth = 4 * px;
  g.stroke();
}

/** Draws a ring around the followed body. */
function drawFollowed(g, place, radius, px) {
  g.beginPath();
  g.arc(place.x, place.y, radius + 4 * px, 0, 2 * Math.PI);
  g.strokeStyle = colours.chosen;
  g.lineWidth = 3 * px;
  g.stroke();
}
