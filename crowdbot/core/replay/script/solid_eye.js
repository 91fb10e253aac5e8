// Where the view in three dimensions looks from: an eye {x, y, z, yaw, pitch, opening}, m and rad.

const OPENING = { solid: 0.9, person: 1.2, camera: 1.05 }; // vertical, rad
const WIDEST = 1.45; // horizontal, rad; wider pictures stretch what is beside
const EYES = 0.93; // share of the height
const BEHIND = { yaw: Math.PI / 2, pitch: 0.62, far: 9 };

/** From behind and above a place; `around` is {yaw, pitch, far}. */
function eyeAround(place, around) {
  const flat = around.far * Math.cos(around.pitch);
  return {
    x: place.x - flat * Math.cos(around.yaw), y: place.y - flat * Math.sin(around.yaw),
    z: 0.8 + around.far * Math.sin(around.pitch), yaw: around.yaw, pitch: -around.pitch, opening: OPENING.solid,
  };
}

/** Through the eyes of a person of some height. */
function eyeOfPerson(x, y, heading, height, gaze) {
  return { x, y, z: EYES * height, yaw: heading + gaze.yaw, pitch: gaze.pitch - 0.08, opening: OPENING.person };
}

/** As a camera of a robot sees it; of a robot without one, from the front of its top. */
function eyeOfRobot(pose, solid, reach, gaze) {
  const camera = solid?.cameras[0];
  const [mx, my, mz, turned] = camera?.mount ?? [0.8 * reach, 0, 0.95 * (solid?.height ?? 1) - (solid?.base ?? 0), 0];
  const [c, s] = [Math.cos(pose.theta), Math.sin(pose.theta)];
  return {
    x: pose.x + c * mx - s * my, y: pose.y + s * mx + c * my, z: (solid?.base ?? 0) + mz,
    yaw: pose.theta + turned + gaze.yaw, pitch: -(camera?.tilt[1] ?? 0) + gaze.pitch, opening: camera?.opening ?? OPENING.camera,
  };
}

/** Puts the camera and its rig at an eye; the rig stands on the floor, so that a headset stands there. */
function placeEye({ rig, camera }, eye, aspect) {
  rig.position.set(eye.x, eye.y, 0);
  rig.rotation.set(0, 0, eye.yaw - Math.PI / 2);
  camera.position.y = eye.z;
  camera.rotation.x = eye.pitch;
  const widest = 2 * Math.atan(Math.tan(WIDEST / 2) / aspect);
  camera.fov = (180 / Math.PI) * Math.min(eye.opening, widest);
  camera.aspect = aspect;
  camera.updateProjectionMatrix();
}
