// What an engine or a world that lives in another process can do beside the seam. Nobody has to know of it: who does
// saves time.
#pragma once

#include "core/engine/engine.h"

namespace rigor {

class RemoteWorld : public World {
 public:
  // The next `steps` steps are all of dt, and of them only each `every`-th is read, and the last: so that many of them
  // can be one request. Anything else asked for before they are done is our own mistake.
  virtual void expect(double dt, long steps, long every) = 0;
  // CPU seconds that its own process has spent so far, less those that this one has spent in waiting for it.
  virtual double remote_cpu_seconds() const = 0;
};

class RemoteEngine : public Engine {
 public:
  // Ends what it has started, if nothing of it is in use; the next load starts it again.
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
