#include "cases/report/scene/scene_formats.h"

#include <fmt/format.h>

#include "adapters/models.h"
#include "core/base/error.h"
#include "core/base/near_match.h"

namespace rigor::inline report {

const std::vector<SceneFormat>& scene_formats() {
  static const std::vector<SceneFormat> formats = {{"mjcf", mjcf_of}, {"sdf", sdf_scene}};
  return formats;
}

const SceneFormat& find_scene_format(const std::string& name) {
  std::vector<std::string> names;
  for (const SceneFormat& format : scene_formats()) {
    if (format.name == name) return format;
    names.push_back(format.name);
  }
  throw InputError(
      fmt::format("--format: there is no '{}'{}; there is: {}", name, did_you_mean(name, names), listed(names)));
}

}  // namespace rigor::inline report
