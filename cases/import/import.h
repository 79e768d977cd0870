// Reads robots' files as case files. URDF and SDF have readers of our own, which name unknown elements. MJCF is parsed
// by MuJoCo. No file outside the model's folder is read, and nothing from the network.
#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace rigor {

// By the ending: .urdf, .sdf, .mjcf or .xml. The root of the file decides which format it is.
bool is_model_file(const std::string& path);

struct Import {
  std::string case_text;              // a case file with `losses` and `left_out` in its comments
  std::vector<std::string> losses;    // a sentence for each kind of physics that was left out or assumed
  std::vector<std::string> left_out;  // a sentence for each element that a scene cannot say, or says otherwise
};

// `keyframe`: the name of an MJCF file's keyframe to start from; empty: the model's own state. Throws InputError,
// "file:line: what".
Import import_model(const std::string& path, const std::string& keyframe = "");

// The losses in a text that import_model() made. Empty for any other case file.
std::vector<std::string> losses_of(const std::string& case_text);

// The name of a body that falls without end, because no joint or spring holds it and nothing that stands still can be
// touched. Empty if there is none.
std::string falls_freely(const Scene& scene);

}  // namespace rigor
