// The scenes on which an engine's motion is compared with the motion of known mistakes.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cases/case/suite.h"

namespace rigor::inline analysis {

struct ProbeScene {
  std::string id;  // of its case
  std::shared_ptr<const Scene> scene;
  double dt = 0;              // s
  double duration = 0;        // s
  bool is_of_points = false;  // its bodies move like points or spin steadily, so the scheme's rotations do not matter
};

// The cases of Rigor's own suite that tell the table's mistakes apart.
std::vector<ProbeScene> probes_of_suite(const Vocabulary& vocabulary);

// The given cases, each cut to a length that can be run a hundred times.
std::vector<ProbeScene> probes_of(const std::vector<Case>& cases);

}  // namespace rigor::inline analysis
