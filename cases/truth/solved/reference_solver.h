// The numbers behind the truth 'reference': the motion of a smooth scene, solved twice, and how far the two are apart.
#pragma once

#include <memory>
#include <vector>

#include "cases/truth/solved/equations_of_motion.h"
#include "core/dynamics/contact/contact_method.h"

namespace rigor::inline truth {

inline constexpr Formulation kReferenceForm = Formulation::body_rates;

// The modes of limits and motors of a given speed, and the time from which they hold (axis_modes.h).
struct Phases {
  std::vector<long double> times;  // s
  std::vector<double> modes;       // the same number of numbers for each phase
};

struct ReferenceSolution {
  // Its accepted steps, rounded to double: `dimension` numbers each, as EquationsOfMotion lays out kReferenceForm.
  std::size_t dimension = 0;
  std::vector<long double> times;  // s
  std::vector<double> states;
  Phases phases = {};

  std::vector<double> error_times;    // s
  std::vector<double> errors;         // as Truth::error, up to each of these times
  bool complete = false;              // both solutions reach the end; if not, the motion is not smooth there
  std::vector<ContactTie> ties = {};  // of a solution by events, in the order of their times
};

// The scene may have springs, dampers, timed forces, and joints with springs, dampers, motors and limits along their
// free axes. It may not have contacts.
ReferenceSolution solve_reference(const Scene& scene, double duration);

// The equations of the solution's states, to continue from a node (solving.h).
namespace solving {
class DoubleMotion;
}
std::unique_ptr<solving::DoubleMotion> reference_motion(const Scene& scene, const ReferenceSolution& solution);

// The same for a scene with joints (jointed_reference.cpp).
ReferenceSolution solve_jointed_reference(const Scene& scene, double duration);
std::unique_ptr<solving::DoubleMotion> jointed_motion_in_double(const Scene& scene, const ReferenceSolution& solution);

}  // namespace rigor::inline truth
