// Draws another run into a view: its robot, and people whose places differ from this one.

const APART = 0.15; // m; nearer than that is the same place

function drawGhost(g, other, ghost, frame, colour, px) {
  g.setLineDash([4 * px, 3 * px]);
  other.robots.forEach((robot, i) => {
    if (!Number.isFinite(ghost.robots[i].x)) return;
    drawTrail(g, other, robot, ghost.robots[i], ghost, colour, 0.7 * px);
    g.save();
    g.translate(ghost.robots[i].x, ghost.robots[i].y);
    g.rotate(ghost.robots[i].theta);
    robotPath(g, robot, Math.max(robot.radius, 5 * px), 0);
    g.setLineDash([]);
    g.fillStyle = colour;
    g.globalAlpha = 0.3;
    g.fill();
    g.globalAlpha = 1;
    g.strokeStyle = colour;
    g.lineWidth = 2 * px;
    g.stroke();
    g.restore();
  });
  g.setLineDash([]);
  if (other.people) drawGhostPeople(g, other, ghost.people, frame.people, colour, px);
}

function drawGhostPeople(g, other, ghosts, people, colour, px) {
  const here = new Map();
  for (let i = 0; i < people.size; i++) here.set(people.person[i], i);
  g.beginPath();
  for (let i = 0; i < ghosts.size; i++) {
    const at = here.get(ghosts.person[i]);
    const [x, y] = [ghosts.x[i], ghosts.y[i]];
    if (at !== undefined && Math.hypot(people.x[at] - x, people.y[at] - y) < APART) continue;
    const r = Math.max(radiusOf(other.people, ghosts.person[i]), 2 * px);
    g.moveTo(x + r, y);
    g.arc(x, y, r, 0, 2 * Math.PI);
  }
  g.strokeStyle = colour;
  g.globalAlpha = 0.75;
  g.lineWidth = 1.2 * px;
  g.stroke();
  g.globalAlpha = 1;
}
