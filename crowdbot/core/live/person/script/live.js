// The run as it comes: static parts are sent once, moving ones sixteen times a second.

const shown = { topSpeed: 1.6, run: null, frame: null, earlier: null, driven: 0, latest: null, wrote: 0 };

/** Prepares a run of which nothing is known yet but the scene. */
function takeScene(scene) {
  const room = () => new Float64Array(scene.people.count);
  shown.run = {
    ...scene, n: 0, t: [], contacts: [], drawings: [],
    robots: scene.robots.map((robot) => ({ ...robot, x: [], y: [], theta: [], v: [], w: [] })),
    buffer: { x: room(), y: room(), speed: room(), heading: room().fill(NaN), person: room(), size: 0 },
  };
  shown.driven = scene.driven;
  shown.walker = scene.walker;
  shown.frame = shown.earlier = shown.latest = null;
  if (scene.walker >= 0 && scene.yaw !== undefined && !shown.yawSet) {
    hand.yaw = scene.yaw;
    shown.yawSet = true;
  }
}

/** Takes one sample: pose of each robot, x, y, vx, vy of people. */
function takeFrame({ t, robots, people, scans, drawings }) {
  const { run } = shown;
  if (!run || (run.n && t <= run.t[run.n - 1])) return;
  run.t.push(t);
  run.n += 1;
  run.robots.forEach((robot, i) => {
    const row = robots[i] ?? [NaN, NaN, NaN, NaN, NaN];
    ["x", "y", "theta", "v", "w"].forEach((name, c) => robot[name].push(row[c] === null ? NaN : row[c] / 1000));
  });
  drawings.forEach(takeDrawing);
  shown.earlier = shown.latest;
  shown.latest = { t, at: performance.now(), people, scans };
}

/** Keeps the latest drawing of each name of a planner, as the replay page has them. */
function takeDrawing({ robot, name, t, tracks, columns, texts }) {
  const { drawings } = shown.run;
  const drawing = { robot, name, tracks, t: [t], starts: [0], rows: [columns[0].length], columns, texts };
  if (texts) drawing.which = texts.map((_, k) => k);
  const i = drawings.findIndex((one) => one.robot === robot && one.name === name);
  drawings.splice(i < 0 ? drawings.length : i, i < 0 ? 0 : 1, drawing);
}

/** The picture at a moment: between the last two samples. */
function frameNow(now) {
  const { run, latest, earlier } = shown;
  if (!run || !latest) return null;
  const every = earlier ? latest.t - earlier.t : 0;
  const f = every ? clamp((now - latest.at) / 1000 / every, 0, 1) : 1;
  const k = run.n - 1;
  const time = every ? earlier.t + f * every : latest.t;
  const robots = run.robots.map((robot) => robotAt(run, robot, time));
  return { time: latest.t, k, robots, people: peopleBetween(f), scans: scansNow(), cones: [] };
}

function peopleBetween(f) {
  const { latest, earlier, run: { buffer } } = shown;
  buffer.size = 0;
  const [x, y, vx, vy] = latest.people;
  for (let p = 0; p < (x?.length ?? 0); p++) {
    if (x[p] === null) continue;
    const i = buffer.size++;
    const from = earlier?.people[0]?.[p] ?? null;
    const near = from !== null && Math.hypot(x[p] - from, y[p] - earlier.people[1][p]) < 2000;
    const mix = (now, before) => (near ? before + f * (now - before) : now) / 1000;
    buffer.x[i] = mix(x[p], earlier?.people[0]?.[p]);
    buffer.y[i] = mix(y[p], earlier?.people[1]?.[p]);
    buffer.speed[i] = Math.hypot(vx[p], vy[p]) / 1000;
    buffer.heading[i] = buffer.speed[i] > SLOW ? Math.atan2(vy[p], vx[p]) : buffer.heading[i];
    buffer.person[i] = p;
  }
  return buffer;
}

/** Latest points of flat lidars. */
function scansNow() {
  return shown.latest.scans.map(({ x, y, z, hits }) => {
    const rim = [];
    for (let i = 0; i < hits.length; i += 2) rim.push({ x: hits[i], y: hits[i + 1], hit: true });
    return { x, y, z, rim };
  });
}

/** The body that the person moves: {x, y, theta, v, w}. */
function ownBody(frame) {
  if (shown.walker < 0) return frame.robots[shown.driven];
  const i = placeOf(frame.people, shown.walker);
  if (i < 0) return null;
  return { x: frame.people.x[i], y: frame.people.y[i], theta: hand.yaw, v: frame.people.speed[i], w: 0 };
}
