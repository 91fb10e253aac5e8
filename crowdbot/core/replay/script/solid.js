// The view in three dimensions of a run; what it shows comes from the same numbers as the plan.

const LEAST_RATIO = 0.5;
const IDLE = 4000; // ms; after this time nothing was drawn since nothing was asked for

/** Prepares the view on a canvas of its own; needs THREE. */
function makeSolid(canvas, run, bounds) {
  THREE.ColorManagement.enabled = false; // colours as they are: no powers for each pixel
  const renderer = new THREE.WebGLRenderer({ canvas, antialias: false, powerPreference: "low-power" });
  renderer.outputColorSpace = "srgb-linear";
  const scene = new THREE.Scene();
  const world = new THREE.Group(); // z up, in a scene whose y is up
  world.rotation.x = -Math.PI / 2;
  scene.add(world);
  const sky = new THREE.HemisphereLight(0xffffff, 0x9a958a, 3.1);
  const sun = new THREE.DirectionalLight(0xffffff, 1.8);
  sun.position.set(3, 10, 5);
  const { light } = run.solids;
  if (light) lightUp(light, sun, sky);
  scene.add(sky, sun);
  const rig = new THREE.Group();
  const camera = new THREE.PerspectiveCamera(50, 1, 0.05, 300);
  const upright = new THREE.Group();
  upright.rotation.x = Math.PI / 2; // headsets count y as up
  upright.add(camera);
  rig.add(upright);
  const solids = run.solids;
  const parts = {
    floor: makeFloor(bounds), obstacles: makeObstacles(solids), goals: makeGoals(run.robots),
    people: makePeople(run.people, solids), points: pointCloud(), thoughts: markLines(), cones: markLines(), signs: makeSigns(),
    robots: run.robots.map((robot, i) => makeRobot(robot, solids.robots[i])), ways: run.robots.map(wayLine),
  };
  parts.wanted = makeWanted(run.robots, parts.goals.wanted, parts.people.height);
  world.add(rig, parts.floor.group, parts.obstacles.group, parts.goals.group, parts.wanted, parts.people.group, parts.points, parts.thoughts, parts.cones, parts.signs, ...parts.robots, ...parts.ways);
  const solid = { canvas, run, renderer, scene, rig, camera, upright, parts, frames: 0, before: 0, slow: 0, ratio: 1 };
  paintSolid(solid);
  return solid;
}

/** Sets direction, strength and colour of a scenario's light; z is up in the world, y in the scene. */
function lightUp(light, sun, sky) {
  const [x, y, z] = light.towards;
  sun.position.set(10 * x, 10 * z, -10 * y);
  sun.intensity *= light.sun;
  sun.color.set(light.colour);
  sky.intensity *= light.ambient;
}

/** Takes over the colours of the style sheet. */
function paintSolid({ scene, parts, run }) {
  const colour = (name) => new THREE.Color(colours[name]);
  const { light } = run.solids;
  const sky = light ? new THREE.Color(light.sky) : colour("floor").lerp(colour("accent"), 0.18);
  scene.background = sky;
  scene.fog = new THREE.Fog(sky, 25, 90);
  parts.floor.material.color = colour("grid-strong");
  parts.floor.grid.color = colour("muted").lerp(colour("grid-strong"), 0.75);
  parts.obstacles.material.color = colour("muted").lerp(colour("floor"), 0.6);
  parts.obstacles.marks.color = colour("robot");
  parts.goals.material.color = colour("goal");
  parts.goals.wanted.color = colour("goal");
  parts.points.material.color = colour("lidar");
  parts.thoughts.material.color = colour("thought");
  parts.cones.material.color = colour("sonar");
  clearSigns(parts.signs);
  for (const way of parts.ways) way.material.color = colour("robot");
}

/** Draws a frame from an eye; `options`: {hiddenPerson, hiddenRobot, low, points, cones, thoughts}. */
function drawSolid(solid, frame, eye, options) {
  const { renderer, canvas, parts, run } = solid;
  const ratio = keepUp(solid);
  const width = Math.max(1, canvas.clientWidth || canvas.width);
  const height = Math.max(1, canvas.clientHeight || canvas.height);
  if (!renderer.xr.isPresenting) {
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      renderer.setPixelRatio(ratio);
      renderer.setSize(width, height, false);
    }
    placeEye(solid, eye, width / height);
  }
  parts.obstacles.group.scale.z = options.low ? 0.35 : 1; // from outside, walls hide nothing
  parts.people.sight = sightOf(solid.camera, renderer.xr.isPresenting); // a headset turns by itself
  if (run.people) moveWanted(parts.wanted, frame);
  if (run.people) movePeople(parts.people, run, frame, options.hiddenPerson ?? -1);
  moveRobots(parts.robots, frame.robots, options.hiddenRobot ?? -1);
  movePoints(parts.points, options.points ? frame.scans : [], lidarHeight(run));
  moveCones(parts.cones, options.cones ? frame.cones : [], lidarHeight(run));
  moveThoughts(parts.thoughts, run, frame, options.thoughts);
  moveSigns(parts.signs, run, frame, options.thoughts);
  moveWays(parts.ways, run.robots, frame.k);
  renderer.render(solid.scene, solid.camera);
  solid.frames += 1;
}

/** Pixels for each CSS pixel: fewer where no graphics card draws them fast enough. */
function keepUp(solid) {
  const now = performance.now();
  const passed = now - solid.before;
  solid.before = now;
  if (passed < IDLE) solid.slow += 0.15 * (Math.min(passed, 400) - solid.slow);
  if (passed < IDLE && solid.slow > 36 && solid.ratio > LEAST_RATIO) {
    solid.ratio = Math.max(LEAST_RATIO, 0.8 * solid.ratio);
    solid.slow = 25;
  }
  return Math.min(solid.ratio, window.devicePixelRatio || 1);
}

/** Height of the first robot's first lidar above the floor, m. */
function lidarHeight({ solids }) {
  const first = solids.robots[0];
  return first ? first.base + (Object.values(first.lidars)[0] ?? 0) : 0;
}
