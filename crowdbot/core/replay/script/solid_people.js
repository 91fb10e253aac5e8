// People in three dimensions, as sensors know their bodies: two swinging legs, two arms, trunk, head.
// Proportions and gait are those of crowdbot/core/sensing/body_model.py.

const BODY = { hip: 0.53, stride: 0.83, apart: 0.086, shoulder: 0.82, head: 0.06, swing: 0.19, full: 0.6, disc: 0.33 };
const CLOTHES = ["#bf4033", "#3359a6", "#40804d", "#d9b34d", "#734d80", "#4d4d52", "#d9d1c7", "#4d99a6"];
const TROUSERS = ["#292e42", "#403833", "#38475c"];
const SKINS = ["#e0b594", "#c68e68", "#8d5a3b", "#f0d0b0"];
const THINGS = { // ahead, to the left, half width, bottom, top, m
  wheelchair_user: [0, 0, 0.28, 0.1, 0.6], stroller: [0.75, 0, 0.25, 0.05, 1], suitcase: [-0.55, -0.15, 0.16, 0, 0.6],
};
const PARTS = [ // name, pieces of each person
  ["leg", 2], ["arm", 2], ["trunk", 1], ["head", 1], ["thing", 1],
];

function partGeometry(name) {
  if (name === "head") return new THREE.SphereGeometry(1, 8, 6).scale(1, 1, 0.5);
  if (name === "thing") return new THREE.BoxGeometry(1, 1, 1);
  return new THREE.CylinderGeometry(1, name === "leg" ? 0.75 : 0.85, 1, name === "trunk" ? 8 : 6).rotateX(Math.PI / 2); // along z
}

function partColour(name, p, piece) {
  if (name === "head") return SKINS[(p * 7) % SKINS.length];
  if (name === "leg") return TROUSERS[p % TROUSERS.length];
  return name === "thing" ? "#4d4d57" : piece >= 0 && CLOTHES[p % CLOTHES.length];
}

function makePeople(people, solids) {
  const count = Math.max(1, people?.count ?? 0);
  const group = new THREE.Group();
  const material = new THREE.MeshLambertMaterial();
  const parts = {};
  for (const [name, pieces] of PARTS) {
    const mesh = new THREE.InstancedMesh(partGeometry(name), material, count * pieces);
    mesh.instanceMatrix.setUsage(THREE.DynamicDrawUsage);
    mesh.frustumCulled = false;
    const colour = new THREE.Color();
    for (let i = 0; i < count * pieces; i++) mesh.setColorAt(i, colour.set(partColour(name, Math.floor(i / pieces), i % pieces)));
    parts[name] = mesh;
    group.add(mesh);
  }
  const heights = solids?.people?.height ?? [1.7];
  return {
    group, parts, figures: makeFigures(solids?.people?.figures, count, group), eye: null, walked: new Float32Array(count), time: NaN, facing: new Float32Array(count),
    height: (p) => heights[heights.length > 1 ? p : 0] ?? 1.7,
    look: (p) => solids?.people?.look[p] ?? "",
  };
}

const scratch = {};

/** Places one piece: from a lower to an upper point, with half widths along and across the heading. */
function placePiece(mesh, i, [x0, y0, z0], [x1, y1, z1], along, across, heading) {
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
  mesh.setMatrixAt(i, s.m.compose(s.at, s.q, s.size.set(along, across, length)));
}

/** Poses one person; `row` is the place among those drawn, `p` the person. */
function posePerson(crowd, row, p, x, y, heading, speed, radius) {
  const { parts } = crowd;
  const h = crowd.height(p);
  const kind = crowd.look(p);
  const sits = kind === "wheelchair_user";
  const scale = Math.min(1, radius / BODY.disc);
  const hip = sits ? 0.5 : BODY.hip * h;
  const [c, s] = [Math.cos(heading), Math.sin(heading)];
  const at = (ahead, left, z) => [x + c * ahead - s * left, y + s * ahead + c * left, z];
  const wide = Math.min(1, speed / BODY.full) * scale * (sits ? 0 : 1);
  const swing = BODY.swing * wide * Math.sin((2 * Math.PI * crowd.walked[p]) / (BODY.stride * h) + p);
  const shoulder = sits ? 0.5 + 0.45 * h : BODY.shoulder * h;
  const trunk = 0.1295 * h * scale;
  for (const side of [1, -1]) {
    const i = 2 * row + (side < 0 ? 1 : 0);
    const foot = side * swing + (sits ? 0.38 : 0);
    placePiece(parts.leg, i, at(foot, side * BODY.apart * h * scale, 0), at(0, 0.8 * side * BODY.apart * h * scale, hip + 0.03), 0.07 * scale + 0.01, 0.07 * scale + 0.01, heading);
    placePiece(parts.arm, i, at(-side * swing + 0.04, side * (trunk + 0.05), shoulder - 0.33 * h), at(0, side * (trunk + 0.02), shoulder - 0.02), 0.035, 0.035, heading);
  }
  placePiece(parts.trunk, row, at(0, 0, hip - 0.02), at(0, 0, shoulder), 0.62 * trunk, trunk, heading);
  const top = sits ? shoulder + 0.18 * h : h;
  placePiece(parts.head, row, at(0.02, 0, top - 2 * BODY.head * h), at(0.02, 0, top), 0.8 * BODY.head * h, 0.75 * BODY.head * h, heading);
  const [ahead, left, half, low, high] = THINGS[kind] ?? [0, 0, 0.001, 0, 0.002];
  placePiece(parts.thing, row, at(ahead, left, low), at(ahead, left, high), 2 * half, 2 * half, heading);
}

/** Moves everyone; `hidden` is the person through whose eyes the view looks. */
function movePeople(crowd, run, frame, hidden) {
  const { x, y, speed, heading, person, size } = frame.people;
  const passed = frame.time - crowd.time;
  crowd.time = frame.time;
  let row = 0;
  eachFigure(crowd, (mesh) => { mesh.count = 0; });
  for (let i = 0; i < size; i++) {
    const p = person[i];
    if (passed > 0 && passed < 1) crowd.walked[p] += speed[i] * passed;
    if (!Number.isNaN(heading[i])) crowd.facing[p] = heading[i];
    if (p === hidden) continue;
    if (hasFigure(crowd, p, x[i], y[i])) {
      placeFigure(crowd, p, x[i], y[i], crowd.facing[p]);
      continue;
    }
    posePerson(crowd, row, p, x[i], y[i], crowd.facing[p], speed[i], radiusOf(run.people, p));
    row += 1;
  }
  eachFigure(crowd, (mesh) => { mesh.instanceMatrix.needsUpdate = true; });
  for (const [name, pieces] of PARTS) {
    crowd.parts[name].count = row * pieces;
    crowd.parts[name].instanceMatrix.needsUpdate = true;
  }
}
