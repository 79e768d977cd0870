// Reads the keys of [truth] with kind = "recording", and the file that they name.
#pragma once

#include <memory>
#include <string>

#include "cases/case/case.h"
#include "cases/case/recording/recording.h"
#include "core/scene/toml/table_reader.h"

namespace rigor::inline cases {

// All keys of [truth].
const Keys& truth_keys();

// The case has its scene, its duration and its source. Gives the scene the start of the first trial. A file that is not
// on this machine changes nothing. Throws InputError.
void read_recording(const TableReader& truth, Case& out);

// A sentence on a recording that is not on this machine, so that nothing of the case can run; else empty.
std::string missing_recording(const Case& definition);

// Throws InputError, begun by `what`, if the recording is shorter than the run. Where there are trials, the longest
// counts, and a shorter one ends with its last sample.
void check_covers(const MotionRecording& recording, double duration, const std::string& what);

}  // namespace rigor::inline cases
