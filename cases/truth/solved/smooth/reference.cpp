// The motion of any scene without contacts, solved twice in high precision (reference_solver.h). The first solution is
// the truth; its distance from the second is its error. A solution is computed once and kept (solution_cache.h).
#include <fmt/format.h>

#include <utility>

#include "cases/truth/provenance.h"
#include "cases/truth/solved/smooth/solved_truth.h"
#include "cases/truth/solved/solution_cache.h"
#include "cases/truth/truth.h"
#include "core/base/error.h"
#include "core/scene/features/features.h"

namespace rigor::inline truth {
namespace {

ReferenceSolution reference_solution(const Scene& scene, double duration) {
  return kept_or_solved(reference_content(scene, duration), [&] { return solve_reference(scene, duration); });
}

std::unique_ptr<Truth> make_reference(const Scene& scene, double duration) {
  static const Features solved = {Feature::fixed_body,
                                  Feature::spring,
                                  Feature::timed_force,
                                  Feature::joints_with_dampers,
                                  Feature::joint_spring,
                                  Feature::quadratic_spring,
                                  Feature::joint_damper,
                                  Feature::joint_limit,
                                  Feature::joint_limit_beyond_half_turn,
                                  Feature::motor_effort,
                                  Feature::motor_speed,
                                  Feature::joint_friction,
                                  Feature::motor_servo,
                                  Feature::motor_table,
                                  Feature::armature,
                                  Feature::coupling,
                                  Feature::coupling_of_several_joints,
                                  Feature::motor_servo_of_several_joints};
  for (const Need& need : needs_of(scene)) {
    if (need.feature == joint_feature<CompoundJoint>())
      throw InputError(
          fmt::format("the truth 'reference' has no compound joint, and this scene has {}; allowed: a "
                      "truth in closed form, 'events' or 'none'",
                      need.because));
    if (solved.contains(need.feature) || is_joint(need.feature)) continue;
    throw InputError(fmt::format("the truth 'reference' is for scenes without contacts; this one has {}: {}",
                                 word_of(need.feature), need.because));
  }
  ReferenceSolution solution = reference_solution(scene, duration);
  auto motion = reference_motion(scene, solution);
  return std::make_unique<SolvedTruth>(std::move(motion), std::move(solution));
}

}  // namespace

Provenance reference_provenance() {
  return {"reference", "solved twice from equations of motion of its own, independent of every engine and method"};
}

TruthRow reference_truth() {
  return {"reference", "any scene without contacts, solved twice in high precision: the difference is its error",
          make_reference};
}

}  // namespace rigor::inline truth
