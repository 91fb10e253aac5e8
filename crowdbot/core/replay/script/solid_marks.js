// What is not a body in three dimensions: a planner's tracks, paths and points; cones of ultrasonic sensors.

const MOST_LINES = 4000; // pieces
const TRACK_HEIGHT = 1.95; // m; above heads, so that people do not hide their tracks
const ON_FLOOR = 0.03; // m
const CONE_PIECES = 6;

function markLines() {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(6 * MOST_LINES), 3).setUsage(THREE.DynamicDrawUsage));
  const lines = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial());
  lines.frustumCulled = false;
  return lines;
}

/** Shows what `add` puts with a function of two ends {x, y, z}. */
function moveLines({ geometry }, add) {
  const place = geometry.attributes.position;
  let n = 0;
  add((x0, y0, z0, x1, y1, z1) => {
    if (n + 2 > 2 * MOST_LINES) return;
    place.setXYZ(n, x0, y0, z0);
    place.setXYZ(n + 1, x1, y1, z1);
    n += 2;
  });
  geometry.setDrawRange(0, n);
  place.needsUpdate = true;
}

/** A cross above the head, a pole down to the floor, and a line to where the track would be. */
function addTrack(put, x, y, vx, vy) {
  const r = 0.12;
  put(x - r, y, TRACK_HEIGHT, x + r, y, TRACK_HEIGHT);
  put(x, y - r, TRACK_HEIGHT, x, y + r, TRACK_HEIGHT);
  put(x, y, ON_FLOOR, x, y, TRACK_HEIGHT);
  put(x, y, ON_FLOOR, x + AHEAD * vx, y + AHEAD * vy, ON_FLOOR);
}

/** A small cross on the floor. */
function addPoint(put, x, y) {
  const r = 0.05;
  put(x - r, y, ON_FLOOR, x + r, y, ON_FLOOR);
  put(x, y - r, ON_FLOOR, x, y + r, ON_FLOOR);
}

/** Shows the latest drawing of each name, but texts. */
function moveThoughts(lines, run, frame, shows) {
  moveLines(lines, (put) => {
    for (const { name, t, starts, rows, tracks, which, columns: [x, y, vx, vy] } of shows ? run.drawings ?? [] : []) {
      const j = lastBefore(t, frame.time);
      if (j < 0 || frame.time - t[j] > THOUGHT_AGE || which?.[starts[j]] >= 0) continue;
      for (let i = starts[j]; i < starts[j] + rows[j]; i++) {
        if (tracks) addTrack(put, x[i], y[i], vx[i], vy[i]);
        else if (name.startsWith("points")) addPoint(put, x[i], y[i]);
        else if (name.startsWith("arrows") ? (i - starts[j]) % 2 : i > starts[j]) put(x[i - 1], y[i - 1], ON_FLOOR, x[i], y[i], ON_FLOOR);
      }
    }
  });
}

/** Shows the cones in which an obstacle is somewhere on the arc, at a height, m. */
function moveCones(lines, cones, z) {
  moveLines(lines, (put) => {
    for (const { x, y, range, from, to } of cones) {
      const at = (k) => from + (k * (to - from)) / CONE_PIECES;
      const end = (k) => [x + range * Math.cos(at(k)), y + range * Math.sin(at(k)), z];
      put(x, y, z, ...end(0));
      put(x, y, z, ...end(CONE_PIECES));
      for (let k = 0; k < CONE_PIECES; k++) put(...end(k), ...end(k + 1));
    }
  });
}
