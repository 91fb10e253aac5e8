"use strict";
// Reads what encode.py packed.

const ABSENT = -32768;

async function inflate(name) {
  const text = document.getElementById(`blob-${name}`).textContent;
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const plain = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(plain).arrayBuffer());
}

/** Rows of int16: all low bytes, then all high bytes, each row as differences. */
function undelta(bytes, rows, columns) {
  const size = rows * columns;
  const words = new Int16Array(size);
  for (let r = 0; r < rows; r++) {
    let last = 0;
    for (let i = r * columns; i < (r + 1) * columns; i++) {
      last = (last + bytes[i] + (bytes[size + i] << 8)) & 0xffff;
      words[i] = last;
    }
  }
  return words;
}

async function decode() {
  const meta = JSON.parse(document.getElementById("meta").textContent);
  const n = meta.n;
  const run = { ...meta, t: new Float64Array((await inflate("t")).buffer) };
  if (meta.robot) {
    const rows = new Float32Array((await inflate("robot")).buffer);
    const row = (i) => rows.subarray(i * n, (i + 1) * n);
    Object.assign(run.robot, { x: row(0), y: row(1), theta: row(2), v: row(3) });
  }
  run.others = meta.others ?? []; // the other robots of a fleet
  for (const [i, other] of run.others.entries()) {
    const rows = new Float32Array((await inflate(`other${i}`)).buffer);
    const row = (k) => rows.subarray(k * n, (k + 1) * n);
    Object.assign(other, { x: row(0), y: row(1), theta: row(2), v: row(3) });
  }
  if (meta.people) {
    const count = meta.people.count;
    const words = undelta(await inflate("people"), 2 * count, n);
    Object.assign(run.people, { x: words.subarray(0, count * n), y: words.subarray(count * n) });
    run.people.jumps = new Set(meta.people.jumps);
  }
  for (const [i, scan] of meta.scans.entries()) {
    scan.ranges = undelta(await inflate(`scan${i}`), scan.angles.length, scan.t.length);
  }
  for (const [i, group] of meta.cones.entries()) {
    group.ranges = undelta(await inflate(`cones${i}`), group.sensors.length, group.t.length);
  }
  return run;
}
