#include "cases/report/json/packing.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace rigor::inline report {
namespace {

constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

}  // namespace

void Bytes::add_u16(std::uint16_t value) {
  add_u8(static_cast<std::uint8_t>(value)), add_u8(static_cast<std::uint8_t>(value >> 8));
}

void Bytes::add_u32(std::uint32_t value) {
  add_u16(static_cast<std::uint16_t>(value)), add_u16(static_cast<std::uint16_t>(value >> 16));
}

void Bytes::add_f32(float value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  add_u32(bits);
}

void Bytes::add_f64(double value) {
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  add_u32(static_cast<std::uint32_t>(bits)), add_u32(static_cast<std::uint32_t>(bits >> 32));
}

void Bytes::add_differences(const std::vector<std::uint16_t>& values) {
  const auto difference = [&](std::size_t i) -> unsigned { return values[i] - (i == 0 ? 0u : values[i - 1]); };
  for (std::size_t i = 0; i < values.size(); ++i) add_u8(static_cast<std::uint8_t>(difference(i)));
  for (std::size_t i = 0; i < values.size(); ++i) add_u8(static_cast<std::uint8_t>(difference(i) >> 8));
}

std::uint16_t half_of_float(double value) {
  constexpr std::uint16_t kNotANumber = 0x7fc0;
  const float number = static_cast<float>(value);
  if (!std::isfinite(number)) return kNotANumber;
  std::uint32_t bits;
  std::memcpy(&bits, &number, sizeof bits);
  return static_cast<std::uint16_t>((bits + 0x8000u) >> 16);
}

std::uint16_t quantised(double share) {
  return static_cast<std::uint16_t>(std::lround(65535 * std::clamp(share, 0.0, 1.0)));
}

std::string base64(const std::string& bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) -> unsigned {
      return k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0;
    };
    const unsigned group = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    for (int digit = 0; digit < 4; ++digit) {
      text += i + digit <= bytes.size() ? kDigits[group >> (18 - 6 * digit) & 63] : '=';
    }
  }
  return text;
}

std::string deflated(const std::string& bytes) {
  std::string out(compressBound(bytes.size()), '\0');
  uLongf size = out.size();
  const int answer = compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                               reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), Z_BEST_COMPRESSION);
  if (answer != Z_OK) throw std::runtime_error("zlib could not deflate the report's data");
  out.resize(size);
  return out;
}

std::string from_base64(std::string_view text) {
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  while (text.ends_with('=')) text.remove_suffix(1);
  for (const char c : text) {
    const char* found = c == '\0' ? nullptr : std::strchr(kDigits, c);
    if (!found) throw std::runtime_error("the packed data is not base64");
    bits = bits << 6 | static_cast<unsigned>(found - kDigits), count += 6;
    if (count >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 255);
  }
  return bytes;
}

std::string inflated(const std::string& bytes, std::size_t limit) {
  std::string out(std::min(limit, 16 * bytes.size() + 1024), '\0');
  for (;;) {
    uLongf size = out.size();
    const int answer = uncompress(reinterpret_cast<Bytef*>(out.data()), &size,
                                  reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
    if (answer == Z_OK) return out.resize(size), out;
    if (answer != Z_BUF_ERROR || out.size() >= limit)
      throw std::runtime_error("the packed data is damaged or too long");
    out.resize(std::min(limit, 4 * out.size()));
  }
}

}  // namespace rigor::inline report
