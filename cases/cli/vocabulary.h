// The vocabulary of this program: every row of every table.
#pragma once

#include "cases/case/vocabulary.h"

namespace rigor::inline cli {

Vocabulary vocabulary_of(std::vector<EngineInfo> engines);

}  // namespace rigor::inline cli
