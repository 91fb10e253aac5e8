// Draws robots as they are seen from above, and their paths.

function drawRobot(g, robot, pose, colour, px) {
  if (!Number.isFinite(pose.x)) return; // it has left
  const r = Math.max(robot.radius, 5 * px);
  g.save();
  g.translate(pose.x, pose.y);
  g.rotate(pose.theta);
  robotPath(g, robot, r, 3 * px);
  g.fillStyle = colours.floor;
  g.fill();
  robotPath(g, robot, r, 0);
  g.fillStyle = colour;
  g.fill();
  g.lineWidth = 1.5 * px;
  g.strokeStyle = colours["robot-edge"];
  g.stroke();
  if (robot.look.length) drawLook(g, robot, px);
  else drawArrow(g, r);
  robotPath(g, robot, r, px);
  g.lineWidth = 2.5 * px;
  g.strokeStyle = colour;
  g.stroke();
  if (robot.look.length) drawNose(g, reachOf(robot), colour, px);
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

/** Draws an arrow on a robot that is drawn as a plain outline. */
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

/** Draws a tip in front of a robot that is drawn by its parts. */
function drawNose(g, reach, colour, px) {
  const [from, wide] = [reach + 2 * px, Math.max(0.3 * reach, 3 * px)];
  g.beginPath();
  g.moveTo(from + wide, 0);
  g.lineTo(from, 0.6 * wide);
  g.lineTo(from, -0.6 * wide);
  g.closePath();
  g.fillStyle = colour;
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

/** Draws the past path of a robot, the last seconds stronger. */
function drawTrail(g, run, robot, pose, frame, colour, px) {
  const recent = sampleAt(run, frame.time - TRAIL).k;
  g.strokeStyle = colour;
  g.lineJoin = "round";
  for (const [from, alpha, width] of [[0, 0.45, 1.5], [recent, 1, 2.5]]) {
    g.beginPath();
    if (Number.isFinite(robot.x[from])) g.moveTo(robot.x[from], robot.y[from]);
    for (let k = from + 1; k <= frame.k; k++) if (Number.isFinite(robot.x[k])) g.lineTo(robot.x[k], robot.y[k]);
    if (Number.isFinite(pose.x)) g.lineTo(pose.x, pose.y);
    g.globalAlpha = alpha;
    g.lineWidth = width * px;
    g.stroke();
  }
  g.globalAlpha = 1;
}
