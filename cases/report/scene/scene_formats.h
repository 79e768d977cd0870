// A case's scene in the formats of other programs.
#pragma once

#include <string>
#include <vector>

#include "core/scene/link_model.h"

namespace rigor::inline report {

struct SceneFormat {
  std::string name;
  // receives notes about parts that the format cannot express
  std::string (*text)(const Scene& scene, LeftOut& left_out);
};

const std::vector<SceneFormat>& scene_formats();
const SceneFormat& find_scene_format(const std::string& name);  // throws InputError

std::string sdf_scene(const Scene& scene, LeftOut& left_out);

}  // namespace rigor::inline report
