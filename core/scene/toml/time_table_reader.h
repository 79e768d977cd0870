// Efforts and targets in time: a number, rows [[t, value], ...], or a column of a CSV file beside the case file.
#pragma once

#include <optional>

#include "core/scene/drives.h"
#include "core/scene/toml/table_reader.h"

namespace rigor::inline scene {

// From `key`, or from the keys file and column; with the key interpolate for either kind of table. Empty if the row has
// none of them. Throws InputError for times that do not rise, and for what is no table.
std::optional<TimeTable> read_effort_or_target(const TableReader& row, const std::string& key);

// Throws InputError if the row has file, column or interpolate.
void refuse_table_keys(const TableReader& row, const std::string& why);

}  // namespace rigor::inline scene
