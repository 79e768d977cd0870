// A scene for results.json: the data for a picture, in the words of the case file.
#pragma once

#include "core/base/json_fwd.h"
#include "core/scene/scene.h"

namespace rigor::inline report {

Json json_of(const Scene& scene);

}  // namespace rigor::inline report
