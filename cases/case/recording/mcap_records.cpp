#include "cases/case/recording/mcap_records.h"

#include <fmt/format.h>

#include <boost/crc.hpp>
#include <map>

#include "core/base/error.h"
#include "core/scene/toml/table_reader.h"

namespace rigor::inline cases {
namespace {

// Bytes that are read from front to back.
class McapBytes {
 public:
  McapBytes(std::string_view bytes, const std::string& path, std::size_t place)
      : left_(bytes), path_(path), place_(place) {}

  bool is_over() const { return left_.empty(); }
  std::size_t place() const { return place_; }

  std::string_view take(std::uint64_t count) {
    if (count > left_.size())
      refuse(fmt::format("the file is cut off or damaged: {} bytes are missing here; allowed: a whole MCAP file",
                         count - left_.size()));
    const std::string_view taken = left_.substr(0, count);
    left_.remove_prefix(count), place_ += count;
    return taken;
  }
  template <typename Integer>
  Integer integer() {
    std::uint64_t value = 0;
    const std::string_view bytes = take(sizeof(Integer));
    for (std::size_t i = sizeof(Integer); i > 0; --i) value = value << 8 | static_cast<unsigned char>(bytes[i - 1]);
    return static_cast<Integer>(value);
  }
  std::string text() { return std::string(take(integer<std::uint32_t>())); }
  std::string_view rest() { return take(left_.size()); }

  [[noreturn]] void refuse(const std::string& fault) const {
    throw InputError(fmt::format("{}: byte {}: {}", path_, place_, fault));
  }

 private:
  std::string_view left_;
  const std::string& path_;
  std::size_t place_;
};

class McapParser {
 public:
  McapParser(const std::string& path, const McapReader& reader) : path_(path), reader_(reader) {}

  void read_file(std::string_view file) {
    McapBytes bytes(file, path_, 0);
    if (bytes.take(std::min(file.size(), mcap::kMagic.size())) != mcap::kMagic)
      throw InputError(path_ + ": is no MCAP file; allowed: one that begins with its magic bytes");
    while (!read_record(bytes)) {
    }
    if (bytes.rest() != mcap::kMagic)
      bytes.refuse("the magic bytes at the end are missing; allowed: a whole MCAP file");
  }

 private:
  // Returns whether it was the last one.
  bool read_record(McapBytes& bytes) {
    const auto opcode = bytes.integer<char>();
    const auto size = bytes.integer<std::uint64_t>();
    const std::size_t place = bytes.place();
    McapBytes content(bytes.take(size), path_, place);
    if (opcode == mcap::kSchema) {
      const auto id = content.integer<std::uint16_t>();
      schemas_[id] = content.text();
    } else if (opcode == mcap::kChannel) {
      read_channel(content);
    } else if (opcode == mcap::kMessage) {
      read_message(content);
    } else if (opcode == mcap::kChunk) {
      read_chunk(content);
    }
    return opcode == mcap::kFooter;
  }

  // The summary at the end repeats channels.
  void read_channel(McapBytes& content) {
    const auto id = content.integer<std::uint16_t>(), schema = content.integer<std::uint16_t>();
    McapChannel channel;
    channel.topic = content.text(), channel.encoding = content.text(), channel.schema = schemas_[schema];
    if (channels_.try_emplace(id, channel).second) reader_.on_channel(channel);
  }

  void read_message(McapBytes& content) {
    const std::size_t place = content.place();
    const auto channel = channels_.find(content.integer<std::uint16_t>());
    if (channel == channels_.end()) content.refuse("a message comes before its channel; allowed: channels first");
    content.integer<std::uint32_t>();  // the number in its sequence
    const auto time = content.integer<std::uint64_t>();
    content.integer<std::uint64_t>();  // when it was published
    reader_.on_message({channel->second.topic, time, content.rest(), place});
  }

  void read_chunk(McapBytes& content) {
    if (is_in_chunk_) content.refuse("a chunk lies in another one; allowed: schemas, channels and messages");
    content.integer<std::uint64_t>(), content.integer<std::uint64_t>();  // its first and last time
    const auto size = content.integer<std::uint64_t>();
    const auto checksum = content.integer<std::uint32_t>();
    const std::string compression = content.text();
    if (!compression.empty())
      content.refuse(
          fmt::format("the chunk is compressed with '{}'; allowed: no compression, as `rigor trace "
                      "--format mcap` writes",
                      shown(compression)));
    const std::string_view records = content.take(content.integer<std::uint64_t>());
    if (records.size() != size)
      content.refuse(fmt::format("the chunk has {} bytes and says {}; allowed: equal sizes", records.size(), size));
    boost::crc_32_type found;
    found.process_bytes(records.data(), records.size());
    if (checksum != 0 && checksum != found.checksum())  // 0: there is none
      content.refuse("the chunk's checksum differs from its content; the file is damaged");
    McapBytes inside(records, path_, content.place() - records.size());
    is_in_chunk_ = true;
    while (!inside.is_over()) read_record(inside);
    is_in_chunk_ = false;
  }

  const std::string& path_;
  const McapReader& reader_;
  std::map<std::uint16_t, std::string> schemas_;  // names
  std::map<std::uint16_t, McapChannel> channels_;
  bool is_in_chunk_ = false;
};

}  // namespace

void read_mcap(std::string_view file, const std::string& path, const McapReader& reader) {
  McapParser(path, reader).read_file(file);
}

}  // namespace rigor::inline cases
