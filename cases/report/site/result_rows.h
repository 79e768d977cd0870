// Rows of a results.json.
#pragma once

#include <string>

#include "cases/results/cell_key.h"
#include "core/base/json.h"

namespace rigor::inline report {

inline std::string word_at(const Json& row, const char* key) { return row.at(key).get<std::string>(); }

inline CellKey cell_key_of(const Json& row) {
  return {word_at(row, "case"), word_at(row, "engine"), word_at(row, "dt")};
}

}  // namespace rigor::inline report
