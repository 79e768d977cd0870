// A robot's file as a case file, for the laboratory: what `rigor import` makes of it, and what it says beside.
#pragma once

#include <string>
#include <vector>

namespace rigor::inline laboratory {

struct RobotCase {
  std::string text;                // of the case file
  std::vector<std::string> notes;  // the lines of what the import lost and assumed
  std::string falls;               // the name of a body that falls without end; empty if there is none
};

// URDF, SDF or MJCF (import.h). Losses of physics do not throw: the notes name them. A broken file throws InputError,
// "path:line: what".
RobotCase robot_case(const std::string& path, bool with_ground);

}  // namespace rigor::inline laboratory
