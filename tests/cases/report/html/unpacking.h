// Reads back what cases/report/html packs: a second hand beside the page's own reader.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "core/base/math.h"

namespace rigor {

inline std::string from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int have = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<unsigned>(digits.find(c)), have += 6;
    if (have >= 8) have -= 8, bytes += static_cast<char>(bits >> have & 255);
  }
  return bytes;
}

inline std::string inflated(const std::string& bytes) {
  std::string out(1 << 22, '\0');
  uLongf size = out.size();
  const int answer = uncompress(reinterpret_cast<Bytef*>(out.data()), &size,
                                reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  out.resize(answer == Z_OK ? size : 0);
  return out;
}

inline double from_half(std::uint16_t bits) {
  const std::uint32_t whole = static_cast<std::uint32_t>(bits) << 16;
  float value;
  std::memcpy(&value, &whole, sizeof value);
  return value;
}

class Unpacking {
 public:
  explicit Unpacking(std::string bytes) : bytes_(std::move(bytes)) {}
  std::uint8_t u8() { return static_cast<std::uint8_t>(bytes_.at(at_++)); }
  std::uint16_t u16() { return static_cast<std::uint16_t>(u8() | u8() << 8); }
  std::uint32_t u32() {
    const std::uint32_t low = u16();
    return low | static_cast<std::uint32_t>(u16()) << 16;
  }
  float f32() { return read<float>(); }
  double f64() { return read<double>(); }
  std::vector<std::uint16_t> differences(std::size_t count) {
    std::vector<std::uint16_t> values(count);
    for (auto& value : values) value = u8();
    std::uint16_t sum = 0;
    for (auto& value : values) value = sum = static_cast<std::uint16_t>(sum + value + (u8() << 8));
    return values;
  }
  std::vector<std::size_t> samples() {
    const std::size_t count = u32();
    const auto low = differences(count), high = differences(count);
    std::vector<std::size_t> samples;
    for (std::size_t i = 0; i < count; ++i) samples.push_back(low[i] | static_cast<std::size_t>(high[i]) << 16);
    return samples;
  }
  bool is_at_end() const { return at_ == bytes_.size(); }

 private:
  template <typename T>
  T read() {
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof value);  // this machine is little-endian, as the format is
    at_ += sizeof value;
    return value;
  }
  std::string bytes_;
  std::size_t at_ = 0;
};

// The contact force of one pair at each point.
struct UnpackedForces {
  int a, b;
  std::vector<Vec3> points, forces, normals;
};

// A packed run of one body or more, as numbers.
struct UnpackedRun {
  bool is_like_truth;
  double interval, last;
  std::vector<std::size_t> keys;
  std::vector<Vec3> positions;     // of the first body at each key
  std::vector<Quat> orientations;  // likewise
  std::vector<std::size_t> points;
  std::vector<int> series;                  // numbers of names
  std::vector<std::vector<double>> values;  // of each series at each point
  std::vector<UnpackedForces> forces;
};

inline std::vector<UnpackedForces> unpacked_forces(Unpacking& in, std::size_t count) {
  std::vector<UnpackedForces> pairs(in.u32());
  for (UnpackedForces& pair : pairs) pair.a = static_cast<int>(in.u32()), pair.b = static_cast<int>(in.u32());
  if (pairs.empty()) return pairs;
  Vec3 low, extent;
  for (int k = 0; k < 3; ++k) low[k] = in.f32();
  for (int k = 0; k < 3; ++k) extent[k] = in.f32();
  const auto packed = in.differences(9 * pairs.size() * count);
  auto at = packed.begin();
  const auto vectors = [&](const auto& read) {
    std::vector<Vec3> all(count);
    for (int axis = 0; axis < 3; ++axis) {
      for (Vec3& one : all) one[axis] = read(*at++, axis);
    }
    return all;
  };
  for (UnpackedForces& pair : pairs) {
    pair.points = vectors([&](std::uint16_t bits, int axis) { return low[axis] + bits / 65535.0 * extent[axis]; });
    pair.forces = vectors([](std::uint16_t bits, int) { return from_half(bits); });
    pair.normals = vectors([](std::uint16_t bits, int) { return (bits - 32768) / 32767.0; });
  }
  return pairs;
}

inline UnpackedRun unpacked_run(const std::string& text) {
  Unpacking in(inflated(from_base64(text)));
  UnpackedRun run;
  run.is_like_truth = in.u8() == 1, run.interval = in.f64(), run.last = in.f64();
  const std::size_t bodies = in.u32();
  run.keys = in.samples();
  if (!run.keys.empty()) {
    Vec3 low, extent;
    for (int k = 0; k < 3; ++k) low[k] = in.f32();
    for (int k = 0; k < 3; ++k) extent[k] = in.f32();
    const auto packed = in.differences(6 * bodies * run.keys.size());
    for (std::size_t key = 0; key < run.keys.size(); ++key) {
      const auto share = [&](std::size_t channel) {
        return packed[channel * bodies * run.keys.size() + key] / 65535.0;
      };
      run.positions.push_back(low + extent.cwiseProduct(Vec3(share(0), share(1), share(2))));
      const Vec3 vec = 2 * Vec3(share(3), share(4), share(5)) - Vec3::Ones();
      run.orientations.emplace_back(std::sqrt(std::max(0.0, 1 - vec.squaredNorm())), vec.x(), vec.y(), vec.z());
    }
  }
  run.points = in.samples();
  run.series.resize(in.u8());
  for (int& series : run.series) series = in.u8();
  const auto packed = in.differences(run.series.size() * run.points.size());
  for (std::size_t c = 0; c < run.series.size(); ++c) {
    auto& values = run.values.emplace_back();
    for (std::size_t p = 0; p < run.points.size(); ++p) values.push_back(from_half(packed[c * run.points.size() + p]));
  }
  run.forces = unpacked_forces(in, run.points.size());
  return run;
}

}  // namespace rigor
