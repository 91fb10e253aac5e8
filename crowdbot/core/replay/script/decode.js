// Decodes data packed by encode.py.

const ABSENT = -32768;

/** Decodes base64 text and decompresses it with zlib; returns bytes. */
async function inflate(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const plain = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(plain).arrayBuffer());
}

/** Zigzag-decodes 16-bit words stored with all low bytes first: 0, 1, 2, 3 are 0, -1, 1, -2. */
function unfold(bytes) {
  const size = bytes.length / 2;
  const words = new Int16Array(size);
  for (let i = 0; i < size; i++) {
    const word = bytes[i] | (bytes[size + i] << 8);
    words[i] = (word >>> 1) ^ -(word & 1);
  }
  return words;
}

/** Sums up differences along rows with this number of columns. */
function addAlong(words, columns) {
  for (let i = 1; i < words.length; i++) if (i % columns) words[i] += words[i - 1];
  return words;
}

/** Decodes rows stored as second differences. */
async function unpackMotion(text, columns) {
  return addAlong(addAlong(unfold(await inflate(text)), columns), columns);
}

/** Decodes rows stored as differences from the row before. */
async function unpackReadings(text, columns) {
  const words = unfold(await inflate(text));
  for (let i = columns; i < words.length; i++) words[i] += words[i - columns];
  return words;
}

/** Decodes floats of this number of bytes from the differences of their bits along each row. */
async function unpackFloats(text, columns, size) {
  const planes = await inflate(text);
  const count = planes.length / size;
  const bits = size === 8 ? new BigUint64Array(count) : new Uint32Array(count);
  const bytes = new Uint8Array(bits.buffer);
  for (let b = 0; b < size; b++) {
    for (let i = 0; i < count; i++) bytes[i * size + b] = planes[b * count + i];
  }
  for (let i = 1; i < count; i++) if (i % columns) bits[i] += bits[i - 1];
  return size === 8 ? new Float64Array(bits.buffer) : new Float32Array(bits.buffer);
}

/** Decodes the images of one camera: a colour index for each pixel. */
async function unpackImages(text, size) {
  const indices = await inflate(text);
  for (let i = size; i < indices.length; i++) indices[i] ^= indices[i - size];
  return indices;
}

/** Builds a run from its metadata and the text of its blobs. */
async function decodeRun(meta, blob) {
  const n = meta.n;
  const run = { ...meta, t: await unpackFloats(blob("t"), n, 8) };
  for (const [i, robot] of run.robots.entries()) {
    const rows = await unpackFloats(blob(`robot${i}`), n, 4);
    ["x", "y", "theta", "v", "w"].forEach((name, r) => {
      robot[name] = rows.subarray(r * n, (r + 1) * n);
    });
  }
  if (run.people) {
    const { count, jumps } = run.people;
    const words = await unpackMotion(blob("people"), n);
    run.people.x = words.subarray(0, count * n);
    run.people.y = words.subarray(count * n);
    run.people.jumps = new Set(jumps);
  }
  for (const [i, scan] of run.scans.entries()) {
    scan.ranges = await unpackReadings(blob(`scan${i}`), scan.t.length);
  }
  for (const [i, group] of run.cones.entries()) {
    group.ranges = await unpackMotion(blob(`cones${i}`), group.t.length);
  }
  for (const [i, signal] of run.signals.entries()) {
    const rows = await unpackFloats(blob(`signal${i}`), signal.count, 4);
    Object.assign(signal, { t: rows.subarray(0, signal.count), values: rows.subarray(signal.count) });
  }
  for (const [i, drawing] of run.drawings.entries()) {
    const count = drawing.rows.reduce((sum, rows) => sum + rows, 0);
    const rows = await unpackFloats(blob(`drawing${i}`), count, 4);
    let first = 0;
    drawing.starts = drawing.rows.map((size) => (first += size) - size);
    drawing.columns = [0, 1, 2, 3].map((c) => rows.subarray(c * count, (c + 1) * count));
  }
  for (const [i, camera] of run.cameras.entries()) {
    camera.indices = await unpackImages(blob(`images${i}`), camera.width * camera.height);
  }
  return run;
}

/** Returns the runs packed into this page. */
function packedRuns() {
  const { runs } = JSON.parse(byId("meta").textContent);
  return runs.map((meta, i) => [meta, (name) => byId(`blob-${i}-${name}`).textContent]);
}
