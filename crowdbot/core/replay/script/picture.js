// Picture of one moment: title, whole scene, close-ups.

const HEAD = 30; // px

function pictureLayout(width) {
  const columns = Math.min(2, shown.runs.length);
  const rows = Math.ceil(shown.runs.length / columns);
  const wide = Math.round(clamp(width / shown.ratio, 40, 0.4 * width));
  const [cell, tall] = [width / columns, Math.round((columns === 1 ? 0.5 : 0.4) * width)];
  return { width, columns, wide, cell, tall, height: HEAD + wide + rows * tall };
}

/** Paints the moment onto a canvas of this size in CSS pixels, each `ratio` device pixels wide. */
function paintPicture(canvas, width, ratio) {
  const layout = pictureLayout(width);
  const { g } = prepareCanvas({ canvas, size: { width, height: layout.height, ratio } });
  const frames = framesNow();
  g.fillStyle = colours.floor;
  g.fillRect(0, 0, width, layout.height);
  paintTitle(g, width);
  const part = (x, y, w, h, paintInto) => {
    const view = { canvas: document.createElement("canvas"), size: { width: w, height: h, ratio } };
    paintInto(view);
    g.drawImage(view.canvas, x, y, w, h);
  };
  part(0, HEAD, width, layout.wide, (view) => paintWide(view, frames));
  shown.panels.forEach((panel, i) => {
    const { run, view: { x, y } } = panel;
    const at = [(i % layout.columns) * layout.cell, HEAD + layout.wide + Math.floor(i / layout.columns) * layout.tall];
    part(...at, layout.cell, layout.tall, (view) => {
      Object.assign(view, { x, y });
      aim(view, run, frames[run.index]);
      paintPanel({ ...panel, view }, frames);
      if (shown.runs.length > 1) paintLabel(view, run);
    });
  });
}

function paintTitle(g, width) {
  g.fillStyle = colours.ink;
  g.font = "600 14px system-ui, sans-serif";
  const clock = `${state.time.toFixed(2)} s`;
  const room = width - 24 - g.measureText(clock).width - 20;
  g.fillText(document.querySelector("h1").textContent, 12, 20, room);
  g.textAlign = "right";
  g.fillText(clock, width - 12, 20);
  g.textAlign = "left";
}

function paintLabel({ canvas }, run) {
  const g = canvas.getContext("2d");
  g.font = "600 13px system-ui, sans-serif";
  g.fillStyle = colours.floor;
  g.fillRect(6, 6, g.measureText(run.label).width + 12, 22);
  g.fillStyle = colourOfRun(run.index);
  g.fillText(run.label, 12, 21);
}

/** Returns a file name with the title and the moment or time span. */
function fileName(suffix, ...times) {
  const title = document.querySelector("h1").textContent.replace(/[^\w.-]+/g, "-").replace(/^-+|-+$/g, "");
  const when = (times.length ? times : [state.time]).map((t) => t.toFixed(2)).join("-");
  return `${title || "replay"}-${when}s.${suffix}`;
}

function download(blob, name) {
  const link = el("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

async function savePicture() {
  const canvas = document.createElement("canvas");
  paintPicture(canvas, 1200, 2);
  const blob = await new Promise((done) => { canvas.toBlob(done, "image/png"); });
  download(blob, fileName("png"));
  say("The picture is saved.");
}
