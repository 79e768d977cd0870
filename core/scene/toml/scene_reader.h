// Reads [scene] of a case file: bodies and arrays of them, springs, joints, motors, contacts and forces.
#pragma once

#include "core/scene/scene.h"

namespace rigor::inline scene {

class TomlValue;

// The keys of a case file, in the order in which messages list them. The core reads "scene" only.
const std::vector<std::string>& case_keys();
// The keys of [scene], in the order in which messages list them.
const std::vector<std::string>& scene_keys();

// Throws InputError with the file, line, column and key of the first thing that no scene can have. A contact pair that
// leaves out a value takes the one of contact_default, which is 0 if that leaves it out too.
// Initial velocities that break a joint are refused, unless they are read to be mended.
enum class InitialVelocities { checked, as_given };
Scene read_scene(const TomlValue& value, InitialVelocities velocities = InitialVelocities::checked);

}  // namespace rigor::inline scene
