#include "core/scene/toml/row_fault.h"

namespace rigor::inline scene {

void refuse_if(const std::optional<SceneFault>& fault, const TableReader& row) {
  if (!fault) return;
  constexpr std::size_t kLongest = 400;  // names in it are other people's
  const std::string what = shown(fault->what, kLongest);
  if (fault->key.empty() || !row.find(fault->key)) row.refuse(what);
  row.at(fault->key).refuse(what);
}

}  // namespace rigor::inline scene
