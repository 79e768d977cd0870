// Sets the kind of a gate's limit, for tests that change one number of it.
#pragma once

#include "cases/case/case.h"

namespace rigor::test {

// The gate's limit as a Kind; a new one if it was of another kind.
template <typename Kind>
Kind& limit_as(Gate& gate) {
  if (!std::holds_alternative<Kind>(gate.limit)) gate.limit = Kind();
  return std::get<Kind>(gate.limit);
}

}  // namespace rigor::test
