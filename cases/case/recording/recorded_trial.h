// What readers of recordings share.
#pragma once

#include <string>
#include <vector>

#include "cases/case/recording/recording.h"

namespace rigor::inline cases {

// The length of a quaternion may differ from one by so much. Written with four digits it does by 2e-4.
inline constexpr double kUnitLength = 1e-3;

// The samples of a body of the scene, which are added where there are none yet.
RecordedBody& samples_of(RecordedTrial& trial, int body);

// Moves the trial's start to t = 0, and sets its duration. Throws InputError, beginning with the path, for a body with
// one sample, and for bodies that begin at different times. `names`: those of the scene's bodies.
void begin_at_zero(RecordedTrial& trial, const std::vector<std::string>& names, const std::string& path);

}  // namespace rigor::inline cases
