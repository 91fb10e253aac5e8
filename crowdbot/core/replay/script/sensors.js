// Draws readings of lidars, ultrasonic and infrared sensors.

function drawFan(g, scan) {
  g.beginPath();
  g.moveTo(scan.x, scan.y);
  for (const p of scan.rim) g.lineTo(p.x, p.y);
  g.closePath();
  g.fillStyle = colours.lidar;
  g.globalAlpha = 0.09;
  g.fill();
  g.globalAlpha = 1;
}

function drawHits(g, scan, px) {
  const d = Math.max(0.03, 1.6 * px);
  g.fillStyle = colours.lidar;
  for (const p of scan.rim) if (p.hit) g.fillRect(p.x - d / 2, p.y - d / 2, d, d);
}

function drawCone(g, cone, px) {
  g.beginPath();
  g.moveTo(cone.x, cone.y);
  g.arc(cone.x, cone.y, cone.range, cone.from, cone.to);
  g.closePath();
  g.fillStyle = g.strokeStyle = colours.sonar;
  g.globalAlpha = 0.13;
  g.fill();
  g.globalAlpha = 0.4;
  g.lineWidth = px;
  g.stroke();
  g.globalAlpha = 1;
}

/** Draws one reading of a cone: the obstacle is anywhere between the edges. */
function drawEcho(g, cone, px) {
  g.beginPath();
  g.arc(cone.x, cone.y, cone.range, cone.from, cone.to);
  g.strokeStyle = colours.sonar;
  g.lineWidth = Math.max(0.03, 1.6 * px);
  g.lineCap = "round";
  g.stroke();
}
