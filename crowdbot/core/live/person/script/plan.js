// The picture from above, around the body that the person moves.

const ACROSS = 14; // m across

function drawPlan(frame) {
  const { run } = shown;
  const view = { canvas: byId("plan"), x: 0, y: 0, scale: 1 };
  const { g, width, height } = prepareCanvas(view);
  const own = ownBody(frame);
  if (own && Number.isFinite(own.x)) [view.x, view.y] = [own.x, own.y];
  view.scale = Math.max(Math.min(width, height), 240) / ACROSS;
  const px = 1 / view.scale;
  g.fillStyle = colours.floor;
  g.fillRect(0, 0, width, height);
  g.save();
  g.translate(width / 2, height / 2);
  g.scale(view.scale, -view.scale);
  g.translate(-view.x, -view.y);
  drawGrid(g, view, width, height, 0.5);
  drawGoals(g, run, px);
  for (const scan of frame.scans) if (scan.rim.length) drawFan(g, scan);
  drawWalls(g, run, px);
  run.robots.forEach((robot, i) => drawTrail(g, run, robot, frame.robots[i], frame, colours.robot, px));
  drawPeople(g, run, frame, px);
  drawWanted(g, run, frame, px);
  for (const scan of frame.scans) drawHits(g, scan, px);
  drawThoughts(g, run, frame.time, px);
  run.robots.forEach((robot, i) => drawRobot(g, robot, frame.robots[i], colours.robot, px));
  if (shown.walker >= 0 && own) drawSelf(g, own, px);
  g.restore();
  drawScaleBar(g, view, height);
}

/** A ring around the person who walks, and where that person looks. */
function drawSelf(g, { x, y, theta }, px) {
  drawFollowed(g, { x, y }, 0.3, px);
  g.beginPath();
  g.moveTo(x + 0.35 * Math.cos(theta), y + 0.35 * Math.sin(theta));
  g.lineTo(x + 0.8 * Math.cos(theta), y + 0.8 * Math.sin(theta));
  g.stroke();
}
