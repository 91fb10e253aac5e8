// Reads every message of a recording: node count.mjs FOLDER_OF_NODE_MODULES RUN.mcap
import { createRequire } from "node:module";
import { open } from "node:fs/promises";
import { join } from "node:path";

const [folder, path] = process.argv.slice(2);
const need = createRequire(join(folder, "x.js"));
const { McapIndexedReader } = need("@mcap/core");
const { parse } = need("@foxglove/rosmsg");
const { MessageReader } = need("@foxglove/rosmsg2-serialization");
const { decompress } = need("fzstd");

const file = await open(path);
const readable = {
  size: async () => BigInt((await file.stat()).size),
  read: async (offset, size) => {
    const bytes = new Uint8Array(Number(size));
    await file.read(bytes, 0, bytes.length, Number(offset));
    return bytes;
  },
};
const decompressHandlers = { zstd: (bytes) => decompress(bytes) };
const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
const readers = new Map();
const counts = {};
for await (const record of reader.readMessages()) {
  const channel = reader.channelsById.get(record.channelId);
  if (!readers.has(channel.id)) {
    const text = new TextDecoder().decode(reader.schemasById.get(channel.schemaId).data);
    readers.set(channel.id, new MessageReader(parse(text, { ros2: true })));
  }
  readers.get(channel.id).readMessage(record.data);
  counts[channel.topic] = (counts[channel.topic] ?? 0) + 1;
}
await file.close();
console.log(JSON.stringify(counts));
