// Bodies of people in three dimensions: the fewer triangles, the farther away.

const CLOTHES = ["#bf4033", "#3359a6", "#40804d", "#d9b34d", "#734d80", "#4d4d52", "#d9d1c7", "#4d99a6"];
const TROUSERS = ["#292e42", "#403833", "#38475c"];
const SKINS = ["#e0b594", "#c68e68", "#8d5a3b", "#f0d0b0"];
const PARTS = [ // name, pieces of each person
  ["leg", 2], ["arm", 2], ["trunk", 1], ["head", 1], ["thing", 1],
];
const LEVELS = [ // m from the eye; sides of limbs and trunk, rings of the head
  { within: 10, limb: 6, trunk: 8, rings: 5 },
  { within: 25, limb: 4, trunk: 6, rings: 4 },
  { within: Infinity, limb: 3, trunk: 4, rings: 3 },
];
const BALL = { middle: 0.9, radius: 1.3 }; // a ball that holds a person and its things, m

function partGeometry(name, { limb, trunk, rings }) {
  if (name === "head") return new THREE.SphereGeometry(1, rings + 2, rings).scale(1, 1, 0.5);
  if (name === "thing") return new THREE.BoxGeometry(1, 1, 1);
  // Limbs are open where the trunk, the floor or a shoe hides their ends; along z.
  const hidden = name !== "trunk";
  return new THREE.CylinderGeometry(1, name === "leg" ? 0.75 : 0.85, 1, hidden ? limb : trunk, 1, hidden).rotateX(Math.PI / 2);
}

function partColour(name, p) {
  if (name === "head") return SKINS[(p * 7) % SKINS.length];
  if (name === "leg") return TROUSERS[p % TROUSERS.length];
  return name === "thing" ? "#4d4d57" : CLOTHES[p % CLOTHES.length];
}

/** For each level the meshes of all parts, with room for this many people. */
function makeBodies(count, group) {
  const material = new THREE.MeshLambertMaterial();
  const colour = new THREE.Color();
  return LEVELS.map((level) => Object.fromEntries(PARTS.map(([name, pieces]) => {
    const mesh = new THREE.InstancedMesh(partGeometry(name, level), material, count * pieces);
    mesh.instanceMatrix.setUsage(THREE.DynamicDrawUsage);
    mesh.frustumCulled = false;
    mesh.setColorAt(0, colour); // makes room for colours
    mesh.instanceColor.setUsage(THREE.DynamicDrawUsage);
    group.add(mesh);
    return [name, mesh];
  })));
}

/** The level of a body at a distance from the eye, m. */
const levelOf = (away) => LEVELS.findIndex(({ within }) => away <= within);

/** What a camera can see: its place, direction and widest slope, or all around; y is up in the scene. */
function sightOf(camera, all) {
  camera.updateWorldMatrix(true, false);
  const tall = Math.tan((camera.fov * Math.PI) / 360);
  return {
    at: camera.getWorldPosition(new THREE.Vector3()), ahead: camera.getWorldDirection(new THREE.Vector3()),
    wide: tall * Math.hypot(1, camera.aspect), all,
  };
}

/** How far a person is from the eye, m; infinite where the eye cannot see it. */
function distanceSeen({ at, ahead, wide, all }, x, y) {
  const [dx, dy, dz] = [x - at.x, BALL.middle - at.y, -y - at.z];
  const along = dx * ahead.x + dy * ahead.y + dz * ahead.z;
  const away = Math.hypot(dx, dy, dz);
  const aside = Math.sqrt(Math.max(0, away * away - along * along));
  return all || aside <= along * wide + BALL.radius * Math.hypot(1, wide) ? away : Infinity;
}
