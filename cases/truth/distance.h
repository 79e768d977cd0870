// How far two states of the same bodies are apart.
#pragma once

#include "core/engine/body_table.h"

namespace rigor::inline truth {

// The largest distance [m] and angle [rad] between a body and the same one; infinite where either is not finite.
double distance_between(BodyColumns a, BodyColumns b);

}  // namespace rigor::inline truth
