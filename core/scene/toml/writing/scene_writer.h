// Writes a scene in the reader's form, with every default written out and arrays expanded. Reading it gives the same
// scene, bit for bit. Infinity is left out where that means infinity, as in `until`, and is the word "infinite" in
// friction.
#pragma once

#include <string>

#include "core/scene/scene.h"

namespace rigor::inline scene {

std::string scene_toml(const Scene& scene);  // the tables [scene], [[scene.body]], ... of a case file
std::string scene_json(const Scene& scene);  // the value of `scene` as one line of JSON, with the same keys
// {"type": …, …} as one line of JSON; of a compound a list of these, with their poses.
std::string shape_json(const Shape& shape);

}  // namespace rigor::inline scene
