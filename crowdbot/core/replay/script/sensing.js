// Sensor readings at any time, in world coordinates.

/** Position and direction of a sensor in the world for a pose of the robot. */
function mounted(robot, [mx, my, , yaw]) {
  const [c, s] = [Math.cos(robot.theta), Math.sin(robot.theta)];
  return { x: robot.x + c * mx - s * my, y: robot.y + s * mx + c * my, yaw: robot.theta + yaw };
}

/** Turns a direction in the plane of a sensor with roll and pitch into what is seen from above. */
function fromAbove([x, y], tilt) {
  if (!tilt) return [x, y];
  const [roll, pitch] = tilt;
  return [Math.cos(pitch) * x + Math.sin(pitch) * Math.sin(roll) * y, Math.cos(roll) * y];
}

/** The robot that carries a sensor, at some time. */
function carrierAt(run, sensor, time) {
  return robotAt(run, run.robots[sensor.robot ?? 0], time);
}

/** Latest readings of a group of cones; only cones with an echo. */
function conesAt(run, group, time) {
  const j = lastBefore(group.t, time);
  if (j < 0) return [];
  const robot = carrierAt(run, group, group.t[j]);
  return group.sensors.flatMap(({ mount, edges, tilt }, i) => {
    const range = group.ranges[i * group.t.length + j] * 0.01;
    if (range <= 0) return [];
    const { x, y, yaw } = mounted(robot, mount);
    const [along] = fromAbove([range, 0], tilt);
    const back = along < 0 ? Math.PI : 0;
    const [from, to] = [Math.min(...edges), Math.max(...edges)].map((a) => yaw + back + a);
    return [{ x, y, range: Math.abs(along), from, to }];
  });
}

/** Points a lidar saw in its latest scan; from the robot's pose at that time. */
function scanAt(run, scan, time) {
  const j = lastBefore(scan.t, time);
  if (j < 0) return null;
  if (scan.cached?.j === j) return scan.cached;
  const { x, y, yaw } = mounted(carrierAt(run, scan, scan.t[j]), scan.mount);
  const [c, s] = [Math.cos(yaw), Math.sin(yaw)];
  const rim = scan.angles.map((angle, i) => {
    const word = scan.ranges[i * scan.t.length + j];
    const range = word > 0 ? word * 0.01 : scan.rangeMax;
    const [ahead, left] = fromAbove([range * Math.cos(angle), range * Math.sin(angle)], scan.tilt);
    return { x: x + c * ahead - s * left, y: y + s * ahead + c * left, hit: word > 0 };
  });
  scan.cached = { j, x, y, rim };
  return scan.cached;
}

/** State of a run at a time; after its end, its last state. */
function frameAt(run, time) {
  const last = run.t[run.n - 1];
  const now = Math.min(time, last);
  const people = run.people ? peopleAt(run, now) : { size: 0 };
  return {
    time: now,
    ended: time > last + 1e-9,
    k: sampleAt(run, now).k,
    robots: run.robots.map((robot) => robotAt(run, robot, now)),
    people,
    scans: run.scans.map((s) => scanAt(run, s, now)).filter(Boolean),
    cones: run.cones.flatMap((group) => conesAt(run, group, now)),
  };
}
