// Bodies by name, for everything in a case file that refers to one; and the arrays of bodies, [[scene.array]], whose
// springs and joints are written once and stand for every copy.
#pragma once

#include <array>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/scene/scene.h"
#include "core/scene/toml/table_reader.h"

namespace rigor::inline scene {

// A body and its copies on a grid. The copy at (i, j, k), counted from 0, is body first + i + nx (j + ny k).
struct BodyArray {
  std::string body;  // the name in the file; the copies are "link-1", "link-2", ..., or "ball-1-1-1" where there are
                     // several along more than one axis
  std::array<int, 3> count = {1, 1, 1};
  Vec3 spacing = Vec3::Zero();  // m, in W
  double jitter = 0;            // m: each copy is moved by up to as much along each axis of W
  double seed = 0;
  std::string where;  // "file:line:column"
  int first = kWorld;

  int copies() const { return count[0] * count[1] * count[2]; }
  std::string name_of(const std::array<int, 3>& at) const;
};

inline constexpr double kMostCopies = 1e6;  // of one array

const Keys& array_keys();
BodyArray read_array(const TableReader& row);
// The copies of a body, in their order; the offsets of the grid without the jitter are offset_of().
std::vector<Body> copies_of(const Body& body, const BodyArray& array);
Vec3 offset_of(const BodyArray& array, const std::array<int, 3>& at);

// The two ends of one spring or joint: of a row on an array one for each copy.
struct Ends {
  int a = kWorld, b = kWorld;
  Vec3 offset = Vec3::Zero();  // m, from the first body to this copy: positions in W are moved by it
  std::string copy = "";       // the end of a joint's name, "-3"
};

class BodyIndex {
 public:
  void add(const std::string& name, int index, const std::string& where);
  // Before bodies are added, so that a body knows that it stands for its copies.
  void add_array(BodyArray array, const TomlValue& name);
  BodyArray* find_array(const std::string& body);
  void check_arrays_are_used() const;

  int body(const TomlValue& value) const { return find(value, false); }

  // "link" stands for each copy of an array, "link+x" for the one next to it along the array's x.
  std::vector<Ends> ends(const TomlValue& a, const TomlValue& b) const;

 private:
  struct End {
    const BodyArray* array = nullptr;  // null: `body` it is
    int body = kWorld;
    std::array<int, 3> step = {0, 0, 0};
  };
  End find_end(const TomlValue& value) const;
  int find(const TomlValue& value, bool world_allowed) const;
  std::vector<std::string> known(bool world_allowed) const;

  std::unordered_map<std::string, std::pair<int, std::string>> index_;  // the body's index, and where its name stands
  std::unordered_map<std::string, BodyArray> arrays_;
};

}  // namespace rigor::inline scene
