// The table of faults. The tests break every engine with each of them, and a gate must find it. `rigor diagnose`
// compares an engine's error with the effect of each.
#pragma once

#include <vector>

#include "adapters/faults/fault.h"

namespace rigor::inline adapters {

const std::vector<Fault>& faults();  // grouped by subject

// Wrong reports of the contact forces of a correct step. They are not in the table, for they change no motion.
const std::vector<Fault>& contact_report_faults();

// The table's parts.
std::vector<Fault> body_faults();
std::vector<Fault> contact_faults();
std::vector<Fault> joint_faults();
std::vector<Fault> load_faults();
std::vector<Fault> reading_faults();
std::vector<Fault> step_faults();

}  // namespace rigor::inline adapters
