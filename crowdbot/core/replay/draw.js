// Draws one view. A view is {canvas, x, y, scale}: its middle (m) and pixels per metre.

const BUCKETS = 16;
const FLASH = 0.9; // s that a contact stays visible at least
let colours = {};

function readColours() {
  const style = getComputedStyle(document.documentElement);
  const names = ["floor", "grid", "grid-strong", "wall", "ink", "muted", "robot", "robot-edge",
    "goal", "lidar", "sonar", "contact", "person-edge", "slow", "fast", "accent"];
  colours = Object.fromEntries(names.map((n) => [n, style.getPropertyValue(`--${n}`).trim()]));
  const channel = (hex, i) => parseInt(hex.slice(1 + 2 * i, 3 + 2 * i), 16);
  colours.ramp = Array.from({ length: BUCKETS }, (_, b) => {
    const mix = [0, 1, 2].map((i) => {
      const [a, z] = [channel(colours.slow, i), channel(colours.fast, i)];
      return Math.round(a + ((z - a) * b) / (BUCKETS - 1));
    });
    return `rgb(${mix.join(" ")})`;
  });
}

/** Fits the canvas to its box; returns a context in CSS pixels. */
function prepareCanvas(canvas) {
  const ratio = window.devicePixelRatio || 1;
  const width = canvas.clientWidth;
  const height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const g = canvas.getContext("2d");
  g.setTransform(ratio, 0, 0, ratio, 0, 0);
  return { g, width, height };
}

function drawView(run, view, frame, options) {
  const { g, width, height } = prepareCanvas(view.canvas);
  g.fillStyle = colours.floor;
  g.fillRect(0, 0, width, height);
  g.save();
  g.translate(width / 2, height / 2);
  g.scale(view.scale, -view.scale);
  g.translate(-view.x, -view.y);
  const px = 1 / view.scale;
  drawGrid(g, view, width, height, options.grid);
  drawGoal(g, run, px);
  if (options.lidar) for (const scan of frame.scans) drawFan(g, scan);
  if (options.sonar) for (const cone of frame.cones) drawCone(g, cone, px);
  drawWalls(g, run, px);
  if (run.robot) drawTrail(g, run, frame, px);
  if (run.people) drawPeople(g, run, frame, px);
  if (options.lidar) for (const scan of frame.scans) drawHits(g, scan, px);
  if (options.sonar) for (const cone of frame.cones) drawEcho(g, cone, px);
  for (const other of run.others) {
    const there = robotAt(run, frame.time, other);
    if (Number.isFinite(there.x)) drawRobot(g, other, there, px);
  }
  if (run.robot) drawRobot(g, run.robot, frame.robot, px);
  drawContacts(g, run, frame, px);
  if (options.frame) drawFrame(g, options.frame, px);
  g.restore();
  return { g, width, height };
}

function drawGrid(g, view, width, height, step) {
  const [w, h] = [width / 2 / view.scale, height / 2 / view.scale];
  g.lineWidth = 1 / view.scale;
  for (const strong of [false, true]) {
    g.beginPath();
    const every = strong ? 5 * step : step;
    const first = (middle, half) => Math.ceil((middle - half) / every) * every;
    for (let x = first(view.x, w); x <= view.x + w; x += every) {
      g.moveTo(x, view.y - h);
      g.lineTo(x, view.y + h);
    }
    for (let y = first(view.y, h); y <= view.y + h; y += every) {
      g.moveTo(view.x - w, y);
      g.lineTo(view.x + w, y);
    }
    g.strokeStyle = strong ? colours["grid-strong"] : colours.grid;
    g.stroke();
  }
}

function drawGoal(g, run, px) {
  g.beginPath();
  if (run.zone.length) {
    run.zone.forEach(([x, y], i) => (i ? g.lineTo(x, y) : g.moveTo(x, y)));
    g.closePath();
  } else if (run.robot?.goal) {
    g.arc(run.robot.goal[0], run.robot.goal[1], Math.max(run.robot.goalRadius, 0.3), 0, 7);
  } else return;
  g.fillStyle = colours.goal;
  g.globalAlpha = 0.16;
  g.fill();
  g.globalAlpha = 1;
  g.strokeStyle = colours.goal;
  g.lineWidth = 1.5 * px;
  g.setLineDash([6 * px, 4 * px]);
  g.stroke();
  g.setLineDash([]);
}

function drawWalls(g, run, px) {
  g.beginPath();
  for (const [x0, y0, x1, y1] of run.walls) {
    g.moveTo(x0, y0);
    g.lineTo(x1, y1);
  }
  g.strokeStyle = colours.wall;
  g.lineWidth = Math.max(0.1, 2.5 * px);
  g.lineCap = "round";
  g.stroke();
}

function drawTrail(g, run, frame, px) {
  const { x, y } = run.robot;
  const recent = sampleAt(run, frame.time - 4).k;
  const line = (from, alpha, width) => {
    g.beginPath();
    g.moveTo(x[from], y[from]);
    for (let k = from + 1; k <= frame.k; k++) g.lineTo(x[k], y[k]);
    g.lineTo(frame.robot.x, frame.robot.y);
    g.globalAlpha = alpha;
    g.lineWidth = width * px;
    g.stroke();
  };
  g.strokeStyle = colours.robot;
  g.lineJoin = "round";
  line(0, 0.45, 1.5);
  line(recent, 1, 2.5);
  g.globalAlpha = 1;
}

function drawPeople(g, run, frame, px) {
  const { x, y, speed, heading, person, size } = frame.people;
  const least = 2 * px;
  const groups = Array.from({ length: BUCKETS }, () => []);
  for (let i = 0; i < size; i++) {
    const b = Math.round(Math.min(1, speed[i] / frame.topSpeed) * (BUCKETS - 1));
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
  g.beginPath();
  for (let i = 0; i < size; i++) {
    if (Number.isNaN(heading[i])) continue;
    const r = Math.max(radiusOf(run.people, person[i]), least);
    const [c, s] = [Math.cos(heading[i]), Math.sin(heading[i])];
    g.moveTo(x[i] + 0.35 * r * c, y[i] + 0.35 * r * s);
    g.lineTo(x[i] + r * c, y[i] + r * s);
  }
  g.lineWidth = Math.max(0.06, 1.3 * px);
  g.lineCap = "butt";
  g.stroke();
}

function drawFan(g, scan) {
  g.beginPath();
  g.moveTo(scan.x, scan.y);
  for (const p of scan.rim) g.lineTo(p.x, p.y);
  g.closePath();
  g.fillStyle = colours.lidar;
  g.globalAlpha = 0.09;
  g.fill();
  g.globalAlpha = 1;
}

function drawCone(g, cone, px) {
  g.beginPath();
  g.moveTo(cone.x, cone.y);
  g.arc(cone.x, cone.y, cone.range, cone.from, cone.to);
  g.closePath();
  g.fillStyle = g.strokeStyle = colours.sonar;
  g.globalAlpha = 0.13;
  g.fill();
  g.globalAlpha = 0.4;
  g.lineWidth = px;
  g.stroke();
  g.globalAlpha = 1;
}

/** One reading: anywhere between the edges. */
function drawEcho(g, cone, px) {
  g.beginPath();
  g.arc(cone.x, cone.y, cone.range, cone.from, cone.to);
  g.strokeStyle = colours.sonar;
  g.lineWidth = Math.max(0.03, 1.6 * px);
  g.lineCap = "round";
  g.stroke();
}

function drawHits(g, scan, px) {
  const d = Math.max(0.03, 1.6 * px);
  g.fillStyle = colours.lidar;
  for (const p of scan.rim) if (p.hit) g.fillRect(p.x - d / 2, p.y - d / 2, d, d);
}

function drawRobot(g, robot, { x, y, theta }, px) {
  const r = Math.max(robot.radius, 5 * px);
  g.save();
  g.translate(x, y);
  g.rotate(theta);
  robotPath(g, robot, r, 3 * px);
  g.fillStyle = colours.floor;
  g.fill();
  robotPath(g, robot, r, 0);
  g.fillStyle = colours.robot;
  g.fill();
  g.lineWidth = 1.5 * px;
  g.strokeStyle = colours["robot-edge"];
  g.stroke();
  if (robot.look?.length) drawLook(g, robot, px);
  else drawArrow(g, r);
  g.restore();
}

/** The robot's parts as they are seen from above. */
function drawLook(g, robot, px) {
  g.lineWidth = 0.7 * px;
  g.strokeStyle = colours["robot-edge"];
  for (const [colour, outline] of robot.look) {
    g.beginPath();
    outline.forEach(([x, y], i) => g[i ? "lineTo" : "moveTo"](x, y));
    g.closePath();
    g.fillStyle = colour;
    g.fill();
    g.stroke();
  }
}

/** Where a robot looks that has nothing else to tell it by. */
function drawArrow(g, r) {
  g.beginPath();
  g.moveTo(0.72 * r, 0);
  g.lineTo(-0.42 * r, 0.5 * r);
  g.lineTo(-0.18 * r, 0);
  g.lineTo(-0.42 * r, -0.5 * r);
  g.closePath();
  g.fillStyle = colours["robot-edge"];
  g.fill();
}

/** The robot's outline in its own frame, `more` larger: a disc, a capsule or a polygon. */
function robotPath(g, robot, r, more) {
  g.beginPath();
  const corners = robot.outline;
  if (corners.length === 2) {
    const [[ax, ay], [bx, by]] = corners;
    const across = Math.atan2(by - ay, bx - ax) + Math.PI / 2;
    g.arc(ax, ay, robot.radius + more, across, across + Math.PI);
    g.arc(bx, by, robot.radius + more, across + Math.PI, across + 2 * Math.PI);
    g.closePath();
  } else if (corners.length) {
    const grow = ([x, y]) => 1 + more / (Math.hypot(x, y) || 1);
    corners.forEach((c, i) => g[i ? "lineTo" : "moveTo"](c[0] * grow(c), c[1] * grow(c)));
    g.closePath();
  } else g.arc(0, 0, r + more, 0, 2 * Math.PI);
}

/** Whether a contact is shown at this time; the shortest ones are shown a moment longer. */
function isShown(contact, time) {
  return time >= contact.t0 && time <= Math.max(contact.t1, contact.t0 + FLASH);
}

/** Where on the robot it began. */
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

/** Rings around those in contact; they widen and fade. */
function drawContacts(g, run, frame, px) {
  for (const contact of run.contacts) {
    if (!isShown(contact, frame.time)) continue;
    const end = Math.max(contact.t1, contact.t0 + FLASH);
    const age = (frame.time - contact.t0) / (end - contact.t0);
    let place = frame.robot;
    let radius = run.robot ? run.robot.radius : 0.3;
    for (let i = 0; i < frame.people.size; i++) {
      if (frame.people.person[i] !== contact.person) continue;
      place = { x: frame.people.x[i], y: frame.people.y[i] };
      radius = radiusOf(run.people, contact.person);
    }
    if (!place) continue;
    g.strokeStyle = colours.contact;
    for (const [grow, width, alpha] of [[0.06, 3, 1], [0.1 + 0.9 * age, 2, 1 - age]]) {
      g.beginPath();
      g.arc(place.x, place.y, Math.max(radius, 4 * px) + grow * (1 + 6 * px), 0, 2 * Math.PI);
      g.lineWidth = width * px;
      g.globalAlpha = alpha;
      g.stroke();
    }
    g.globalAlpha = 1;
    if (frame.robot && contact.bearing !== null) drawTouchedPoint(g, frame.robot, contact, px);
  }
}

function drawFrame(g, box, px) {
  g.strokeStyle = colours.accent;
  g.globalAlpha = 0.8;
  g.lineWidth = 1.5 * px;
  g.strokeRect(box.x, box.y, box.w, box.h);
  g.globalAlpha = 1;
}

function drawScaleBar(g, view, height) {
  const metres = [0.5, 1, 2, 5, 10, 20, 50].find((m) => m * view.scale > 50) || 100;
  const length = metres * view.scale;
  const y = height - 14;
  g.globalAlpha = 0.86;
  g.fillStyle = colours.floor;
  g.fillRect(6, y - 13, length + 58, 21);
  g.globalAlpha = 1;
  g.strokeStyle = colours.ink;
  g.fillStyle = colours.ink;
  g.lineWidth = 1.5;
  g.beginPath();
  g.moveTo(14, y - 4);
  g.lineTo(14, y);
  g.lineTo(14 + length, y);
  g.lineTo(14 + length, y - 4);
  g.stroke();
  g.font = "12px system-ui, sans-serif";
  g.fillText(`${metres} m`, 22 + length, y + 2);
}
