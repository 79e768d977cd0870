// Reads the records of an MCAP file (mcap.dev/spec): its channels and messages, inside chunks and outside.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace rigor::inline cases {

// Of a file's form, for readers and writers.
namespace mcap {
inline constexpr std::string_view kMagic = "\x89MCAP0\r\n";
enum Opcode : char {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0b,
  kDataEnd = 0x0f
};
}  // namespace mcap

struct McapChannel {
  std::string topic, encoding, schema;  // the schema's name
};

struct McapMessage {
  std::string topic;
  std::uint64_t time;  // ns, when it was logged
  std::string_view data;
  std::size_t place;  // byte of the file, or of the chunk's records
};

struct McapReader {
  std::function<void(const McapChannel&)> on_channel;  // once for each id
  std::function<void(const McapMessage&)> on_message;
};

// In the order of the file. Throws InputError, beginning with the path, for a file that is cut off or damaged, and for
// compressed chunks.
void read_mcap(std::string_view file, const std::string& path, const McapReader& reader);

}  // namespace rigor::inline cases
