// Writes GIF89a: one palette; each image stores only pixels that changed since the one before.

const CLEAR = 255; // transparent index: pixel unchanged
const FULL = 4096; // number of LZW codes
const GROUPS = 32768; // groups of colours: five bits a channel

/** Returns a palette, the means of the most frequent colour groups, and the index of every group. */
function paletteOf(images) {
  const counts = new Uint32Array(GROUPS);
  const sums = [0, 1, 2].map(() => new Float64Array(GROUPS));
  for (const data of images) {
    for (let i = 0; i < data.length; i += 4) {
      const group = groupOf(data, i);
      counts[group]++;
      for (let k = 0; k < 3; k++) sums[k][group] += data[i + k];
    }
  }
  const used = [...counts.keys()].filter((group) => counts[group]).sort((a, b) => counts[b] - counts[a]);
  const chosen = used.slice(0, CLEAR);
  const bytes = new Uint8Array(3 * 256);
  chosen.forEach((group, i) => bytes.set(sums.map((sum) => Math.round(sum[group] / counts[group])), 3 * i));
  return { bytes, nearest: nearestTo(bytes, chosen) };
}

function nearestTo(bytes, chosen) {
  const nearest = new Uint8Array(GROUPS);
  for (let group = 0; group < GROUPS; group++) {
    const [r, g, b] = [group >> 10, (group >> 5) & 31, group & 31].map((c) => 8 * c + 4);
    let least = Infinity;
    for (let i = 0; i < chosen.length; i++) {
      const apart = (r - bytes[3 * i]) ** 2 + (g - bytes[3 * i + 1]) ** 2 + (b - bytes[3 * i + 2]) ** 2;
      if (apart < least) [least, nearest[group]] = [apart, i];
    }
  }
  chosen.forEach((group, i) => { nearest[group] = i; });
  return nearest;
}

const groupOf = (data, i) => ((data[i] >> 3) << 10) | ((data[i + 1] >> 3) << 5) | (data[i + 2] >> 3);

/** Takes images one by one; `finish` returns the file. */
function gifWriter(width, height, palette, delay) {
  const low = (n) => [n & 255, n >> 8];
  const parts = [new Uint8Array([...new TextEncoder().encode("GIF89a"), ...low(width), ...low(height), 0xf7, 0, 0]),
    palette.bytes, new Uint8Array([0x21, 0xff, 11, ...new TextEncoder().encode("NETSCAPE2.0"), 3, 1, 0, 0, 0])];
  let last = null;
  return {
    add(data) {
      const indices = Uint8Array.from({ length: width * height }, (_, i) => palette.nearest[groupOf(data, 4 * i)]);
      const changed = last ? indices.map((index, i) => (index === last[i] ? CLEAR : index)) : indices;
      last = indices;
      parts.push(new Uint8Array([0x21, 0xf9, 4, 0x05, ...low(delay), CLEAR, 0, 0x2c, 0, 0, 0, 0,
        ...low(width), ...low(height), 0, 8]), lzw(changed));
    },
    finish: () => new Blob([...parts, new Uint8Array([0x3b])], { type: "image/gif" }),
  };
}

/** Variable-length codes from 9 bits on, in blocks of at most 255 bytes. */
function lzw(indices) {
  const out = new Uint8Array(2 * indices.length + 1024);
  const table = new Int32Array(FULL * 256);
  let [size, bits, held, clears] = [0, 0, 0, 0];
  let [width, next] = [9, 258];
  const put = (code) => {
    held |= code << bits;
    for (bits += width; bits >= 8; bits -= 8) {
      out[size++] = held & 255;
      held >>>= 8;
    }
  };
  const restart = () => {
    put(256);
    clears++;
    [width, next] = [9, 258];
  };
  restart();
  let prefix = indices[0];
  for (let i = 1; i < indices.length; i++) {
    const place = (prefix << 8) | indices[i];
    if (table[place] >> 12 === clears) {
      prefix = table[place] & (FULL - 1);
      continue;
    }
    put(prefix);
    if (next < FULL) {
      table[place] = (clears << 12) | next;
      if (next === 1 << width) width++;
      next++;
    } else restart();
    prefix = indices[i];
  }
  put(prefix);
  put(257);
  if (bits) out[size++] = held & 255;
  return inBlocks(out.subarray(0, size));
}

function inBlocks(bytes) {
  const blocks = new Uint8Array(bytes.length + Math.ceil(bytes.length / 255) + 1);
  let at = 0;
  for (let i = 0; i < bytes.length; i += 255) {
    const block = bytes.subarray(i, i + 255);
    blocks[at] = block.length;
    blocks.set(block, at + 1);
    at += block.length + 1;
  }
  return blocks.subarray(0, at + 1);
}
