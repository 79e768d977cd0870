// What the whole of the results comes to, in a few sentences: who blows up and who holds stiff springs, what a
// millimetre costs, who loses energy and why, whose friction knows directions, what is left that no scheme explains.
#pragma once

#include <string>
#include <vector>

#include "cases/results/results.h"

namespace rigor {

struct Finding {
  std::string topic;  // "stability", "energy", ...: findings of one topic stand together
  std::string text;   // a sentence or two, to be read at a glance
  std::string more;   // what stands behind it: all names, cases, reasons; may be empty
};
std::vector<Finding> findings(const Results& results);

// The step size that the first page shows: 1/30 s if any case has it, else the coarsest of all.
StepSize headline_dt(const Results& results);

}  // namespace rigor
