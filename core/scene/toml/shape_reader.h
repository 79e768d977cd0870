// The keys `shape` and `shapes` of [[scene.body]].
#pragma once

#include <optional>

#include "core/scene/scene.h"

namespace rigor {

class TableReader;

// The body's shape, if the row has one of the two keys. Throws InputError for a shape that no body can have, and for a
// row with both keys.
std::optional<Shape> read_shapes(const TableReader& row);

}  // namespace rigor
