// The words that a case file may use. The tables they name stand in later rooms: the end of the chain fills this in and
// hands it to the reader.
#pragma once

#include <string>
#include <vector>

#include "core/engine/engine.h"

namespace rigor {

struct Vocabulary {
  std::vector<std::string> metrics;        // of one run
  std::vector<std::string> cross_metrics;  // across the cells of a case
  std::vector<std::string> truths;         // "none" aside
  std::vector<EngineInfo> engines;
};

}  // namespace rigor
