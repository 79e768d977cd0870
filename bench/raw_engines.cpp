#include "bench/raw_engines.h"

namespace rigor::bench {

std::unique_ptr<RawWorld> raw_bullet(const Scene& scene);
std::unique_ptr<RawWorld> raw_dart(const Scene& scene);
std::unique_ptr<RawWorld> raw_mujoco(const Scene& scene);
std::unique_ptr<RawWorld> raw_ode(const Scene& scene);
std::unique_ptr<RawWorld> raw_simbody(const Scene& scene);

const std::vector<RawEngine>& raw_engines() {
  static const std::vector<RawEngine> rows = {
      {"bullet", "sequential-impulse", raw_bullet},
#ifdef RIGOR_WITH_DART
      {"dart", "dantzig", raw_dart},
#endif
#ifdef RIGOR_WITH_MUJOCO
      {"mujoco", "euler", raw_mujoco},
#endif
      {"ode", "worldstep", raw_ode},
#ifdef RIGOR_WITH_SIMBODY
      {"simbody", "merson", raw_simbody},
#endif
  };
  return rows;
}

}  // namespace rigor::bench
