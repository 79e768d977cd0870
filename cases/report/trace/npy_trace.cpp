// NumPy's file format 1.0 (numpy.lib.format): a magic, the length of a header, the header as a Python literal, and the
// rows of a structured array. A row is a time [s], a body's name and its thirteen numbers, as in CSV.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "cases/report/trace/trace_formats.h"
#include "core/base/error.h"

namespace rigor::inline report {
namespace {

static_assert(std::endian::native == std::endian::little, "the rows are little-endian");

// The characters of UTF-8 as code points. A byte that is no UTF-8 becomes the replacement character.
std::u32string code_points(const std::string& text) {
  std::u32string points;
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const std::size_t length = byte < 0x80 ? 1 : byte >> 5 == 6 ? 2 : byte >> 4 == 14 ? 3 : byte >> 3 == 30 ? 4 : 0;
    char32_t point = length == 1 ? byte : length == 0 ? 0xFFFD : byte & (0x7F >> length);
    for (std::size_t k = 1; k < length; ++k) {
      const bool goes_on = i + k < text.size() && (static_cast<unsigned char>(text[i + k]) & 0xC0) == 0x80;
      point = goes_on && point != 0xFFFD ? point << 6 | (static_cast<unsigned char>(text[i + k]) & 0x3F) : 0xFFFD;
    }
    points += point;
    i += std::max<std::size_t>(length, 1);
  }
  return points;
}

class NpyTrace : public TraceWriter {
 public:
  explicit NpyTrace(const Scene& scene) {
    for (const Body& body : scene.bodies) names_.push_back(code_points(body.name));
    for (const std::u32string& name : names_) width_ = std::max(width_, name.size());
    width_ += width_ % 2;  // numbers then stay aligned
    for (std::u32string& name : names_) name.resize(width_, U'\0');
  }

  std::string begin(std::size_t samples) override {
    std::string header = fmt::format("{{'descr': [('time', '<f8'), ('body', '<U{}')", width_);
    for (const char* name : kColumnNames) header += fmt::format(", ('{}', '<f8')", name);
    header += fmt::format("], 'fortran_order': False, 'shape': ({},), }}", samples * names_.size());
    constexpr std::size_t kFixed = 10, kAlignment = 64;  // bytes before the header, and of which it ends at a multiple
    header.resize((kFixed + header.size() + kAlignment) / kAlignment * kAlignment - kFixed - 1, ' ');
    header += '\n';
    std::string start("\x93NUMPY\x01\x00", 8);
    start += static_cast<char>(header.size() % 256);
    start += static_cast<char>(header.size() / 256);
    return start + header;
  }

  std::string add(const Sample& sample) override {
    const BodyColumns bodies = sample.bodies.columns();
    const std::size_t size_of_name = width_ * sizeof(char32_t);
    std::string rows(names_.size() * (14 * sizeof(double) + size_of_name), '\0');
    char* at = rows.data();
    const auto put = [&](const void* from, std::size_t size) { std::memcpy(at, from, size), at += size; };
    for (std::size_t i = 0; i < names_.size(); ++i) {
      put(&sample.time, sizeof(double));
      put(names_[i].data(), size_of_name);
      for (int c = 0; c < 13; ++c) put(bodies.column(c) + i, sizeof(double));
    }
    return rows;
  }

 private:
  std::vector<std::u32string> names_;  // each of width_ characters, filled up with zeros
  std::size_t width_ = 2;              // even
};

}  // namespace

std::unique_ptr<TraceWriter> npy_trace(const Scene& scene, bool has_contacts) {
  if (has_contacts) throw InputError("--contacts: an array of NumPy has the bodies' states alone; use --format csv");
  return std::make_unique<NpyTrace>(scene);
}

}  // namespace rigor::inline report
