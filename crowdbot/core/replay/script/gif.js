// Writes GIF89a: one palette, and of each image only what changed since the one before.

const CLEAR = 255; // the transparent index: as it was
const FULL = 4096; // codes of LZW

/** The commonest colours of some images, four bits a channel, and the index of every colour. */
function paletteOf(images) {
  const counts = new Uint32Array(FULL);
  for (const data of images) {
    for (let i = 0; i < data.length; i += 4) counts[codeOf(data, i)]++;
  }
  const used = [...counts.keys()].filter((code) => counts[code]).sort((a, b) => counts[b] - counts[a]);
  const chosen = used.slice(0, CLEAR);
  const parts = (code) => [code >> 8, (code >> 4) & 15, code & 15];
  const nearest = new Uint8Array(FULL);
  for (let code = 0; code < FULL; code++) {
    const [r, g, b] = parts(code);
    let least = Infinity;
    chosen.forEach((other, i) => {
      const [x, y, z] = parts(other);
      const apart = (r - x) ** 2 + (g - y) ** 2 + (b - z) ** 2;
      if (apart < least) [least, nearest[code]] = [apart, i];
    });
  }
  const bytes = new Uint8Array(3 * 256);
  chosen.forEach((code, i) => bytes.set(parts(code).map((c) => 17 * c), 3 * i));
  return { bytes, nearest };
}

const codeOf = (data, i) => ((data[i] >> 4) << 8) | (data[i + 1] & 0xf0) | (data[i + 2] >> 4);

/** Takes images one by one; `finish` gives the file. */
function gifWriter(width, height, palette, delay) {
  const low = (n) => [n & 255, n >> 8];
  const parts = [new Uint8Array([...new TextEncoder().encode("GIF89a"), ...low(width), ...low(height), 0xf7, 0, 0]),
    palette.bytes, new Uint8Array([0x21, 0xff, 11, ...new TextEncoder().encode("NETSCAPE2.0"), 3, 1, 0, 0, 0])];
  let last = null;
  return {
    add(data) {
      const indices = Uint8Array.from({ length: width * height }, (_, i) => palette.nearest[codeOf(data, 4 * i)]);
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
