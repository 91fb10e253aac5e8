// Saves a span of time as GIF or WebM.

const CLIP_WIDTH = 800;
const LONGEST = 60; // s
const GIF_RATE = 12.5; // Hz: GIF counts hundredths of a second
const VIDEO_RATE = 25;
const LAST = 300; // ms
let saving = false;

/** Shows the moments of a time span one after the other, then restores the view. */
async function overSpan(from, to, rate, canvas, each) {
  const [was, playing] = [state.time, state.playing];
  setPlaying(false);
  const count = Math.max(1, Math.round((to - from) * rate));
  for (let i = 0; i < count && saving; i++) {
    state.time = from + (i * (to - from)) / count;
    paint();
    paintPicture(canvas, CLIP_WIDTH, 1);
    say(`Saving: ${Math.round((100 * i) / count)} %`);
    await each(i);
  }
  state.time = was;
  setPlaying(playing);
}

const pixelsOf = (canvas) => canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
const pause = (ms) => new Promise((done) => { setTimeout(done, ms); });

async function makeGif(from, to) {
  const canvas = document.createElement("canvas");
  canvas.getContext("2d", { willReadFrequently: true });
  const samples = [];
  await overSpan(from, to, 3 / (to - from), canvas, () => samples.push(pixelsOf(canvas)));
  const writer = gifWriter(canvas.width, canvas.height, paletteOf(samples), Math.round(100 / GIF_RATE));
  await overSpan(from, to, GIF_RATE, canvas, async () => {
    writer.add(pixelsOf(canvas));
    await pause(0);
  });
  return writer.finish();
}

const VIDEO_TYPES = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"];
const videoType = () => window.MediaRecorder && VIDEO_TYPES.find((type) => MediaRecorder.isTypeSupported(type));

/** Records in real time, since the recorder uses its own clock. */
async function makeVideo(from, to) {
  const canvas = document.createElement("canvas");
  paintPicture(canvas, CLIP_WIDTH, 1);
  const stream = canvas.captureStream(0);
  const [track] = stream.getVideoTracks();
  const recorder = new MediaRecorder(stream, { mimeType: videoType(), videoBitsPerSecond: 4e6 });
  const chunks = [];
  recorder.ondataavailable = ({ data }) => chunks.push(data);
  const [started, stopped] = ["start", "stop"].map((name) =>
    new Promise((done) => { recorder.addEventListener(name, done); }));
  recorder.start();
  await started;
  const began = performance.now();
  await overSpan(from, to, VIDEO_RATE, canvas, async (i) => {
    track.requestFrame();
    await pause(Math.max(1, began + ((i + 1) * 1000) / VIDEO_RATE - performance.now()));
  });
  await pause(LAST); // the encoder is a little behind
  recorder.stop();
  await stopped;
  return new Blob(chunks, { type: "video/webm" });
}

async function saveClip() {
  if (saving) {
    saving = false; // second press: stop
    return;
  }
  const [from, to] = ["clip-from", "clip-to"].map((id) => clamp(Number(byId(id).value), shown.first, shown.last));
  if (!(to > from) || to - from > LONGEST) {
    say(`A clip ends after it begins, and is at most ${LONGEST} s long.`);
    return;
  }
  const format = byId("clip-format").value;
  saving = true;
  byId("clip").textContent = "Stop";
  const blob = await (format === "gif" ? makeGif : makeVideo)(from, to);
  if (saving) download(blob, fileName(format, from, to));
  say(saving ? `The clip is saved: ${Math.round(blob.size / 1000)} kB.` : "Stopped.");
  byId("clip").textContent = "Save clip";
  saving = false;
}
