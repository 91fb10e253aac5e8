// Recorded camera images: the latest one at the current time.

function offerCameras() {
  const figures = shown.runs.flatMap((run) => run.cameras.map((camera) => cameraFigure(run, camera)));
  byId("camera-figures").replaceChildren(...figures);
  byId("cameras").hidden = !figures.length;
}

function cameraFigure(run, camera) {
  const what = `${camera.sensor}, ${camera.kind}`;
  const name = shown.runs.length > 1 ? `${run.label}: ${what}` : what;
  const canvas = el("canvas", { role: "img", "aria-label": `Image of ${name}`,
    width: camera.width, height: camera.height });
  const stamp = el("span", { class: "now" });
  const figure = el("figure", { class: "camera" }, canvas, el("figcaption", {}, `${name} `, stamp));
  figure.camera = { ...camera, canvas, stamp, colours: shadesOf(camera), drawn: null };
  return figure;
}

/** Red, green and blue of each index; for distances, near is light and unknown is violet. */
function shadesOf({ kind, palette }) {
  const shades = new Uint8ClampedArray(3 * 256);
  if (kind === "colour") shades.set(palette);
  else {
    for (let i = 1; i < 256; i++) shades.fill(255 - Math.round(235 * Math.sqrt(i / 255)), 3 * i, 3 * i + 3);
    shades.set([70, 40, 90]);
  }
  return shades;
}

function drawCameras(time) {
  for (const { camera } of byId("camera-figures").children) {
    const j = lastBefore(camera.t, time);
    if (j === camera.drawn) continue;
    camera.drawn = j;
    drawImage(camera, j);
    const far = camera.far ? `, near is light, 0–${withUnit(camera.far, 1, "m")}; violet: nothing` : "";
    camera.stamp.textContent = j < 0 ? "nothing yet" : `${camera.t[j].toFixed(2)} s${far}`;
  }
}

function drawImage({ canvas, width, height, indices, colours: shades }, j) {
  const g = canvas.getContext("2d");
  const image = g.createImageData(width, height);
  for (let i = 0; i < width * height; i++) {
    const shade = j < 0 ? 0 : 3 * indices[j * width * height + i];
    for (let c = 0; c < 3; c++) image.data[4 * i + c] = j < 0 ? 0 : shades[shade + c];
    image.data[4 * i + 3] = 255;
  }
  g.putImageData(image, 0, 0);
}
