#include "adapters/models.h"

#include <fmt/format.h>

#include "core/base/error.h"
#ifdef RIGOR_WITH_MUJOCO
#include "adapters/mujoco/mujoco_export.h"
#include "adapters/mujoco/mujoco_import.h"
#endif

namespace rigor {

#ifdef RIGOR_WITH_MUJOCO

LinkModel mujoco_link_model(const std::string& path, const std::string& keyframe) {
  return read_with_mujoco(path, keyframe);
}

std::string mjcf_of(const Scene& scene, LeftOut& left_out) { return mjcf_for_others(scene, left_out); }

#else

namespace {
constexpr const char* kWithout = "MuJoCo, without which this program was built; install libmujoco-dev and build again";
}

LinkModel mujoco_link_model(const std::string& path, const std::string&) {
  throw InputError(fmt::format("{}:1: MJCF is read by {}", path, kWithout));
}

std::string mjcf_of(const Scene&, LeftOut&) { throw InputError(fmt::format("MJCF is written by {}", kWithout)); }

#endif

}  // namespace rigor
