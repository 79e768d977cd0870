// Optional calls of an engine or world in another process. Callers that use them save round trips.
#pragma once

#include "core/engine/engine.h"

namespace rigor {

class RemoteWorld : public World {
 public:
  // The next `steps` steps all have length dt. Only every `every`-th of them, and the last, are read, so one request
  // can cover many steps. Any other call before they are done is a bug.
  virtual void expect(double dt, long steps, long every) = 0;
  // CPU seconds that its own process has spent so far, less those that this one has spent in waiting for it.
  virtual double remote_cpu_seconds() const = 0;
};

class RemoteEngine : public Engine {
 public:
  // Ends what it has started, if nothing uses it; the next load starts it again.
  virtual void rest() const = 0;
};

inline void expect_steps(World& world, double dt, long steps, long every) {
  if (auto* remote = dynamic_cast<RemoteWorld*>(&world)) remote->expect(dt, steps, every);
}

inline double remote_cpu_seconds(const World& world) {
  const auto* remote = dynamic_cast<const RemoteWorld*>(&world);
  return remote ? remote->remote_cpu_seconds() : 0;
}

}  // namespace rigor
