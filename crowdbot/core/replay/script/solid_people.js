// People in three dimensions, as sensors know their bodies: two swinging legs, two arms, trunk, head.
// Proportions and gait are those of crowdbot/core/sensing/body_model.py.

const BODY = { hip: 0.53, stride: 0.83, apart: 0.086, shoulder: 0.82, head: 0.06, swing: 0.19, full: 0.6, disc: 0.33 };
const THINGS = { // ahead, to the left, half width, bottom, top, m
  wheelchair_user: [0, 0, 0.28, 0.1, 0.6], stroller: [0.75, 0, 0.25, 0.05, 1], suitcase: [-0.55, -0.15, 0.16, 0, 0.6],
};

function makePeople(people, solids) {
  const count = Math.max(1, people?.count ?? 0);
  const group = new THREE.Group();
  const heights = solids?.people?.height ?? [1.7];
  return {
    group, bodies: makeBodies(count, group), figures: makeFigures(solids?.people?.figures, count, group), sight: null, clothes: {},
    walked: new Float32Array(count), time: NaN, facing: new Float32Array(count),
    height: (p) => heights[heights.length > 1 ? p : 0] ?? 1.7,
    look: (p) => solids?.people?.look[p] ?? "",
  };
}

const scratch = {};

/** Adds one piece: from a lower to an upper point, with half widths along and across the heading. */
function addPiece(mesh, colour, [x0, y0, z0], [x1, y1, z1], along, across, heading) {
  const s = scratch;
  s.m ??= new THREE.Matrix4();
  s.q ??= new THREE.Quaternion();
  s.turn ??= new THREE.Quaternion();
  s.up ??= new THREE.Vector3(0, 0, 1);
  s.way ??= new THREE.Vector3();
  s.at ??= new THREE.Vector3();
  s.size ??= new THREE.Vector3();
  s.way.set(x1 - x0, y1 - y0, z1 - z0);
  const length = s.way.length() || 1e-3;
  s.q.setFromUnitVectors(s.up, s.way.divideScalar(length));
  s.q.multiply(s.turn.setFromAxisAngle(s.up, heading));
  s.at.set((x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2);
  mesh.setMatrixAt(mesh.count, s.m.compose(s.at, s.q, s.size.set(along, across, length)));
  mesh.setColorAt(mesh.count, colour);
  mesh.count += 1;
}

/** Adds one person `p` to the parts of a level. */
function posePerson(crowd, parts, p, x, y, heading, speed, radius) {
  const h = crowd.height(p);
  const kind = crowd.look(p);
  const sits = kind === "wheelchair_user";
  const scale = Math.min(1, radius / BODY.disc);
  const hip = sits ? 0.5 : BODY.hip * h;
  const [c, s] = [Math.cos(heading), Math.sin(heading)];
  const at = (ahead, left, z) => [x + c * ahead - s * left, y + s * ahead + c * left, z];
  const add = (name, from, to, along, across) => addPiece(parts[name], personColour(crowd, name, p), from, to, along, across, heading);
  const wide = Math.min(1, speed / BODY.full) * scale * (sits ? 0 : 1);
  const swing = BODY.swing * wide * Math.sin((2 * Math.PI * crowd.walked[p]) / (BODY.stride * h) + p);
  const shoulder = sits ? 0.5 + 0.45 * h : BODY.shoulder * h;
  const trunk = 0.1295 * h * scale;
  for (const side of [1, -1]) {
    const foot = side * swing + (sits ? 0.38 : 0);
    add("leg", at(foot, side * BODY.apart * h * scale, 0), at(0, 0.8 * side * BODY.apart * h * scale, hip + 0.03), 0.07 * scale + 0.01, 0.07 * scale + 0.01);
    add("arm", at(-side * swing + 0.04, side * (trunk + 0.05), shoulder - 0.33 * h), at(0, side * (trunk + 0.02), shoulder - 0.02), 0.035, 0.035);
  }
  add("trunk", at(0, 0, hip - 0.02), at(0, 0, shoulder), 0.62 * trunk, trunk);
  const top = sits ? shoulder + 0.18 * h : h;
  add("head", at(0.02, 0, top - 2 * BODY.head * h), at(0.02, 0, top), 0.8 * BODY.head * h, 0.75 * BODY.head * h);
  if (!THINGS[kind]) return;
  const [ahead, left, half, low, high] = THINGS[kind];
  add("thing", at(ahead, left, low), at(ahead, left, high), 2 * half, 2 * half);
}

/** The colour of a part of a person; made once. */
function personColour({ clothes }, name, p) {
  const text = partColour(name, p);
  clothes[text] ??= new THREE.Color(text);
  return clothes[text];
}

/** Moves everyone; `hidden` is the person through whose eyes the view looks. */
function movePeople(crowd, run, frame, hidden) {
  const { x, y, speed, heading, person, size } = frame.people;
  const passed = frame.time - crowd.time;
  crowd.time = frame.time;
  const all = [...crowd.figures.flat(), ...crowd.bodies.flatMap((parts) => Object.values(parts))];
  for (const mesh of all) mesh.count = 0;
  for (let i = 0; i < size; i++) {
    const p = person[i];
    if (passed > 0 && passed < 1) crowd.walked[p] += speed[i] * passed;
    if (!Number.isNaN(heading[i])) crowd.facing[p] = heading[i];
    const away = distanceSeen(crowd.sight, x[i], y[i]);
    if (p === hidden || away === Infinity) continue;
    if (hasFigure(crowd, p, away)) placeFigure(crowd, p, x[i], y[i], crowd.facing[p]);
    else posePerson(crowd, crowd.bodies[levelOf(away)], p, x[i], y[i], crowd.facing[p], speed[i], radiusOf(run.people, p));
  }
  for (const { instanceMatrix, instanceColor } of all) {
    instanceMatrix.needsUpdate = true;
    if (instanceColor) instanceColor.needsUpdate = true;
  }
}
