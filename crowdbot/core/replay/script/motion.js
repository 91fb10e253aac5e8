// Positions of all bodies at any time. Person p at sample k is word p * n + k.

const SLOW = 0.15; // m/s; slower people keep their heading
const SPAN = 3; // samples on either side for speed and heading

function sampleAt(run, time) {
  const k = clamp(lastBefore(run.t, time), 0, Math.max(0, run.n - 2));
  if (run.n === 1) return { k: 0, f: 0 };
  return { k, f: clamp((time - run.t[k]) / (run.t[k + 1] - run.t[k]), 0, 1) };
}

/** Index of the last of ascending times that is not after `time`; -1 before the first. */
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

function turn(a, b, f) {
  const d = Math.atan2(Math.sin(b - a), Math.cos(b - a));
  return a + f * d;
}

function robotAt(run, robot, time) {
  const { k, f } = sampleAt(run, time);
  const j = Math.min(k + 1, run.n - 1);
  const mix = (a) => a[k] + f * (a[j] - a[k]);
  const { x, y, theta, v, w } = robot;
  return { x: mix(x), y: mix(y), theta: turn(theta[k], theta[j], f), v: mix(v), w: mix(w) };
}

/** Speed (m/s) and heading (rad) of each person at each sample, never across a jump. */
function prepare(run) {
  const { people, n } = run;
  if (!people) return;
  const { count, x, jumps } = people;
  people.speed = new Float32Array(count * n);
  people.heading = new Float32Array(count * n);
  const room = () => new Float64Array(count);
  run.buffer = { x: room(), y: room(), speed: room(), heading: room(), person: room(), size: 0 };
  const joined = (p, k) =>
    x[p * n + k] !== ABSENT && x[p * n + k + 1] !== ABSENT && !jumps.has(k * count + p);
  for (let p = 0; p < count; p++) preparePerson(run, p, joined);
}

function preparePerson(run, p, joined) {
  const { n, t } = run;
  const { scale, x, y, speed, heading } = run.people;
  let last = NaN;
  let from = 0; // first sample of the stretch without a break
  for (let k = 0; k < n; k++) {
    if (k > 0 && !joined(p, k - 1)) from = k;
    const a = Math.max(from, k - SPAN);
    let b = k;
    while (b < Math.min(n - 1, k + SPAN) && joined(p, b)) b++;
    const i = p * n + k;
    if (x[i] !== ABSENT && a !== b) {
      const dx = (x[p * n + b] - x[p * n + a]) * scale;
      const dy = (y[p * n + b] - y[p * n + a]) * scale;
      speed[i] = Math.hypot(dx, dy) / (t[b] - t[a]);
      if (speed[i] > SLOW) last = Math.atan2(dy, dx);
    }
    heading[i] = last;
  }
}

/** The people present: arrays x, y, speed, heading, person, and their number. */
function peopleAt(run, time) {
  const { k, f } = sampleAt(run, time);
  const { count, scale, x, y, speed, heading, jumps } = run.people;
  const { n, buffer: out } = run;
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

/** Index of a person in a frame's arrays; -1 if absent. */
function placeOf(people, person) {
  for (let i = 0; i < people.size; i++) if (people.person[i] === person) return i;
  return -1;
}

function radiusOf(people, p) {
  return people.radius.length > 1 ? people.radius[p] : people.radius[0];
}

/** The speed at which the colour ramp ends: nearly all people are slower. */
function topSpeedOf(runs) {
  const speeds = runs.flatMap((run) => (run.people
    ? [...run.people.speed.filter((_, i) => i % 13 === 0)] : []));
  if (!speeds.length) return 1;
  const sorted = Float64Array.from(speeds).sort();
  return Math.max(0.5, Math.ceil(10 * sorted[Math.floor(0.97 * (sorted.length - 1))]) / 10);
}
