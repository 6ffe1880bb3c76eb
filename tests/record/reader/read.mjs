// Reads MCAP recordings and decodes every message by the IDL in the file. usage: node read.mjs [--torn] FILE...
// One JSON line a file: messages, those that did not decode, counts per topic, the first decoded of each topic.
// --torn: read from the front up to where the file ends, as the summary may be missing.
import { readFileSync } from "node:fs";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { parseIDL } from "@foxglove/omgidl-parser";
import { MessageReader } from "@foxglove/omgidl-serialization";
import { decompress } from "fzstd";

const decompressHandlers = { zstd: (data, size) => decompress(data, new Uint8Array(Number(size))) };
const plain = (_, value) =>
  typeof value === "bigint" ? value.toString() : ArrayBuffer.isView(value) ? Array.from(value).slice(0, 16) : value;

class Decoder {
  result = { messages: 0, failed: 0, without_schema: 0, errors: [], topics: {}, samples: {} };
  #readers = new Map();

  add(channel, schema, message) {
    const { result } = this;
    result.messages++;
    result.topics[channel.topic] = (result.topics[channel.topic] ?? 0) + 1;
    try {
      if (!schema) {
        result.without_schema++;
        throw new Error(`${channel.topic}: no schema`);
      }
      if (schema.encoding !== "omgidl" || channel.messageEncoding !== "cdr")
        throw new Error(`${channel.topic}: ${schema.encoding}, ${channel.messageEncoding}`);
      if (!this.#readers.has(schema.id))
        this.#readers.set(schema.id, new MessageReader(schema.name, parseIDL(new TextDecoder().decode(schema.data))));
      const decoded = this.#readers.get(schema.id).readMessage(message.data);
      result.samples[channel.topic] ??= { metadata: Object.fromEntries(channel.metadata), message: decoded };
    } catch (error) {
      result.failed++;
      if (result.errors.length < 5) result.errors.push(`${channel.topic}: ${error.message}`);
    }
  }
}

async function indexed(bytes) {
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => bytes.subarray(Number(offset), Number(offset + size)),
  };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  const decoder = new Decoder();
  let before = -1n;
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    if (message.logTime < before) throw new Error("messages out of order");
    before = message.logTime;
    const channel = reader.channelsById.get(message.channelId);
    decoder.add(channel, reader.schemasById.get(channel.schemaId), message);
  }
  if (Number(reader.statistics.messageCount) !== decoder.result.messages)
    decoder.result.errors.push(`the statistics say ${reader.statistics.messageCount} messages`);
  decoder.result.metadata = {};
  for await (const entry of reader.readMetadata())
    decoder.result.metadata[entry.name] = Object.fromEntries(entry.metadata);
  return decoder.result;
}

function streamed(bytes, torn) {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  const decoder = new Decoder();
  const schemas = new Map(), channels = new Map();
  reader.append(bytes);
  for (let record; (record = reader.nextRecord()); ) {
    if (record.type === "Schema") schemas.set(record.id, record);
    if (record.type === "Channel") channels.set(record.id, record);
    if (record.type !== "Message") continue;
    const channel = channels.get(record.channelId);
    decoder.add(channel, schemas.get(channel.schemaId), record);
  }
  if (!torn && !reader.done()) decoder.result.errors.push("the file has no end");
  return decoder.result;
}

let failed = false;
const torn = process.argv.includes("--torn");
for (const file of process.argv.slice(2).filter((word) => word !== "--torn")) {
  const bytes = new Uint8Array(readFileSync(file));
  const front = streamed(bytes, torn);
  const result = torn ? front : await indexed(bytes);
  if (!torn && front.messages !== result.messages)
    result.errors.push(`${front.messages} messages from the front, ${result.messages} by the index`);
  failed ||= result.failed > 0 || result.errors.length > 0;
  console.log(JSON.stringify({ file, ...result }, plain));
}
process.exit(failed ? 1 : 0);
