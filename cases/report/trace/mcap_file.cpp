#include "cases/report/trace/mcap_file.h"

#include "cases/case/recording/mcap_records.h"

namespace rigor::inline report {
namespace {

constexpr std::size_t kChunkSize = 1 << 20;  // bytes, uncompressed as they stand
template <typename Integer>
std::string bytes_of(Integer value) {
  std::string bytes;
  for (std::size_t i = 0; i < sizeof(Integer); ++i)
    bytes += static_cast<char>((static_cast<std::uint64_t>(value) >> (8 * i)) & 0xff);
  return bytes;
}

std::string sized(const std::string& bytes) { return bytes_of(static_cast<std::uint32_t>(bytes.size())) + bytes; }

std::string record(mcap::Opcode opcode, const std::string& content) {
  return std::string(1, opcode) + bytes_of(static_cast<std::uint64_t>(content.size())) + content;
}

}  // namespace

std::string McapFile::written(std::string bytes) {
  at_ += bytes.size();
  return bytes;
}

std::string McapFile::begin() {
  return written(std::string(mcap::kMagic) + record(mcap::kHeader, sized("") + sized("rigor")));
}

std::uint16_t McapFile::add_channel(const std::string& topic, const std::string& schema_name,
                                    const std::string& json_schema) {
  const auto id = static_cast<std::uint16_t>(channels_.size() + 1);  // of a schema 0 means none
  channels_.push_back(
      {record(mcap::kSchema, bytes_of(id) + sized(schema_name) + sized("jsonschema") + sized(json_schema)),
       record(mcap::kChannel, bytes_of(id) + bytes_of(id) + sized(topic) + sized("json") + sized(""))});
  chunk_ += channels_.back().schema + channels_.back().definition;
  return id;
}

std::string McapFile::add(std::uint16_t channel, std::uint64_t nanoseconds, const std::string& json) {
  if (messages_++ == 0) first_time_ = nanoseconds;
  if (chunk_entries_.empty()) chunk_first_ = nanoseconds;
  last_time_ = chunk_last_ = nanoseconds;
  chunk_entries_[channel].emplace_back(nanoseconds, chunk_.size());
  const auto sequence = static_cast<std::uint32_t>(counts_[channel]++);
  chunk_ += record(mcap::kMessage,
                   bytes_of(channel) + bytes_of(sequence) + bytes_of(nanoseconds) + bytes_of(nanoseconds) + json);
  return chunk_.size() >= kChunkSize ? close_chunk() : "";
}

std::string McapFile::close_chunk() {
  if (chunk_entries_.empty()) return "";
  ChunkIndex index{chunk_first_, chunk_last_, at_, 0, 0, chunk_.size(), {}};
  // No checksum and no compression.
  const std::string chunk =
      record(mcap::kChunk, bytes_of(index.first_time) + bytes_of(index.last_time) + bytes_of(index.records_size) +
                               bytes_of(std::uint32_t{0}) + sized("") + bytes_of(index.records_size) + chunk_);
  index.size = chunk.size();
  std::string indices;
  for (const auto& [channel, entries] : chunk_entries_) {
    index.index_at[channel] = at_ + chunk.size() + indices.size();
    std::string rows;
    for (const auto& [time, offset] : entries) rows += bytes_of(time) + bytes_of(offset);
    indices += record(mcap::kMessageIndex, bytes_of(channel) + sized(rows));
  }
  index.index_size = indices.size();
  chunks_.push_back(index);
  chunk_.clear(), chunk_entries_.clear();
  return written(chunk + indices);
}

std::string McapFile::end() {
  std::string text = close_chunk();
  text += written(record(mcap::kDataEnd, bytes_of(std::uint32_t{0})));
  const std::uint64_t summary_at = at_;
  std::string summary;
  for (const Channel& channel : channels_) summary += channel.schema + channel.definition;
  for (const ChunkIndex& chunk : chunks_) {
    std::string offsets;
    for (const auto& [channel, at] : chunk.index_at) offsets += bytes_of(channel) + bytes_of(at);
    summary += record(mcap::kChunkIndex, bytes_of(chunk.first_time) + bytes_of(chunk.last_time) + bytes_of(chunk.at) +
                                             bytes_of(chunk.size) + sized(offsets) + bytes_of(chunk.index_size) +
                                             sized("") + bytes_of(chunk.records_size) + bytes_of(chunk.records_size));
  }
  std::string counts;
  for (const auto& [channel, count] : counts_) counts += bytes_of(channel) + bytes_of(count);
  const auto channels = static_cast<std::uint32_t>(channels_.size());
  summary +=
      record(mcap::kStatistics, bytes_of(messages_) + bytes_of(static_cast<std::uint16_t>(channels)) +
                                    bytes_of(channels) + bytes_of(std::uint32_t{0}) + bytes_of(std::uint32_t{0}) +
                                    bytes_of(static_cast<std::uint32_t>(chunks_.size())) + bytes_of(first_time_) +
                                    bytes_of(last_time_) + sized(counts));
  return text + summary +
         record(mcap::kFooter, bytes_of(summary_at) + bytes_of(std::uint64_t{0}) + bytes_of(std::uint32_t{0})) +
         std::string(mcap::kMagic);
}

}  // namespace rigor::inline report
