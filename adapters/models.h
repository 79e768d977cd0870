// Models in an engine's own format, read and written by what knows the engine.
#pragma once

#include <string>

#include "adapters/common/compiled_mjcf.h"
#include "core/scene/link_model.h"

namespace rigor::inline adapters {

// An MJCF file, as MuJoCo compiles it: the MuJoCo of today, where RIGOR_MUJOCO3 names it, else the one that this
// program was built with. Throws InputError with MuJoCo's words, and says which other MuJoCo would read the file.
LinkModel mujoco_link_model(const MjcfSource& source);

// A scene as MJCF; says what that cannot say. Throws InputError likewise.
std::string mjcf_of(const Scene& scene, LeftOut& left_out);

}  // namespace rigor::inline adapters
