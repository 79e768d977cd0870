#include "adapters/calls.h"

#include "adapters/bullet/bullet_calls.h"
#ifdef RIGOR_WITH_DART
#include "adapters/dart/dart_calls.h"
#endif
#ifdef RIGOR_WITH_MUJOCO
#include "adapters/mujoco/mujoco_calls.h"
#endif
#include "adapters/ode/ode_calls.h"
#ifdef RIGOR_WITH_SICONOS
#include "adapters/siconos/siconos_calls.h"
#endif
#ifdef RIGOR_WITH_SIMBODY
#include "adapters/simbody/simbody_calls.h"
#endif

namespace rigor {
namespace {

struct CallsRow {
  std::string engine;
  std::vector<std::string> (*calls)(const Settings& settings, const std::string& dt);
};

}  // namespace

std::vector<std::string> engine_calls(const RunName& run, const std::string& dt) {
  static const std::vector<CallsRow> rows = {
      {"bullet", bullet_calls},
#ifdef RIGOR_WITH_DART
      {"dart", dart_calls},
#endif
#ifdef RIGOR_WITH_MUJOCO
      {"mujoco", mujoco_calls},
#endif
      {"ode", ode_calls},
#ifdef RIGOR_WITH_SICONOS
      {"siconos", siconos_calls},
#endif
#ifdef RIGOR_WITH_SIMBODY
      {"simbody", simbody_calls},
#endif
  };
  for (const CallsRow& row : rows) {
    if (row.engine == run.engine) return row.calls(run.settings, dt);
  }
  return {};
}

}  // namespace rigor
