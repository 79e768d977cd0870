// Models in an engine's own format, read and written by what knows the engine.
#pragma once

#include <string>

#include "core/scene/link_model.h"

namespace rigor {

// An MJCF file, as MuJoCo compiles it; in the state of the keyframe of this name, or, without one, in the model's own.
// Throws InputError with MuJoCo's words, or with the package to install where the program was built without it.
LinkModel mujoco_link_model(const std::string& path, const std::string& keyframe);

// A scene as MJCF; says what that cannot say. Throws InputError likewise.
std::string mjcf_of(const Scene& scene, LeftOut& left_out);

}  // namespace rigor
