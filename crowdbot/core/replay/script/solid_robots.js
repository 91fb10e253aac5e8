// Robots in three dimensions, by the visible shapes of their descriptions; points of lidars; ways.

const MOST_POINTS = 6000;
const MOST_WAY = 20000;

function makeRobot(about, solid) {
  const group = new THREE.Group();
  const body = new THREE.Group();
  body.position.z = solid?.base ?? 0;
  group.add(body);
  if (solid?.parts.length) body.add(shapesTogether(solid.parts));
  else group.add(plainRobot(about, solid?.height ?? 0.5));
  return group;
}

/** One body of all visible shapes: one call of the graphics card for each robot. */
function shapesTogether(parts) {
  const [corners, normals, shades] = [[], [], []];
  const shade = new THREE.Color();
  for (const [colour, points] of parts) {
    const { attributes } = new THREE.ConvexGeometry(points.map(([x, y, z]) => new THREE.Vector3(x, y, z)));
    shade.set(colour);
    for (const v of attributes.position.array) corners.push(v);
    for (const v of attributes.normal.array) normals.push(v);
    for (let i = 0; i < attributes.position.count; i++) shades.push(shade.r, shade.g, shade.b);
  }
  const geometry = new THREE.BufferGeometry();
  for (const [name, values] of Object.entries({ position: corners, normal: normals, color: shades })) {
    geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(values), 3));
  }
  return new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ vertexColors: true }));
}

/** A robot of which only outline and height are known. */
function plainRobot({ radius, outline }, height) {
  const rim = outline.length > 2 ? outline : Array.from({ length: 20 }, (_, i) => {
    const angle = (i * Math.PI) / 10;
    const [cx, cy] = outline.length === 2 ? outline[Math.cos(angle) > 0 ? 1 : 0] : [0, 0];
    return [cx + radius * Math.cos(angle), cy + radius * Math.sin(angle)];
  });
  return prisms((corners, normals) => addPrism(corners, normals, rim, 0.03, height), new THREE.MeshLambertMaterial({ color: "#8a8d91", side: THREE.DoubleSide }));
}

function pointCloud() {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * MOST_POINTS), 3).setUsage(THREE.DynamicDrawUsage));
  const points = new THREE.Points(geometry, new THREE.PointsMaterial({ size: 4, sizeAttenuation: false }));
  points.frustumCulled = false;
  return points;
}

function wayLine() {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * MOST_WAY), 3).setUsage(THREE.DynamicDrawUsage));
  const line = new THREE.Line(geometry, new THREE.LineBasicMaterial());
  line.frustumCulled = false;
  return line;
}

/** Moves robots; those that have left are hidden. */
function moveRobots(groups, poses, hidden) {
  groups.forEach((group, i) => {
    const pose = poses[i];
    group.visible = Boolean(pose) && Number.isFinite(pose.x) && i !== hidden;
    if (!group.visible) return;
    group.position.set(pose.x, pose.y, 0);
    group.rotation.z = pose.theta;
  });
}

/** Shows the points that lidars saw. */
function movePoints(points, scans, height) {
  const place = points.geometry.attributes.position;
  let n = 0;
  for (const scan of scans) {
    for (const { x, y, hit } of scan.rim) {
      if (!hit || n >= MOST_POINTS) continue;
      place.setXYZ(n, x, y, scan.z ?? height);
      n += 1;
    }
  }
  points.geometry.setDrawRange(0, n);
  place.needsUpdate = true;
}

/** Shows the ways of robots until now. */
function moveWays(lines, robots, k) {
  lines.forEach((line, i) => {
    const place = line.geometry.attributes.position;
    const first = Math.max(0, k + 1 - MOST_WAY);
    let n = 0;
    for (let j = first; j <= k; j++) {
      if (Number.isFinite(robots[i].x[j])) place.setXYZ(n++, robots[i].x[j], robots[i].y[j], 0.02);
    }
    line.geometry.setDrawRange(0, n);
    place.needsUpdate = true;
  });
}
