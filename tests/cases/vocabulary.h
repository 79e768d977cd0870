// The words of the shipped tables, for tests that read case files.
#pragma once

#include "adapters/engines.h"
#include "cases/cli/vocabulary.h"

namespace rigor::test {

inline const Vocabulary& words() {
  static const Vocabulary all = vocabulary_of(infos_of(engines()));
  return all;
}

}  // namespace rigor::test
