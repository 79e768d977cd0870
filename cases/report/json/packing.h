// Bytes for the page: little-endian numbers, deflated and in base64, so that they can stand in HTML and JSON.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace rigor::inline report {

class Bytes {
 public:
  void add_u8(std::uint8_t value) { data_ += static_cast<char>(value); }
  void add_u16(std::uint16_t value);
  void add_u32(std::uint32_t value);
  void add_f32(float value);
  void add_f64(double value);
  // Differences from one value to the next, first all low bytes, then all high ones: smooth series deflate well so.
  void add_differences(const std::vector<std::uint16_t>& values);
  const std::string& data() const { return data_; }

 private:
  std::string data_;
};

// The upper half of a float32: 8 bits of mantissa, which is 0.4 % and enough for a plot. Rounded to nearest.
std::uint16_t half_of_float(double value);

// 0 to 65535 for 0 to 1; what lies beyond is cut.
std::uint16_t quantised(double share);

std::string base64(const std::string& bytes);
std::string deflated(const std::string& bytes);  // as zlib writes it (RFC 1950)

// The reverse. Throws std::runtime_error for damaged text, and for content of more than `limit` bytes.
std::string from_base64(std::string_view text);
std::string inflated(const std::string& bytes, std::size_t limit);

}  // namespace rigor::inline report
