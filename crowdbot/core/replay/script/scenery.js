// Draws what does not move: floor, goal, walls, blocks, pillars, and the scale.

// Styles of walls by what they stop: 1 robots, 2 people, 3 both, 0 neither.
const WALLS = [
  { whom: 3, colour: "wall", width: 2.5, dash: [], text: "wall" },
  { whom: 1, colour: "robot", width: 2.5, dash: [9, 5], text: "wall for robots only" },
  { whom: 2, colour: "accent", width: 2.5, dash: [3, 4], text: "wall for people only" },
  { whom: 0, colour: "muted", width: 1.5, dash: [1, 4], text: "wall that stops no one" },
];

function drawGrid(g, view, width, height, spacing) {
  const [w, h] = [width / 2 / view.scale, height / 2 / view.scale];
  g.lineWidth = 1 / view.scale;
  for (const strong of [false, true]) {
    g.beginPath();
    const every = strong ? 5 * spacing : spacing;
    const first = (middle, half) => Math.ceil((middle - half) / every) * every;
    for (let x = first(view.x, w); x <= view.x + w; x += every) {
      g.moveTo(x, view.y - h);
      g.lineTo(x, view.y + h);
    }
    for (let y = first(view.y, h); y <= view.y + h; y += every) {
      g.moveTo(view.x - w, y);
      g.lineTo(view.x + w, y);
    }
    g.strokeStyle = strong ? colours["grid-strong"] : colours.grid;
    g.stroke();
  }
}

function drawGoals(g, run, px) {
  const zones = [run.zone, ...run.robots.slice(1).map(({ zone }) => zone)].filter((zone) => zone.length);
  for (const zone of zones) {
    g.beginPath();
    zone.forEach(([x, y], i) => g[i ? "lineTo" : "moveTo"](x, y));
    g.closePath();
    drawGoal(g, px);
  }
  for (const { goal, goalRadius, zone } of run.robots) {
    if (!goal || zone.length) continue;
    g.beginPath();
    g.arc(goal[0], goal[1], Math.max(goalRadius, 0.3), 0, 7);
    drawGoal(g, px);
  }
}

function drawGoal(g, px) {
  g.fillStyle = colours.goal;
  g.globalAlpha = 0.16;
  g.fill();
  g.globalAlpha = 1;
  g.strokeStyle = colours.goal;
  g.lineWidth = 1.5 * px;
  g.setLineDash([6 * px, 4 * px]);
  g.stroke();
  g.setLineDash([]);
}

function drawWalls(g, run, px) {
  g.lineCap = "round";
  for (const { whom, colour, width, dash } of WALLS) {
    g.beginPath();
    for (const [x0, y0, x1, y1, stops] of run.walls) {
      if (stops !== whom) continue;
      g.moveTo(x0, y0);
      g.lineTo(x1, y1);
    }
    g.strokeStyle = colours[colour];
    g.lineWidth = Math.max(whom === 3 ? 0.1 : 0.05, width * px);
    g.setLineDash(dash.map((d) => d * px));
    g.stroke();
  }
  g.setLineDash([]);
  g.fillStyle = colours.wall;
  fillOutlines(g, run.blocks);
  g.globalAlpha = 0.35;
  fillOutlines(g, run.steps);
  g.globalAlpha = 1;
  for (const [x, y, radius] of run.pillars) {
    g.beginPath();
    g.arc(x, y, radius, 0, 7);
    g.fill();
  }
}

// All at once: pieces that touch show no seam.
function fillOutlines(g, outlines) {
  g.beginPath();
  for (const outline of outlines) {
    outline.forEach(([x, y], i) => g[i ? "lineTo" : "moveTo"](x, y));
    g.closePath();
  }
  g.fill();
}

function drawScaleBar(g, view, height) {
  const metres = [0.5, 1, 2, 5, 10, 20, 50].find((m) => m * view.scale > 50) || 100;
  const length = metres * view.scale;
  const y = height - 14;
  g.globalAlpha = 0.9;
  g.fillStyle = colours.floor;
  g.fillRect(6, y - 13, length + 58, 21);
  g.globalAlpha = 1;
  g.strokeStyle = g.fillStyle = colours.ink;
  g.lineWidth = 1.5;
  g.beginPath();
  g.moveTo(14, y - 4);
  g.lineTo(14, y);
  g.lineTo(14 + length, y);
  g.lineTo(14 + length, y - 4);
  g.stroke();
  g.font = "12px system-ui, sans-serif";
  g.fillText(`${metres} m`, 22 + length, y + 2);
}
