// Where everything is at any time. Person p at sample k is word p * n + k.

const SLOW = 0.15; // m/s; slower people keep their heading
const SPAN = 3; // samples on either side for speed and heading

function sampleAt(run, time) {
  let low = 0;
  let high = run.n - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (run.t[middle] <= time) low = middle;
    else high = middle;
  }
  if (run.n === 1) return { k: 0, f: 0 };
  const f = (time - run.t[low]) / (run.t[low + 1] - run.t[low]);
  return { k: low, f: Math.min(1, Math.max(0, f)) };
}

function turn(a, b, f) {
  const d = Math.atan2(Math.sin(b - a), Math.cos(b - a));
  return a + f * d;
}

function robotAt(run, time, robot = run.robot) {
  const { k, f } = sampleAt(run, time);
  const { x, y, theta, v } = robot;
  const j = Math.min(k + 1, run.n - 1);
  const mix = (a) => a[k] + f * (a[j] - a[k]);
  return { x: mix(x), y: mix(y), theta: turn(theta[k], theta[j], f), v: mix(v) };
}

/** Speed (m/s) and heading (rad) of everybody at every sample, never across a jump. */
function prepare(run) {
  const people = run.people;
  if (!people) return;
  const { count, scale, x, y, jumps } = people;
  const n = run.n;
  people.speed = new Float32Array(count * n);
  people.heading = new Float32Array(count * n);
  const joined = (p, k) =>
    x[p * n + k] !== ABSENT && x[p * n + k + 1] !== ABSENT && !jumps.has(k * count + p);
  for (let p = 0; p < count; p++) {
    let heading = NaN;
    let from = 0; // first sample of the stretch without a break
    for (let k = 0; k < n; k++) {
      if (k > 0 && !joined(p, k - 1)) from = k;
      const a = Math.max(from, k - SPAN);
      let b = k;
      while (b < Math.min(n - 1, k + SPAN) && joined(p, b)) b++;
      const i = p * n + k;
      if (x[i] === ABSENT || a === b) {
        people.heading[i] = heading;
        continue;
      }
      const dx = (x[p * n + b] - x[p * n + a]) * scale;
      const dy = (y[p * n + b] - y[p * n + a]) * scale;
      people.speed[i] = Math.hypot(dx, dy) / (run.t[b] - run.t[a]);
      if (people.speed[i] > SLOW) heading = Math.atan2(dy, dx);
      people.heading[i] = heading;
    }
  }
}

/** Everybody who is there: arrays x, y, speed, heading, person, and how many. */
function peopleAt(run, time, out) {
  const { k, f } = sampleAt(run, time);
  const { count, scale, x, y, speed, heading, jumps } = run.people;
  const n = run.n;
  out.size = 0;
  for (let p = 0; p < count; p++) {
    const a = p * n + k;
    const b = k + 1 < n ? a + 1 : a;
    const whole = x[a] !== ABSENT && x[b] !== ABSENT && !jumps.has(k * count + p);
    const g = whole ? f : Math.round(f);
    const near = g < 0.5 ? a : b;
    if (x[near] === ABSENT) continue;
    const other = whole ? b : near;
    const first = whole ? a : near;
    const i = out.size++;
    out.x[i] = (x[first] + g * (x[other] - x[first])) * scale;
    out.y[i] = (y[first] + g * (y[other] - y[first])) * scale;
    out.speed[i] = speed[near];
    out.heading[i] = heading[near];
    out.person[i] = p;
  }
  return out;
}

function radiusOf(people, p) {
  return people.radius.length > 1 ? people.radius[p] : people.radius[0];
}

/** Index of the last of some rising times that is not after `time`; -1 before the first. */
function lastBefore(times, time) {
  let j = -1;
  let high = times.length;
  while (high - j > 1) {
    const middle = (j + high) >> 1;
    if (times[middle] <= time + 1e-9) j = middle;
    else high = middle;
  }
  return j;
}

/** Where a sensor is in the world and where it looks, with the robot at some pose. */
function mounted(robot, [mx, my, , yaw]) {
  const [c, s] = [Math.cos(robot.theta), Math.sin(robot.theta)];
  return { x: robot.x + c * mx - s * my, y: robot.y + s * mx + c * my, yaw: robot.theta + yaw };
}

/** What a group of cones read last, in the world; only those to which something came back. */
function conesAt(run, group, time) {
  const j = lastBefore(group.t, time);
  if (j < 0) return [];
  const robot = robotAt(run, group.t[j]);
  return group.sensors.flatMap(({ mount, edges }, i) => {
    const range = group.ranges[i * group.t.length + j] * 0.01;
    if (range <= 0) return [];
    const { x, y, yaw } = mounted(robot, mount);
    return [{ x, y, range, from: yaw + Math.min(...edges), to: yaw + Math.max(...edges) }];
  });
}

/** Points a lidar saw in its latest scan, in the world; from the robot's pose at that time. */
function scanAt(run, scan, time) {
  const j = lastBefore(scan.t, time);
  if (j < 0) return null;
  if (scan.cached?.j === j) return scan.cached;
  const { x, y, yaw } = mounted(robotAt(run, scan.t[j]), scan.mount);
  const rim = scan.angles.map((angle, i) => {
    const word = scan.ranges[i * scan.t.length + j];
    const range = word > 0 ? word * 0.01 : scan.rangeMax;
    const along = yaw + angle;
    return { x: x + range * Math.cos(along), y: y + range * Math.sin(along), hit: word > 0 };
  });
  scan.cached = { j, x, y, rim };
  return scan.cached;
}

/** The smallest gap between the robot's surface and anybody's at sample k, m. */
function clearanceAt(run, k) {
  const { count, scale, x, y } = run.people;
  let gap = Infinity;
  for (let p = 0; p < count; p++) {
    const i = p * run.n + k;
    if (x[i] === ABSENT) continue;
    const [dx, dy] = [x[i] * scale - run.robot.x[k], y[i] * scale - run.robot.y[k]];
    gap = Math.min(gap, fromRobot(run.robot, k, dx, dy) - radiusOf(run.people, p));
  }
  return gap;
}

/** Distance of a point beside the robot's base from its surface, m; negative inside. */
function fromRobot(robot, k, dx, dy) {
  const corners = robot.outline;
  if (!corners.length) return Math.hypot(dx, dy) - robot.radius;
  const [c, s] = [Math.cos(robot.theta[k]), Math.sin(robot.theta[k])];
  const [x, y] = [c * dx + s * dy, c * dy - s * dx];
  const capsule = corners.length === 2;
  let nearest = Infinity;
  let inside = false;
  corners.forEach(([ax, ay], i) => {
    const [bx, by] = corners[(i + 1) % corners.length];
    const [ex, ey] = [bx - ax, by - ay];
    const along = ((x - ax) * ex + (y - ay) * ey) / (ex * ex + ey * ey || 1);
    const f = Math.min(1, Math.max(0, along));
    nearest = Math.min(nearest, Math.hypot(x - ax - f * ex, y - ay - f * ey));
    if (ay > y !== by > y && x < ax + ((y - ay) * ex) / ey) inside = !inside;
  });
  return capsule ? nearest - robot.radius : inside ? -nearest : nearest;
}

/** Rectangle that shows all: walls, goal and robot; people too where there are no walls. */
function boundsOf(run) {
  const box = { x0: Infinity, y0: Infinity, x1: -Infinity, y1: -Infinity };
  const grow = (x, y) => {
    if (!Number.isFinite(x) || !Number.isFinite(y)) return;
    box.x0 = Math.min(box.x0, x);
    box.x1 = Math.max(box.x1, x);
    box.y0 = Math.min(box.y0, y);
    box.y1 = Math.max(box.y1, y);
  };
  for (const [x0, y0, x1, y1] of run.walls) {
    grow(x0, y0);
    grow(x1, y1);
  }
  for (const [x, y] of run.zone) grow(x, y);
  if (run.robot) run.robot.x.forEach((x, k) => grow(x, run.robot.y[k]));
  if (run.people && !run.walls.length) {
    run.people.x.forEach((x, i) => {
      if (x !== ABSENT) grow(x * run.people.scale, run.people.y[i] * run.people.scale);
    });
  }
  if (box.x0 > box.x1) grow(0, 0);
  return { x0: box.x0 - 1.2, y0: box.y0 - 0.6, x1: box.x1 + 1.2, y1: box.y1 + 0.6 };
}
