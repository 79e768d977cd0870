// Shapes as JSON, by the keys of case files.
#pragma once

#include "core/base/json.h"
#include "core/scene/shape_types.h"

namespace rigor {

// {"type": …, …}. The parts of a compound are a list of such objects with poses.
Json json_of_shape(const Shape& shape);

}  // namespace rigor
