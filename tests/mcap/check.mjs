// SPDX-License-Identifier: BSD-3-Clause
// Reads an MCAP file with Foxglove's own reader, by its indexes and from front to back, checksums and
// all, and prints the messages of each topic. With a second name, writes the same messages to it.
// usage: node check.mjs IN.mcap [OUT.mcap plain|zstd|shuffled]
import { McapIndexedReader, McapStreamReader, McapWriter } from "@mcap/core";
import { readFileSync, writeFileSync } from "node:fs";
import zstd from "@foxglove/wasm-zstd";

await zstd.isLoaded;
const [input, output, kind] = process.argv.slice(2);
const bytes = new Uint8Array(readFileSync(input));
const decompressHandlers = {
  zstd: (packed, size) => zstd.decompress(packed, Number(size)),
};

const reader = await McapIndexedReader.Initialize({
  readable: {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => bytes.subarray(Number(offset), Number(offset + size)),
  },
  decompressHandlers,
});
const counts = {};
const messages = [];
for await (const message of reader.readMessages()) {
  const topic = reader.channelsById.get(message.channelId).topic;
  counts[topic] = (counts[topic] ?? 0) + 1;
  messages.push(message);
}
for (const [channel, count] of reader.statistics.channelMessageCounts) {
  const topic = reader.channelsById.get(channel).topic;
  if (BigInt(counts[topic]) !== count) throw new Error(`${topic}: the statistics say ${count}`);
}

const stream = new McapStreamReader({ decompressHandlers, validateCrcs: true });
stream.append(bytes);
let streamed = 0;
for (let record = stream.nextRecord(); record; record = stream.nextRecord()) {
  if (record.type === "Message") ++streamed;
}
if (!stream.done()) throw new Error("the file does not end as it should");
if (streamed !== messages.length) throw new Error(`${streamed} without indexes`);
console.log(JSON.stringify(counts));

class MemoryFile {
  parts = [];
  size = 0n;
  position() {
    return this.size;
  }
  async write(part) {
    this.parts.push(part.slice());
    this.size += BigInt(part.length);
  }
}

async function write() {
  const file = new MemoryFile();
  const writer = new McapWriter({
    writable: file,
    chunkSize: 100000,
    compressChunk:
      kind === "plain"
        ? undefined
        : (chunk) => ({ compression: "zstd", compressedData: zstd.compress(chunk) }),
  });
  await writer.start({ profile: "ros2", library: "another writer" });
  const channels = new Map();
  for (const message of messages) {
    if (!channels.has(message.channelId)) {
      const channel = reader.channelsById.get(message.channelId);
      const schemaId = await writer.registerSchema(reader.schemasById.get(channel.schemaId));
      channels.set(message.channelId, await writer.registerChannel({ ...channel, schemaId }));
    }
    await writer.addMessage({ ...message, channelId: channels.get(message.channelId) });
  }
  await writer.end();
  return Buffer.concat(file.parts);
}

/// Its chunks in another order, and no index.
function shuffled(mcap) {
  const chunks = [];
  for (let at = 8; at < mcap.length - 8; ) {
    const size = 9 + Number(mcap.readBigUInt64LE(at + 1));
    if (mcap[at] === 6) chunks.push(mcap.subarray(at, at + size));
    at += size;
  }
  const magic = mcap.subarray(0, 8);
  const odd = chunks.filter((_, i) => i % 2 === 1);
  const even = chunks.filter((_, i) => i % 2 === 0);
  const end = Buffer.alloc(13 + 29);
  end[0] = 15;
  end.writeBigUInt64LE(4n, 1);
  end[13] = 2;
  end.writeBigUInt64LE(20n, 14);
  return Buffer.concat([magic, ...odd, ...even.reverse(), end, magic]);
}

if (output) {
  const mcap = await write();
  writeFileSync(output, kind === "shuffled" ? shuffled(mcap) : mcap);
}
