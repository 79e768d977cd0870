// The scenes on which an engine's motion is held against that of known mistakes.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cases/case/suite.h"

namespace rigor {

struct ProbeScene {
  std::string id;  // of its case
  std::shared_ptr<const Scene> scene;
  double dt = 0;              // s
  double duration = 0;        // s
  bool is_of_points = false;  // its bodies move as points do, or spin steadily: how a scheme turns them is not in it
};

// Those cases of Rigor's own suite that tell the table's mistakes apart.
std::vector<ProbeScene> probes_of_suite(const Vocabulary& vocabulary);

// The cases, each as far as it is short enough to be run a hundred times.
std::vector<ProbeScene> probes_of(const std::vector<Case>& cases);

}  // namespace rigor
