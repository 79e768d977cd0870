#include "cases/cli/vocabulary.h"

#include "cases/metrics/held_to_itself.h"
#include "cases/metrics/metric.h"
#include "cases/truth/provenance.h"
#include "cases/truth/truth.h"
#include "core/base/names_of.h"

namespace rigor::inline cli {

Vocabulary vocabulary_of(std::vector<EngineInfo> engines) {
  return {names_of(metrics()), names_of(cross_metrics()), names_of(truths()), std::move(engines), is_held_to_itself};
}

}  // namespace rigor::inline cli
