// An MJCF model as MuJoCo has compiled it, as plain data: of whichever MuJoCo read the file.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

namespace rigor::inline adapters {

// What an import of an MJCF file needs beside its path.
struct MjcfSource {
  std::string path, keyframe;                 // keyframe "": the model's own state
  std::vector<std::string> files;             // all that it names, as paths relative to its folder
  std::map<std::string, std::string> places;  // "file:line" by "joint/elbow"

  // "file:line: joint 'elbow'"; without a name, "file: joint 3".
  std::string place_of(const std::string& what, const std::string& name, int index) const;
};

struct CompiledMjcf {
  std::string parser;  // "MuJoCo 3.14.0"
  // The arrays of mjModel by their names, and the option's as "opt_gravity". The state to start from has the arrays
  // xpos, xquat, xanchor, xaxis, qpos, ctrl and act of mjData, and "velocity": of each body's origin in W, angular,
  // then linear.
  std::map<std::string, std::vector<double>> numbers;
  std::map<std::string, std::vector<std::string>> names;  // "body", "joint", "geom", …; "" without a name
  std::set<std::string> off;                              // what <flag> switches off: "contact", "limit", …
  std::vector<std::string> warnings;
  bool adds_margins = false;  // a pair's margin is the sum of both, as in MuJoCo 3.14; else the larger one, as in 2.2.2

  double at(const std::string& name, std::size_t index) const;  // 0 for what this MuJoCo does not have
  int whole(const std::string& name, std::size_t index) const { return static_cast<int>(at(name, index)); }
  std::size_t size(const std::string& name) const;
  bool has(const std::string& name) const { return size(name) > 0; }
  std::string name_of(const std::string& kind, std::size_t index) const;
  // Removes what the file switches off, and what a model without it would not have.
  void take_switches();
};

}  // namespace rigor::inline adapters
