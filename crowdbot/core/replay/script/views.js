// Draws one view. A view is {canvas, x, y, scale}: its middle (m) and pixels per metre.

/** Draws a run; `others`: content of further runs to draw into it. */
function drawView(run, view, frame, options) {
  const { g, width, height } = prepareCanvas(view);
  g.fillStyle = colours.floor;
  g.fillRect(0, 0, width, height);
  g.save();
  g.translate(width / 2, height / 2);
  g.scale(view.scale, -view.scale);
  g.translate(-view.x, -view.y);
  const px = 1 / view.scale;
  drawGrid(g, view, width, height, options.grid);
  drawGoals(g, run, px);
  drawAll(g, run, frame, options, px);
  if (options.frames) for (const box of options.frames) drawFrame(g, box, px);
  g.restore();
  return { g, width, height };
}

function drawAll(g, run, frame, options, px) {
  const { lidar, sonar, thoughts, trails, followed } = options;
  if (lidar) for (const scan of frame.scans) drawFan(g, scan);
  if (sonar) for (const cone of frame.cones) drawCone(g, cone, px);
  drawWalls(g, run, px);
  run.robots.forEach((r, i) => drawTrail(g, run, r, frame.robots[i], frame, options.colour, px));
  if (run.people && trails) drawPeopleTrails(g, run, frame, px);
  if (followed?.person >= 0) drawFollowedTrail(g, run, frame, followed.person, px);
  if (run.people) drawPeople(g, run, frame, px);
  if (run.people) drawWanted(g, run, frame, px);
  for (const { other, ghost, colour } of options.ghosts) drawGhost(g, other, ghost, frame, colour, px);
  if (lidar) for (const scan of frame.scans) drawHits(g, scan, px);
  if (sonar) for (const cone of frame.cones) drawEcho(g, cone, px);
  run.robots.forEach((r, i) => drawRobot(g, r, frame.robots[i], options.colour, px));
  if (followed) drawFollowed(g, followed.place, Math.max(followed.radius, 4 * px), px);
  if (thoughts) drawThoughts(g, run, frame.time, px);
  drawContacts(g, run, frame, px);
}

/** Outlines the area of a close-up in the whole scene. */
function drawFrame(g, { x, y, w, h, colour }, px) {
  g.strokeStyle = colour;
  g.globalAlpha = 0.8;
  g.lineWidth = 1.5 * px;
  g.strokeRect(x - w / 2, y - h / 2, w, h);
  g.globalAlpha = 1;
}
