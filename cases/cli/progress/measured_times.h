// What cells took in an earlier run to the same folder.
#pragma once

#include <array>
#include <map>
#include <string>

namespace rigor::inline cli {

using MeasuredTimes = std::map<std::array<std::string, 3>, double>;  // case, engine and dt; s of wall time

// From the results.json in `folder`. Empty if there is none, if it cannot be read, or if another machine wrote it.
MeasuredTimes measured_times(const std::string& folder);

}  // namespace rigor::inline cli
