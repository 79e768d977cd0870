// Reads a case file, whole: scene, run, truth and gates, every value with its line and column.
#pragma once

#include <string>

#include "cases/case/case.h"

namespace rigor {

// Throws InputError, "file:line:column: key: what was found, what is allowed (near match)", for anything the design's
// case file does not allow; also for a metric, truth, engine or step size that does not exist.
Case read_case(const std::string& path, const std::string& id);

}  // namespace rigor
