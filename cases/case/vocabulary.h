// The words that a case file may use. The tables they name stand in later rooms: the end of the chain fills this in and
// hands it to the reader.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/engine/run_name.h"
#include "core/scene/scene.h"

namespace rigor::inline cases {

struct Vocabulary {
  std::vector<std::string> metrics;        // of one run
  std::vector<std::string> cross_metrics;  // across the cells of a case
  std::vector<std::string> truths;         // "none" aside
  std::vector<EngineInfo> engines;
  // Whether a run, judged by this metric against this truth, is compared with its own code's result (provenance.h).
  std::function<bool(const std::string& truth, const std::string& metric, const RunName& run, const Scene& scene)>
      is_held_to_itself;
};

}  // namespace rigor::inline cases
