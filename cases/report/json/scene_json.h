// A scene for results.json: what a picture of it needs, with the case file's own words.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "core/scene/scene.h"

namespace rigor {

nlohmann::ordered_json json_of(const Scene& scene);

}  // namespace rigor
