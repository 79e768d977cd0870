// Converts a model that MuJoCo has compiled to links, joints and shapes. It reads the compiled model with all its
// digits, not the text.
#pragma once

#include <string>

#include "core/scene/link_model.h"

namespace rigor {

// An MJCF file, by MuJoCo's own parser, in the state of the keyframe of this name; "": in the model's own. The caller
// has seen to it that the file names no other that may not be read.
LinkModel read_with_mujoco(const std::string& path, const std::string& keyframe);

}  // namespace rigor
