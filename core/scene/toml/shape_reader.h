// The keys `shape` and `shapes` of [[scene.body]].
#pragma once

#include <optional>

#include "core/scene/scene.h"

namespace rigor::inline scene {

class TableReader;
class TomlValue;

// The body's shape, if the row has one of the two keys. Throws InputError for a shape that no body can have, and for a
// row with both keys.
std::optional<Shape> read_shapes(const TableReader& row);

// A quaternion [w, x, y, z] of any length but 0, made a unit one.
Quat read_orientation(const TomlValue& value);

}  // namespace rigor::inline scene
