// The numbers behind the truth 'reference': the motion of a smooth scene, solved twice, and how far the two are apart.
#pragma once

#include <memory>
#include <vector>

#include "cases/truth/solved/equations_of_motion.h"

namespace rigor {

inline constexpr Formulation kReferenceForm = Formulation::body_rates;

struct ReferenceSolution {
  // Its accepted steps, rounded to double: `dimension` numbers each, as EquationsOfMotion lays out kReferenceForm.
  std::size_t dimension = 0;
  std::vector<long double> times;  // s
  std::vector<double> states;

  std::vector<double> error_times;  // s
  std::vector<double> errors;       // as Truth::error, up to each of these times
  bool complete = false;            // both solutions reach the end; if not, the motion is not smooth there
};

// The scene may have springs, dampers, timed forces, joints with springs, dampers and motors of a given effort along
// their free axes, but neither contacts nor limits.
ReferenceSolution solve_reference(const Scene& scene, double duration);

// The equations that the solution's states are of, to go on from a node (solving.h).
namespace solving {
class DoubleMotion;
}
std::unique_ptr<solving::DoubleMotion> reference_motion(const Scene& scene);

// The same for a scene with joints (jointed_reference.cpp).
ReferenceSolution solve_jointed_reference(const Scene& scene, double duration);
std::unique_ptr<solving::DoubleMotion> jointed_motion_in_double(const Scene& scene);

}  // namespace rigor
