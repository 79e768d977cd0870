#include "cases/cli/vocabulary.h"

#include "cases/metrics/held_to_itself.h"
#include "cases/metrics/metric.h"
#include "cases/truth/provenance.h"
#include "cases/truth/truth.h"

namespace rigor {
namespace {

template <typename Rows>
std::vector<std::string> names_of(const Rows& rows) {
  std::vector<std::string> names;
  for (const auto& row : rows) names.push_back(row.name);
  return names;
}

}  // namespace

Vocabulary vocabulary_of(std::vector<EngineInfo> engines) {
  return {names_of(metrics()), names_of(cross_metrics()), names_of(truths()), std::move(engines), is_held_to_itself};
}

}  // namespace rigor
