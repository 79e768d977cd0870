// Reports faults of a scene (validate.h) at the place of their rows.
#pragma once

#include <optional>

#include "core/scene/toml/table_reader.h"
#include "core/scene/validate.h"

namespace rigor::inline scene {

// Throws InputError at the key that is at fault, or else at the row as a whole.
void refuse_if(const std::optional<SceneFault>& fault, const TableReader& row);

}  // namespace rigor::inline scene
