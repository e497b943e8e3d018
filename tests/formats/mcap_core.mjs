// mcap_core.mjs FILE: decodes every message of an MCAP file against the schema beside it, by the MCAP project's own reader and
// Foxglove's decoder of ROS 2 messages. scripts/try-mcap installs them. Prints topics with their counts.
import fs from "node:fs/promises";
import { McapIndexedReader } from "@mcap/core";
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { decompress } from "fzstd";

const file = await fs.open(process.argv[2], "r");
const readable = {
  size: async () => BigInt((await file.stat()).size),
  read: async (offset, length) => {
    const bytes = new Uint8Array(Number(length));
    await file.read(bytes, 0, Number(length), Number(offset));
    return bytes;
  },
};
const decompressHandlers = { zstd: (bytes, size) => decompress(bytes, new Uint8Array(Number(size))) };
const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
const decoders = new Map();
const counts = {};
for await (const message of reader.readMessages()) {
  const channel = reader.channelsById.get(message.channelId);
  const schema = reader.schemasById.get(channel.schemaId);
  if (!decoders.has(schema.id))
    decoders.set(schema.id, new MessageReader(parse(new TextDecoder().decode(schema.data), { ros2: true })));
  decoders.get(schema.id).readMessage(message.data);
  counts[`${channel.topic} (${schema.name})`] = (counts[`${channel.topic} (${schema.name})`] ?? 0) + 1;
}
const total = Object.values(counts).reduce((sum, count) => sum + count, 0);
for (const [topic, count] of Object.entries(counts)) console.log(`${count}\t${topic}`);
if (BigInt(total) !== reader.statistics.messageCount) {
  console.error(`${total} messages decoded, the file tells of ${reader.statistics.messageCount}`);
  process.exit(1);
}
console.log(`${total} messages decoded`);
