// In the browser: a recording, drawn by the 3-D panel of Foxglove Studio with a layout for it.

import { McapIndexedReader } from "@mcap/core";
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { decompress } from "fzstd";
import { Renderer } from "@foxglove/studio-base/src/panels/ThreeDeeRender/Renderer";

const NS = 10n ** 9n;
const CAMERA = { fovy: 45, near: 0.5, far: 5000, target: [0, 0, 0], targetOffset: [0, 0, 0],
  targetOrientation: [0, 0, 0, 1], perspective: true, phi: 60, thetaOffset: 45, distance: 20 };

async function reader(url) {
  const data = new Uint8Array(await (await fetch(url)).arrayBuffer());
  const readable = {
    size: async () => BigInt(data.length),
    read: async (offset, size) => data.slice(Number(offset), Number(offset + size)),
  };
  const decompressHandlers = { zstd: (bytes) => decompress(bytes) };
  return McapIndexedReader.Initialize({ readable, decompressHandlers });
}

/** What the panel listens to: as its own React part asks, for the topics that the layout shows. */
function listens(renderer, config, topic) {
  const handlers = [
    ...(renderer.topicHandlers.get(topic.name) ?? []),
    ...(renderer.schemaHandlers.get(topic.schemaName) ?? []),
  ];
  const shown = (name) => config.topics[name]?.visible === true;
  return handlers.some((h) => (h.shouldSubscribe ?? shown)(topic.name));
}

function topicsOf(file) {
  return new Map(Array.from(file.channelsById.values(), (channel) => {
    const schema = file.schemasById.get(channel.schemaId);
    const definitions = parse(new TextDecoder().decode(schema.data), { ros2: true });
    const messages = new MessageReader(definitions);
    return [channel.id, { name: channel.topic, schemaName: schema.name, messages }];
  }));
}

/** Draw a recording as it was at a time (s), seen as the layout says but for `camera`; how many messages of each topic were drawn. */
async function draw(recording, layout, seconds, camera) {
  const file = await reader(recording);
  const panel = (await (await fetch(layout)).json()).configById["3D!scene"];
  // This version draws a robot of a topic, later ones a layer that names the topic.
  const topics = { ...panel.topics, "/robot_description": { visible: true } };
  const cameraState = { ...CAMERA, ...panel.cameraState, ...camera };
  const config = { publish: {}, imageMode: {}, ...panel, topics, cameraState };
  const renderer = new Renderer(document.querySelector("canvas"), config, "3d");
  renderer.ros = true;
  renderer.setColorScheme("dark", undefined);
  const channels = topicsOf(file);
  renderer.setTopics([...channels.values()]);
  const until = BigInt(Math.round(seconds * 1e9));
  const drawn = {};
  for await (const record of file.readMessages({ endTime: until })) {
    const topic = channels.get(record.channelId);
    if (!listens(renderer, config, topic)) continue;
    const message = topic.messages.readMessage(record.data);
    const [sec, nsec] = [record.logTime / NS, record.logTime % NS].map(Number);
    const about = { topic: topic.name, schemaName: topic.schemaName, sizeInBytes: 0 };
    renderer.addMessageEvent({ ...about, message, receiveTime: { sec, nsec } });
    drawn[topic.name] = (drawn[topic.name] ?? 0) + 1;
  }
  renderer.setCurrentTime(until);
  for (let k = 0; k < 20; k++) {
    renderer.animationFrame();
    await new Promise((done) => requestAnimationFrame(done)); // fonts and models load meanwhile
  }
  return drawn;
}

window.draw = draw;
