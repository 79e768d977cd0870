// The column `name` of a table.
#pragma once

#include <string>
#include <vector>

namespace rigor {

template <typename Rows>
std::vector<std::string> names_of(const Rows& rows) {
  std::vector<std::string> names;
  for (const auto& row : rows) names.push_back(row.name);
  return names;
}

}  // namespace rigor
