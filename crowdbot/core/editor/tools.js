// Tools: what a click or a drag on the floor adds.

const TOOLS = {
  select: ["v", "Select and move"], wall: ["w", "Wall: drag"], block: ["b", "Block: drag"], pillar: ["p", "Pillar: click"],
  zone: ["z", "Zone: drag"], robot: ["r", "Robot with its goal: click"], person: ["a", "Person: click"],
  route: ["n", "Route: click the next goal of the picked person"], spawn: ["s", "Spawn area with its goal: drag"],
  stream: ["f", "Stream to the other side: drag where it begins"], group: ["t", "Talking group: drag"],
};
const DRAGGED = ["wall", "block", "zone", "spawn", "stream", "group"];

const free = (map, name) => {
  if (!map || !(name in map)) return name;
  let k = 2;
  while (`${name}_${k}` in map) k += 1;
  return `${name}_${k}`;
};

const inside = ([x, y]) => {
  const [x0, y0, w, h] = extent();
  return [snapped(clamped(x, x0 + 1, x0 + w - 1)), snapped(clamped(y, y0 + 1, y0 + h - 1))];
};

// The place opposite on the floor, where people walk to.
const opposite = ([x, y]) => {
  const [x0, , w] = extent();
  return inside([2 * x0 + w - x, y]);
};

const LIDAR = { kind: "lidar2d", mount: { z: 0.3 }, rate: 16, angle_min: "-135 deg", angle_max: "135 deg", angle_step: "1 deg", range_min: 0.2, range_max: 10 };

// What the first people need: a speed and a policy.
const peopleOf = (crowd) => (crowd && crowd.policy ? [] : [
  { path: [...HERE, "crowd", "speed"], value: { mean: 1.3, std: 0.2 } },
  { path: [...HERE, "crowd", "policy"], value: { kind: "velocity_space" } },
  { path: [...HERE, "crowd", "costs"], value: { mid_term: { kind: "ttca_dca", weight: 20, range: 5 }, reflex: { kind: "rvo", range: { value: 0.3, measure: "surface" } } } },
]);
// Zones bound where things may be, so one of them has to be the whole floor.
const wholeFloor = ({ area, zones }) => {
  const covers = (z) => z.x[0] <= area.x[0] && z.x[1] >= area.x[1] && z.y[0] <= area.y[0] && z.y[1] >= area.y[1];
  if (!area || !Array.isArray(area.x) || Object.values(zones || {}).some(covers)) return [];
  return [{ path: [...HERE, "environment", "zones", free(zones, "everywhere")], value: { x: area.x, y: area.y } }];
};
const CROWDED = ["person", "spawn", "stream", "group"];

const ADD = {
  wall: ({ environment: e }, a, b) => [{ path: [...HERE, "environment", "walls", free(e.walls, "wall")], value: { start: a.map(snapped), end: b.map(snapped) } }],
  block: ({ environment: e }, a, b) => {
    const [x, y, w, h] = between(a, b).map(snapped);
    const corners = [[x, y], [x + w, y], [x + w, y + h], [x, y + h]].map((p) => p.map(snapped));
    return [{ path: [...HERE, "environment", "blocks", free(e.blocks, "block")], value: { corners } }];
  },
  pillar: ({ environment: e }, a) => [{ path: [...HERE, "environment", "pillars", free(e.pillars, "pillar")], value: { x: snapped(a[0]), y: snapped(a[1]), radius: 0.3 } }],
  zone: ({ environment: e }, a, b) => [...wholeFloor(e), { path: [...HERE, "environment", "zones", free(e.zones, "zone")], value: boxOf(between(a, b)) }],
  robot: ({ environment: e, robots }, a) => {
    const name = free(robots, "robot"), zone = free(e.zones, `${name}_goal`), [gx, gy] = opposite(a);
    return [...wholeFloor(e), { path: [...HERE, "environment", "zones", zone], value: boxOf([gx - 0.5, gy - 0.5, 1, 1]) },
      { path: [...HERE, "robots", name], value: { model: { kind: "turtlebot2" }, sensors: { lidar: LIDAR, odometry: { kind: "wheel_odometry", rate: 64 } },
        task: { start: [...a.map(snapped), gx < a[0] ? 3.1416 : 0], goal: { zone }, time_limit: 60 } } }];
  },
  person: ({ crowd }, a) => {
    const agents = (crowd && crowd.agents) || [], id = agents.reduce((most, one) => Math.max(most, one.id + 1), 0);
    return [{ path: [...HERE, "crowd", "agents", agents.length], value: { id, x: snapped(a[0]), y: snapped(a[1]), goals: [opposite(a)] } }];
  },
  route: (data, a) => {
    const item = state.items.find((one) => one.key === state.picked);
    if (!item || item.kind !== "person") { say("pick a person first"); return []; }
    return [{ path: [...item.path, "goals", item.points.length - 1], value: a.map(snapped) }];
  },
  spawn: ({ crowd }, a, b) => {
    const name = free(crowd.spawns, "people"), goal = free(crowd.goal_areas, `${name}_goal`), at = areaOf(between(a, b));
    return [{ path: [...HERE, "crowd", "goal_areas", goal], value: { area: { centre: opposite(at.centre), size: [1, 1] } } },
      { path: [...HERE, "crowd", "spawns", name], value: { area: at, count: Number($("count").value), goals: { areas: [goal] } } }];
  },
  stream: ({ crowd }, a, b) => {
    const origin = areaOf(between(a, b)), far = { centre: opposite(origin.centre), size: origin.size };
    return [{ path: [...HERE, "crowd", "streams", free(crowd.streams, "stream")],
      value: { kind: "through", origin, destination: far, count: Number($("count").value) } }];
  },
  group: ({ crowd }, a, b) => {
    const count = Number($("count").value);
    return [{ path: [...HERE, "crowd", "streams", free(crowd.streams, "group")],
      value: { kind: "talking", area: areaOf(between(a, b)), count, groups: [{ size: count, frequency: 1 }] } }];
  },
};

function add(tool, from, to) {
  const data = { environment: {}, crowd: {}, robots: {}, ...state.data };
  return apply([...(CROWDED.includes(tool) ? peopleOf(data.crowd) : []), ...ADD[tool](data, from, to)]);
}

function remove() {
  const item = state.items.find((one) => one.key === state.picked);
  if (!item) return;
  const changes = [{ path: item.path, value: null }], task = ((state.data.robots || {})[item.name] || {}).task;
  if (item.kind === "robot" && task) changes.push({ path: [...HERE, "environment", "zones", task.goal.zone], value: null });
  if (item.kind === "spawn" && item.path[2] === "spawns") {
    const goals = (state.data.crowd.spawns[item.name] || {}).goals;
    for (const name of (goals && goals.areas) || []) changes.push({ path: [...HERE, "crowd", "goal_areas", name], value: null });
  }
  state.picked = "";
  apply(changes);
}
