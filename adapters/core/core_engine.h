// The in-house core behind the same seam as every other engine.
#pragma once

#include <memory>

#include "core/engine/engine.h"

namespace rigor {

std::unique_ptr<Engine> make_core_engine();

}  // namespace rigor
