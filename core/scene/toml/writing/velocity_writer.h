// A case file's text with other initial velocities of its bodies; all else stays as it was written.
#pragma once

#include <string>

#include "core/scene/scene.h"

namespace rigor::inline scene {

class TomlFile;
class TomlValue;

// `settled` is the file's `scene`, with the velocities to write. Those of an array's copies, of which each would need
// its own, are not in the file and are left out.
std::string with_velocities(const TomlFile& file, const TomlValue& scene, const Scene& settled);

}  // namespace rigor::inline scene
