// [scene] of a case file: bodies, springs, joints, contacts and forces.
#pragma once

#include "core/scene/scene.h"

namespace rigor {

class TomlValue;

// Throws InputError with the file, line, column and key of the first thing that no scene can have. A contact pair that
// leaves out its restitution or friction takes the one of contact_default, which is 0 if that leaves it out too.
Scene read_scene(const TomlValue& value);

}  // namespace rigor
