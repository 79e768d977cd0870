// Robots' files as case files: URDF and SDF by readers of our own, which name what they do not know, MJCF by MuJoCo's
// own parser. No file outside the model's folder is read, and none that the network would have to be asked for.
#pragma once

#include <string>
#include <vector>

namespace rigor {

// By its ending: .urdf, .sdf, .mjcf or .xml. What is in it is known by its root, whatever the ending.
bool is_model_file(const std::string& path);

struct Import {
  std::string case_text;              // a case file, the lines of left_out in its comments
  std::vector<std::string> left_out;  // a sentence each: what a scene cannot say, or says otherwise
};

// `keyframe`: of an MJCF file, the name of the one to start from; empty: the model's own state. Throws InputError,
// "file:line: what".
Import import_model(const std::string& path, const std::string& keyframe = "");

// Those of a text that import_model() made; none of any other case file's.
std::vector<std::string> left_out_of(const std::string& case_text);

}  // namespace rigor
