// A scene in DART. Nothing of DART's own headers shows here: they take a compiler a quarter of a minute.
#pragma once

#include "core/engine/engine.h"

namespace rigor::inline adapters {

// Throws EngineFailure (unsupported) for cases that features do not cover: a slider or universal joint that closes a
// loop, a limit that bounces, a coefficient that DART treats as zero.
std::unique_ptr<World> make_dart_world(const Scene& scene, const Settings& settings);

}  // namespace rigor::inline adapters
