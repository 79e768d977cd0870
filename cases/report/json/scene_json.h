// A scene for results.json: what a picture of it needs, with the case file's own words.
#pragma once

#include "core/base/json_fwd.h"
#include "core/scene/scene.h"

namespace rigor {

Json json_of(const Scene& scene);

}  // namespace rigor
