// [[scene.body]]: a body, its shape and its inertia.
#pragma once

#include "core/scene/scene.h"

namespace rigor {

class TableReader;

// The keys that body_reader.cpp reads, in the order in which messages list them.
const std::vector<std::string>& body_keys();

// Throws InputError for a value that no body can have. That its name is unique is the scene's to check.
Body read_body(const TableReader& row);

}  // namespace rigor
