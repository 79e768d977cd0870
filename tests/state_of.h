// The state of a world, as it is read.
#pragma once

#include "core/engine/engine.h"

namespace rigor {

inline BodyTable state_of(const World& world) {
  Snapshot snapshot;
  world.read(snapshot);
  return BodyTable(snapshot.bodies());
}

}  // namespace rigor
