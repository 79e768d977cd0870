// The core's public face: read a scene, load it, step it, read it. A program that embeds the core includes this
// header.
#pragma once

#include <memory>
#include <string>

#include "core/base/error.h"
#include "core/engine/engine.h"
#include "core/scene/scene.h"

namespace rigor {

// Reads the `[scene]` of a case file. Throws InputError with file, line and column of the first mistake.
Scene read_scene_file(const std::string& path);

// The core's methods with their options, and the features that it supports.
const EngineInfo& core_info();

// A world at t = 0. `run` is a run name, for example "core:rk4" or "core:velocity-verlet,contact=event". The world
// copies what it needs from the scene. Throws InputError for an unknown name, with a near match, and for a scene that
// the method does not support, with the reason.
std::unique_ptr<World> load_world(const Scene& scene, const std::string& run = "core");

}  // namespace rigor
