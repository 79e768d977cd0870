// node mcap_check.mjs NPM_FOLDER FILE: what Foxglove's own reader finds in it, one line of JSON.
import { createRequire } from "node:module";
import { readFileSync } from "node:fs";

const [folder, file] = process.argv.slice(2);
const { McapIndexedReader, McapStreamReader } = createRequire(`${folder}/`)("@mcap/core");
const bytes = new Uint8Array(readFileSync(file));

const readable = {
  size: async () => BigInt(bytes.length),
  read: async (offset, size) => bytes.slice(Number(offset), Number(offset + size)),
};
const reader = await McapIndexedReader.Initialize({ readable });
const schemas = Object.fromEntries([...reader.schemasById.values()].map((s) => [s.name, JSON.parse(new TextDecoder().decode(s.data)).title]));
const found = { schemas, chunks: reader.chunkIndexes.length, messages: {}, first: {}, last: {}, times: [] };
for await (const message of reader.readMessages()) {
  const { topic } = reader.channelsById.get(message.channelId);
  const value = JSON.parse(new TextDecoder().decode(message.data));
  found.messages[topic] = (found.messages[topic] ?? 0) + 1;
  found.first[topic] ??= value;
  found.last[topic] = value;
  if (topic === "/tf") found.times.push(Number(message.logTime) / 1e9);
}
// Without the index, from beginning to end, which checks each record's length.
const stream = new McapStreamReader({ validateCrcs: true });
stream.append(bytes);
let messages = 0;
for (let record; (record = stream.nextRecord()); ) messages += record.type === "Message";
if (!stream.done() || messages !== Number(reader.statistics.messageCount)) throw new Error("the records do not end where the file does");
console.log(JSON.stringify(found));
