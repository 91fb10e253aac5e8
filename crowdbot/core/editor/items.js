// Parts of a scenario that can be picked, moved and numbered, each with its path in the document.

const HERE = ["scenario"];
const isArea = (value) => value && Array.isArray(value.centre) && Array.isArray(value.size);
const number = (name, path, value) => ({ name, path, value });

function itemsOf(data) {
  const env = data.environment || {}, crowd = data.crowd || {}, found = [];
  const each = (map, make) => Object.entries(map || {}).forEach(([name, value]) => { if (value) found.push(make(name, value)); });
  each(env.zones, (n, v) => box("zone", n, [...HERE, "environment", "zones", n], v));
  each(env.portals, (n, v) => box("portal", n, [...HERE, "environment", "portals", n], v));
  each(crowd.goal_areas, (n, v) => isArea(v.area) && areaItem("goal", n, [...HERE, "crowd", "goal_areas", n], ["area"], v));
  each(crowd.spawns, (n, v) => isArea(v.area) && areaItem("spawn", n, [...HERE, "crowd", "spawns", n], ["area"], v));
  for (const [name, stream] of Object.entries(crowd.streams || {})) {
    for (const field of ["origin", "start", "area", "destination"]) {
      if (!isArea(stream[field])) continue;
      const kind = field === "destination" ? "goal" : "spawn";
      found.push(areaItem(kind, `${name} ${field}`, [...HERE, "crowd", "streams", name], [field], stream));
    }
  }
  each(env.walls, (n, v) => wall(n, [...HERE, "environment", "walls", n], v));
  each(env.blocks, (n, v) => block(n, [...HERE, "environment", "blocks", n], v));
  each(env.pillars, (n, v) => pillar(n, [...HERE, "environment", "pillars", n], v));
  (Array.isArray(crowd.agents) ? crowd.agents : []).forEach((v, k) => found.push(agent(k, [...HERE, "crowd", "agents", k], v)));
  each(data.robots, (n, v) => v.task && robot(n, [...HERE, "robots", n], v));
  return found.filter(Boolean);
}

const named = (kind, name, path) => ({ kind, name, path, key: path.join("/") });

function wall(name, path, v) {
  const ends = [v.start, v.end], thick = v.thickness === undefined ? 0.1 : v.thickness;
  return {
    ...named("wall", name, path), points: ends,
    numbers: [number("start x", [...path, "start", 0], ends[0][0]), number("start y", [...path, "start", 1], ends[0][1]),
      number("end x", [...path, "end", 0], ends[1][0]), number("end y", [...path, "end", 1], ends[1][1]),
      number("thickness", [...path, "thickness"], thick)],
    moved: (points) => [{ path: [...path, "start"], value: points[0] }, { path: [...path, "end"], value: points[1] }],
    draw: (g, p) => drawn("line", { x1: p[0][0], y1: p[0][1], x2: p[1][0], y2: p[1][1], class: "solid", "stroke-width": 3 }, g),
  };
}

function block(name, path, v) {
  return {
    ...named("block", name, path), points: v.corners,
    numbers: v.corners.flatMap((c, k) => [number(`x ${k + 1}`, [...path, "corners", k, 0], c[0]), number(`y ${k + 1}`, [...path, "corners", k, 1], c[1])]),
    moved: (points) => [{ path: [...path, "corners"], value: points }],
    draw: (g, p) => drawn("polygon", { points: p.map((q) => q.join(",")).join(" "), class: "body" }, g),
  };
}

function pillar(name, path, v) {
  return {
    ...named("pillar", name, path), points: [[v.x, v.y]],
    numbers: ["x", "y", "radius"].map((n) => number(n, [...path, n], v[n])),
    moved: ([p]) => [{ path: [...path, "x"], value: p[0] }, { path: [...path, "y"], value: p[1] }],
    draw: (g, [p]) => drawn("circle", { cx: p[0], cy: p[1], r: v.radius, class: "body" }, g),
  };
}

function box(kind, name, path, v) {
  const points = [[v.x[0], v.y[0]], [v.x[1], v.y[1]]];
  return {
    ...named(kind, name, path), points, whole: true,
    numbers: [["x", 0, "left"], ["x", 1, "right"], ["y", 0, "bottom"], ["y", 1, "top"]].map(([a, k, n]) => number(n, [...path, a, k], v[a][k])),
    moved: ([a, b]) => [{ path: [...path, "x"], value: [Math.min(a[0], b[0]), Math.max(a[0], b[0])] },
      { path: [...path, "y"], value: [Math.min(a[1], b[1]), Math.max(a[1], b[1])] }],
    draw: (g, [a, b]) => rectangle(g, between(a, b), `area ${kind}`),
  };
}

function areaItem(kind, name, path, inner, v) {
  const at = v[inner[0]], [w, h] = at.size, whole = [...path, ...inner];
  const counts = ["count", "density"].filter((n) => typeof v[n] === "number").map((n) => number(n, [...path, n], v[n]));
  return {
    ...named(kind, name, path), key: whole.join("/"), points: [at.centre],
    numbers: [...counts, number("centre x", [...whole, "centre", 0], at.centre[0]), number("centre y", [...whole, "centre", 1], at.centre[1]),
      number("length", [...whole, "size", 0], w), number("width", [...whole, "size", 1], h)],
    moved: ([p]) => [{ path: [...whole, "centre"], value: p }],
    draw: (g, [p]) => rectangle(g, [p[0] - w / 2, p[1] - h / 2, w, h], `area ${kind}`, at.rotation ? (at.rotation * 180) / Math.PI : 0, p),
  };
}

function agent(k, path, v) {
  const goals = v.goals || [], radius = v.radius || 0.33;
  return {
    ...named("person", `person ${v.id}`, path), points: [[v.x, v.y], ...goals],
    numbers: [number("x", [...path, "x"], v.x), number("y", [...path, "y"], v.y),
      ...["speed", "radius"].filter((n) => typeof v[n] === "number").map((n) => number(n, [...path, n], v[n])),
      ...goals.flatMap((p, i) => [number(`goal ${i + 1} x`, [...path, "goals", i, 0], p[0]), number(`goal ${i + 1} y`, [...path, "goals", i, 1], p[1])])],
    moved: (points) => [{ path: [...path, "x"], value: points[0][0] }, { path: [...path, "y"], value: points[0][1] },
      ...(goals.length ? [{ path: [...path, "goals"], value: points.slice(1) }] : [])],
    alone: true,
    draw: (g, p) => {
      if (p.length > 1) drawn("polyline", { points: p.map((q) => q.join(",")).join(" "), class: "way" }, g);
      return drawn("circle", { cx: p[0][0], cy: p[0][1], r: radius, class: "person" }, g);
    },
  };
}

function robot(name, path, v) {
  const [x, y, heading] = v.task.start;
  return {
    ...named("robot", name, path), points: [[x, y]],
    numbers: ["x", "y", "heading"].map((n, k) => number(n, [...path, "task", "start", k], v.task.start[k])),
    moved: ([p]) => [{ path: [...path, "task", "start"], value: [p[0], p[1], heading] }],
    draw: (g, [p]) => {
      const tip = (turn, far) => [p[0] + far * Math.cos(heading + turn), p[1] + far * Math.sin(heading + turn)].join(",");
      return drawn("polygon", { points: [tip(0, 0.5), tip(2.5, 0.35), tip(-2.5, 0.35)].join(" "), class: "robot" }, g);
    },
  };
}

function rectangle(g, [x, y, w, h], css, turn = 0, about = [0, 0]) {
  return drawn("rect", { x, y, width: w, height: h, class: css, transform: `rotate(${turn} ${about[0]} ${about[1]})` }, g);
}
