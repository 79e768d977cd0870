#include "core/scene/shapes/mesh_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "core/base/error.h"

namespace rigor::inline scene {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL files are little-endian");

constexpr std::size_t kHeader = 84, kRecord = 50;  // bytes of a binary STL file

// The words of a line, up to a comment.
std::vector<std::string_view> words_of(std::string_view line) {
  line = line.substr(0, line.find('#'));
  std::vector<std::string_view> words;
  constexpr std::string_view kBlank = " \t\r";
  for (std::size_t at = line.find_first_not_of(kBlank); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlank, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBlank, end);
  }
  return words;
}

class MeshReader {
 public:
  MeshReader(const std::string& text, const std::string& name) : text_(text), name_(name) {}

  MeshFile obj() {
    each_line([&](const std::vector<std::string_view>& words) {
      if (words[0] == "v") add_point(words, 1);
      if (words[0] == "f") add_polygon(words);
    });
    return checked();
  }

  MeshFile stl() {
    if (is_binary()) return binary_stl();
    each_line([&](const std::vector<std::string_view>& words) {
      if (words[0] == "vertex") add_point(words, 1);
      if (words[0] == "endloop") close_triangle();
    });
    return checked();
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(line_ > 0 ? fmt::format("{}:{}: {}", name_, line_, what) : fmt::format("{}: {}", name_, what));
  }

  template <typename Visitor>
  void each_line(const Visitor& visitor) {
    for (std::size_t at = 0; at < text_.size();) {
      const std::size_t end = std::min(text_.find('\n', at), text_.size());
      ++line_;
      const auto words = words_of(std::string_view(text_).substr(at, end - at));
      if (!words.empty()) visitor(words);
      at = end + 1;
    }
    line_ = 0;
  }

  void add_point(const std::vector<std::string_view>& words, std::size_t first) {
    if (words.size() < first + 3) refuse("found fewer than three coordinates; allowed: x, y and z");
    Vec3 point;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string_view word = words[first + k];
      double value = 0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
        refuse(fmt::format("found '{}'; allowed: a finite number", word.substr(0, 40)));
      point[static_cast<Eigen::Index>(k)] = value;
    }
    mesh_.points.push_back(point);
  }

  // OBJ counts points from 1, and backwards from the last one by negative numbers.
  void add_polygon(const std::vector<std::string_view>& words) {
    std::vector<int> corners;
    const int count = static_cast<int>(mesh_.points.size());
    for (std::size_t k = 1; k < words.size(); ++k) {
      const std::string_view word = words[k].substr(0, words[k].find('/'));
      int number = 0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
      if (number < 0) number += count + 1;
      if (error != std::errc() || end != word.data() + word.size() || number < 1 || number > count)
        refuse(fmt::format("found the corner '{}'; allowed: the number of a point above it, 1 to {}",
                           words[k].substr(0, 40), count));
      corners.push_back(number - 1);
    }
    if (corners.size() < 3) refuse("found a face of fewer than three corners; allowed: three or more");
    for (std::size_t k = 1; k + 1 < corners.size(); ++k) add_triangle({corners[0], corners[k], corners[k + 1]});
  }

  void close_triangle() {
    if (mesh_.points.size() != 3 * (mesh_.triangles.size() + 1))
      refuse("found a facet that has not three vertices; allowed: triangles");
    add_last_three();
  }

  void add_last_three() {
    const int last = static_cast<int>(mesh_.points.size());
    add_triangle({last - 3, last - 2, last - 1});
  }

  void add_triangle(const std::array<int, 3>& triangle) {
    if (mesh_.triangles.size() == MeshFile::kMostTriangles)
      refuse(fmt::format("found more triangles than {}; allowed: at most so many", MeshFile::kMostTriangles));
    mesh_.triangles.push_back(triangle);
  }

  // A text file begins with "solid". So do the headers of some binary files, whose sizes tell.
  bool is_binary() const { return text_.size() >= kHeader && text_.size() == kHeader + kRecord * count_of_binary(); }

  std::size_t count_of_binary() const {
    std::uint32_t count = 0;
    std::memcpy(&count, text_.data() + kHeader - 4, 4);
    return count;
  }

  MeshFile binary_stl() {
    for (std::size_t i = 0; i < count_of_binary(); ++i) {
      std::array<float, 12> values;  // the normal and three corners
      std::memcpy(values.data(), text_.data() + kHeader + kRecord * i, sizeof values);
      for (std::size_t k = 3; k < 12; k += 3) {
        const Vec3 point(values[k], values[k + 1], values[k + 2]);
        if (!point.allFinite()) refuse(fmt::format("triangle {} has a corner that is not finite", i + 1));
        mesh_.points.push_back(point);
      }
      add_last_three();
    }
    return checked();
  }

  MeshFile checked() {
    if (mesh_.points.empty()) refuse("found no point; allowed: a file of triangles, as OBJ or STL");
    return std::move(mesh_);
  }

  const std::string& text_;
  const std::string& name_;
  std::size_t line_ = 0;
  MeshFile mesh_;
};

}  // namespace

MeshFile parse_mesh(const std::string& text, const std::string& name) {
  std::string extension = std::filesystem::path(name).extension().string();
  for (char& c : extension) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  if (extension == ".obj") return MeshReader(text, name).obj();
  if (extension == ".stl") return MeshReader(text, name).stl();
  throw InputError(fmt::format("{}: found the extension '{}'; allowed: .obj and .stl", name, extension));
}

std::string path_beside(const std::string& case_file, const std::string& name) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path parent = fs::path(case_file).parent_path();
  const fs::path folder = fs::weakly_canonical(parent.empty() ? fs::path(".") : parent, error);
  const fs::path path = fs::weakly_canonical(folder / name, error);
  const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  const bool is_inside = end == folder.end() || (std::next(end) == folder.end() && end->empty());
  if (error || fs::path(name).is_absolute() || !is_inside)
    throw InputError(
        fmt::format("found '{}', which is not in the case file's folder; allowed: a file in it or below", name));
  return path.string();
}

}  // namespace rigor::inline scene
