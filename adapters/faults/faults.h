// The table of faults. The tests break every engine by each of them, and a gate must find it; `rigor diagnose` holds an
// engine's error against what each of them would make.
#pragma once

#include <vector>

#include "adapters/faults/fault.h"

namespace rigor {

const std::vector<Fault>& faults();  // by what they are about

// The table's parts.
std::vector<Fault> body_faults();
std::vector<Fault> contact_faults();
std::vector<Fault> joint_faults();
std::vector<Fault> load_faults();
std::vector<Fault> reading_faults();
std::vector<Fault> step_faults();

}  // namespace rigor
