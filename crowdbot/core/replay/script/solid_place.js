// What stands in the view in three dimensions: floor, walls, blocks, pillars, goals. World frame, z up.

const WALL_WIDTH = 0.06; // m
const MARK = 0.04; // m; height of walls that stop only robots
const HIGHEST = 3; // m; of walls without end

/** Adds an upright prism over a convex outline to lists of corners and normals. */
function addPrism(corners, normals, outline, bottom, top) {
  const put = (points, normal) => points.forEach((p) => {
    corners.push(...p);
    normals.push(...normal);
  });
  outline.forEach(([ax, ay], i) => {
    const [bx, by] = outline[(i + 1) % outline.length];
    const length = Math.hypot(bx - ax, by - ay) || 1;
    const out = [(by - ay) / length, (ax - bx) / length, 0];
    put([[ax, ay, bottom], [bx, by, bottom], [bx, by, top]], out);
    put([[ax, ay, bottom], [bx, by, top], [ax, ay, top]], out);
    if (i > 0 && i < outline.length - 1) {
      put([[...outline[0], top], [ax, ay, top], [bx, by, top]], [0, 0, 1]);
    }
  });
}

function prisms(add, material) {
  const [corners, normals] = [[], []];
  add(corners, normals);
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(corners), 3));
  geometry.setAttribute("normal", new THREE.BufferAttribute(new Float32Array(normals), 3));
  return new THREE.Mesh(geometry, material);
}

/** Corners of a wall as a thin box, counter-clockwise. */
function wallOutline([x0, y0, x1, y1]) {
  const length = Math.hypot(x1 - x0, y1 - y0) || 1;
  const [ux, uy] = [(0.5 * WALL_WIDTH * (x1 - x0)) / length, (0.5 * WALL_WIDTH * (y1 - y0)) / length];
  return [[x0 - ux + uy, y0 - uy - ux], [x1 + ux + uy, y1 + uy - ux], [x1 + ux - uy, y1 + uy + ux], [x0 - ux - uy, y0 - uy + ux]];
}

/** Walls, blocks and pillars, whose heights may be drawn smaller so that they hide nothing. */
function makeObstacles({ walls, blocks, pillars }) {
  const group = new THREE.Group();
  const material = new THREE.MeshLambertMaterial({ side: THREE.DoubleSide });
  const marks = new THREE.MeshLambertMaterial({ side: THREE.DoubleSide });
  group.add(prisms((corners, normals) => { // nothing stands there: the robot may not go on
    for (const wall of walls) if (wall[6] === 1) addPrism(corners, normals, wallOutline(wall), 0, MARK);
  }, marks));
  group.add(prisms((corners, normals) => {
    for (const wall of walls) if (wall[6] !== 1) addPrism(corners, normals, wallOutline(wall), wall[4], Math.min(wall[5], wall[4] + HIGHEST));
    for (const [outline, bottom, top] of blocks) addPrism(corners, normals, outline, bottom, Math.min(top, bottom + HIGHEST));
    for (const [x, y, radius, bottom, top] of pillars) {
      const rim = Array.from({ length: 16 }, (_, i) => [x + radius * Math.cos((i * Math.PI) / 8), y + radius * Math.sin((i * Math.PI) / 8)]);
      addPrism(corners, normals, rim, bottom, Math.min(top, bottom + HIGHEST));
    }
  }, material));
  return { group, material, marks };
}

function makeFloor(bounds) {
  const group = new THREE.Group();
  const { x0, x1, y0, y1 } = bounds;
  const material = new THREE.MeshBasicMaterial();
  const floor = new THREE.Mesh(new THREE.PlaneGeometry(x1 - x0 + 80, y1 - y0 + 80), material);
  floor.renderOrder = 1; // last: bodies hide much of it
  floor.position.set((x0 + x1) / 2, (y0 + y1) / 2, -0.01);
  const lines = [];
  const [left, right, low, high] = [Math.floor(x0) - 5, Math.ceil(x1) + 5, Math.floor(y0) - 5, Math.ceil(y1) + 5];
  const every = Math.max(1, Math.ceil((right - left + high - low) / 200));
  for (let x = left; x <= right; x += every) lines.push(x, low, 0, x, high, 0);
  for (let y = low; y <= high; y += every) lines.push(left, y, 0, right, y, 0);
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(lines), 3));
  const grid = new THREE.LineBasicMaterial();
  group.add(floor, new THREE.LineSegments(geometry, grid));
  return { group, material, grid };
}

/** Goals of robots, on the floor. */
function makeGoals(robots) {
  const material = new THREE.MeshBasicMaterial({ transparent: true, opacity: 0.35, side: THREE.DoubleSide });
  const group = new THREE.Group();
  for (const { zone, goal, goalRadius } of robots) {
    const rim = zone.length ? zone : !goal ? [] : Array.from({ length: 24 }, (_, i) =>
      [goal[0] + Math.max(goalRadius, 0.3) * Math.cos((i * Math.PI) / 12), goal[1] + Math.max(goalRadius, 0.3) * Math.sin((i * Math.PI) / 12)]);
    if (!rim.length) continue;
    const shape = new THREE.Shape();
    rim.forEach(([x, y], i) => shape[i ? "lineTo" : "moveTo"](x, y));
    const mesh = new THREE.Mesh(new THREE.ShapeGeometry(shape), material);
    mesh.position.z = 0.01;
    group.add(mesh);
  }
  return { group, material, wanted: new THREE.MeshBasicMaterial({ side: THREE.DoubleSide }) };
}

/** Marks of people that robots' tasks are about: a hoop on the floor, and a tip above the head. */
function makeWanted(robots, material, height) {
  const group = new THREE.Group();
  group.userData.people = [];
  for (const p of new Set(robots.flatMap(({ wanted }) => wanted))) {
    const ring = new THREE.Mesh(new THREE.CylinderGeometry(0.45, 0.45, 0.1, 24, 1, true).rotateX(Math.PI / 2), material);
    ring.position.z = 0.05;
    const tip = new THREE.Mesh(new THREE.CylinderGeometry(0.13, 0.01, 0.28, 8).rotateX(Math.PI / 2), material);
    tip.position.z = height(p) + 0.35;
    const mark = new THREE.Group();
    mark.add(ring, tip);
    group.userData.people.push(p);
    group.add(mark);
  }
  return group;
}

function moveWanted(group, { people }) {
  group.userData.people.forEach((p, k) => {
    const i = people.person.subarray(0, people.size).indexOf(p);
    group.children[k].visible = i >= 0;
    if (i >= 0) group.children[k].position.set(people.x[i], people.y[i], 0);
  });
}
