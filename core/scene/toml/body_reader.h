// [[scene.body]]: a body, its shape and its inertia.
#pragma once

#include "core/scene/scene.h"

namespace rigor::inline scene {

class TableReader;

// The keys that body_reader.cpp reads, in the order in which messages list them.
const std::vector<std::string>& body_keys();

// Throws InputError for a value that no body can have. The scene checks that its name is unique.
Body read_body(const TableReader& row);

}  // namespace rigor::inline scene
