// Distances between surfaces, and the rectangle that shows all.

/** Distance of a point beside a robot's base from its surface, m; negative inside. */
function fromRobot(robot, theta, dx, dy) {
  const corners = robot.outline;
  if (!corners.length) return Math.hypot(dx, dy) - robot.radius;
  const [c, s] = [Math.cos(theta), Math.sin(theta)];
  const [x, y] = [c * dx + s * dy, c * dy - s * dx];
  const capsule = corners.length === 2;
  let nearest = Infinity;
  let inside = false;
  corners.forEach(([ax, ay], i) => {
    const [bx, by] = corners[(i + 1) % corners.length];
    const [ex, ey] = [bx - ax, by - ay];
    const along = ((x - ax) * ex + (y - ay) * ey) / (ex * ex + ey * ey || 1);
    const f = clamp(along, 0, 1);
    nearest = Math.min(nearest, Math.hypot(x - ax - f * ex, y - ay - f * ey));
    if (ay > y !== by > y && x < ax + ((y - ay) * ex) / ey) inside = !inside;
  });
  return capsule ? nearest - robot.radius : inside ? -nearest : nearest;
}

/** Largest distance of a point of the robot from its base, m. */
function reachOf(robot) {
  const capsule = robot.outline.length === 2 ? robot.radius : 0;
  return robot.outline.reduce((far, [x, y]) => Math.max(far, Math.hypot(x, y) + capsule), 0) ||
    robot.radius;
}

/** Gap between a robot's surface and a person's at sample k, m; Infinity if the person is absent. */
function gapAt(run, robot, p, k) {
  const { scale, x, y } = run.people;
  const i = p * run.n + k;
  if (x[i] === ABSENT) return Infinity;
  const [dx, dy] = [x[i] * scale - robot.x[k], y[i] * scale - robot.y[k]];
  return fromRobot(robot, robot.theta[k], dx, dy) - radiusOf(run.people, p);
}

/** Smallest gap to a person at each sample, m; NaN if no one is present. */
function clearanceOf(run, robot) {
  const gaps = new Float64Array(run.n).fill(Infinity);
  const { count, scale, x, y } = run.people;
  const far = reachOf(robot);
  for (let p = 0; p < count; p++) {
    const own = radiusOf(run.people, p);
    for (let k = 0; k < run.n; k++) {
      const i = p * run.n + k;
      if (x[i] === ABSENT) continue;
      const [dx, dy] = [x[i] * scale - robot.x[k], y[i] * scale - robot.y[k]];
      if (!(Math.hypot(dx, dy) - far - own < gaps[k])) continue; // farther than another person, or absent
      gaps[k] = Math.min(gaps[k], fromRobot(robot, robot.theta[k], dx, dy) - own);
    }
  }
  return gaps.map((gap) => (gap === Infinity ? NaN : gap));
}

/** Rectangle that shows all: walls, blocks, goal and robots; and people if nothing else has a place. */
function boundsOf(runs) {
  const box = { x0: Infinity, y0: Infinity, x1: -Infinity, y1: -Infinity };
  const grow = (x, y) => {
    if (!Number.isFinite(x) || !Number.isFinite(y)) return;
    box.x0 = Math.min(box.x0, x);
    box.x1 = Math.max(box.x1, x);
    box.y0 = Math.min(box.y0, y);
    box.y1 = Math.max(box.y1, y);
  };
  for (const run of runs) growByRun(run, grow);
  if (box.x0 > box.x1) grow(0, 0);
  return { x0: box.x0 - 1.2, y0: box.y0 - 0.6, x1: box.x1 + 1.2, y1: box.y1 + 0.6 };
}

function growByRun(run, grow) {
  for (const [x0, y0, x1, y1] of run.walls) {
    grow(x0, y0);
    grow(x1, y1);
  }
  for (const [x, y] of [...run.blocks, ...run.steps].flat()) grow(x, y);
  for (const [x, y] of run.zone) grow(x, y);
  for (const robot of run.robots) robot.x.forEach((x, k) => grow(x, robot.y[k]));
  if (!run.people || run.walls.length || run.blocks.length) return;
  const { x: xs, y: ys, scale } = run.people;
  xs.forEach((x, i) => { if (x !== ABSENT) grow(x * scale, ys[i] * scale); });
}
