// Writes a scene as the reader takes it, every default written out and arrays expanded: what is read back is the same
// scene, bit for bit. Infinity is left out where that means it, as in `until`, and is the word "infinite" in friction.
#pragma once

#include <string>

#include "core/scene/scene.h"

namespace rigor {

std::string scene_toml(const Scene& scene);  // the tables [scene], [[scene.body]], ... of a case file
std::string scene_json(const Scene& scene);  // the value of `scene` as one line of JSON, with the same keys

}  // namespace rigor
