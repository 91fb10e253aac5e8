// Runs of other replay pages: asked for by #with=, or chosen as a file.

const PATIENCE = 15000; // ms

/** A page that was opened by another replay page hands over its runs, and shows nothing. */
function handOver() {
  if (window.parent === window || !fragment().has("data")) return false;
  const runs = JSON.parse(byId("meta").textContent).runs.map((meta, i) => {
    const prefix = `blob-${i}-`;
    const blobs = [...document.querySelectorAll(`[id^="${prefix}"]`)];
    return { meta, blobs: Object.fromEntries(blobs.map((b) => [b.id.slice(prefix.length), b.textContent])) };
  });
  const files = location.protocol === "file:"; // pages of files have no origin by which to name them
  window.parent.postMessage({ crowdbotRuns: runs }, files ? "*" : location.origin);
  return true;
}

/** The runs of another page, as `packedRuns` has them; a page of the same site or disk. */
function runsAt(address) {
  const url = new URL(address, location.href);
  if (url.protocol !== location.protocol || url.host !== location.host) {
    return Promise.reject(new Error(`${address} is not beside this page`));
  }
  url.hash = "data";
  return new Promise((done, refuse) => {
    const frame = el("iframe", { src: url.href, hidden: true, title: "another run" });
    const late = setTimeout(() => finish(() => refuse(new Error(`${address} does not answer`))), PATIENCE);
    const hear = (event) => {
      if (event.source !== frame.contentWindow || !event.data?.crowdbotRuns) return;
      finish(() => done(event.data.crowdbotRuns.map(({ meta, blobs }) => [meta, (name) => blobs[name]])));
    };
    const finish = (act) => {
      clearTimeout(late);
      removeEventListener("message", hear);
      frame.remove();
      act();
    };
    addEventListener("message", hear);
    document.body.append(frame);
  });
}

/** The runs of a replay page that was chosen as a file; nothing in it is executed. */
async function runsIn(file) {
  const page = new DOMParser().parseFromString(await file.text(), "text/html");
  const meta = page.getElementById("meta");
  if (!meta) throw new Error(`${file.name} is not a replay page`);
  return JSON.parse(meta.textContent).runs.map((run, i) =>
    [run, (name) => page.getElementById(`blob-${i}-${name}`).textContent]);
}

/** Adds runs to those that are shown. */
async function addRuns(packed) {
  for (const [meta, blob] of packed) {
    if (!Array.isArray(meta.robots)) throw new Error("that page was written by another version");
    addRun(await decodeRun(meta, blob));
  }
}

async function addFile(file) {
  try {
    await addRuns(await runsIn(file));
    arrange();
    say(`${file.name} is shown beside.`);
  } catch (error) {
    say(`${file.name} cannot be shown: ${error.message}`);
  }
}
