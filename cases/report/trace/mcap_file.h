// MCAP (mcap.dev/spec): records of an opcode, a length and a content, all integers little-endian; messages in chunks,
// each with an index, and a summary at the end by which a reader finds them.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace rigor::inline report {

class McapFile {
 public:
  // Returns the head of the file.
  std::string begin();
  // A channel of JSON messages; before the first message. Returns its id.
  std::uint16_t add_channel(const std::string& topic, const std::string& schema_name, const std::string& json_schema);
  // Returns the data to write next, possibly none yet. Times must not decrease.
  std::string add(std::uint16_t channel, std::uint64_t nanoseconds, const std::string& json);
  std::string end();

 private:
  struct Channel {
    std::string schema, definition;  // records
  };
  struct ChunkIndex {
    std::uint64_t first_time, last_time, at, size, index_size, records_size;
    std::map<std::uint16_t, std::uint64_t> index_at;  // by channel: where its index stands
  };
  using Entries = std::vector<std::pair<std::uint64_t, std::uint64_t>>;  // time, offset in the chunk

  std::string close_chunk();
  std::string written(std::string bytes);  // counts them

  std::uint64_t at_ = 0;  // bytes written so far
  std::vector<Channel> channels_;
  std::map<std::uint16_t, std::uint64_t> counts_;  // messages
  std::uint64_t first_time_ = 0, last_time_ = 0, messages_ = 0;
  std::string chunk_;
  std::uint64_t chunk_first_ = 0, chunk_last_ = 0;
  std::map<std::uint16_t, Entries> chunk_entries_;
  std::vector<ChunkIndex> chunks_;
};

}  // namespace rigor::inline report
