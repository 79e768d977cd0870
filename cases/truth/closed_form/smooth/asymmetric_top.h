// The motion of a free body with three different principal moments, for what flies as one (asymmetric_top.cpp).
#pragma once

#include "cases/truth/closed_form/closed_form.h"

namespace rigor::inline truth {

// Throws InputError for a body that does not turn, or has two equal moments.
std::unique_ptr<BodyMotion> asymmetric_top(const Body& body, const Vec3& gravity);

}  // namespace rigor::inline truth
