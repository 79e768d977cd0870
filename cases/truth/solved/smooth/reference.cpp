// The motion of any scene without contacts, solved twice in high precision (reference_solver.h). The first solution is
// the truth; its distance from the second is its error. A solution is computed once and kept (solution_cache.h).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "cases/truth/provenance.h"
#include "cases/truth/solved/equations_of_motion.h"
#include "cases/truth/solved/jointed/joint_axis.h"
#include "cases/truth/solved/smooth/solved_truth.h"
#include "cases/truth/solved/solution_cache.h"
#include "cases/truth/truth.h"
#include "core/base/error.h"
#include "core/scene/features/features.h"
#include "core/scene/turn_window.h"

namespace rigor::inline truth {
namespace {

ReferenceSolution reference_solution(const Scene& scene, double duration) {
  return kept_or_solved(reference_content(scene, duration), [&] { return solve_reference(scene, duration); });
}

// Whether a joint's spring takes an angle from -pi to pi, and so jumps at half a turn (turn_window.h).
bool may_jump(const Joint& joint) {
  const bool is_sprung = joint.stiffness != 0 || joint.quadratic_stiffness != 0;
  return is_sprung && turns(joint) && !middle_of_turn(joint);
}

// Ends a solution, which counts whole turns, before the first spring jumps. Returns what there is to say of it.
std::string cut_at_jump(const Scene& scene, ReferenceSolution& solution) {
  const std::vector<JointAxis<double>> axes = axes_in_use<double>(scene);
  const auto moving = std::count_if(scene.bodies.begin(), scene.bodies.end(), [](const Body& b) { return !b.fixed; });
  const std::size_t first = EquationsOfMotion<double>::kNumbersPerBody * static_cast<std::size_t>(moving);
  for (std::size_t node = 0; node < solution.times.size(); ++node) {
    for (std::size_t k = 0; k < axes.size(); ++k) {
      const double angle = solution.states[node * solution.dimension + first + k];
      if (!may_jump(scene.joints[axes[k].joint]) || std::abs(angle) < std::numbers::pi) continue;
      const double last = static_cast<double>(solution.times[node > 0 ? node - 1 : 0]);
      const auto end = std::upper_bound(solution.error_times.begin(), solution.error_times.end(), last);
      solution.errors.resize(static_cast<std::size_t>(end - solution.error_times.begin()));
      solution.error_times.erase(end, solution.error_times.end());
      solution.complete = false;
      return fmt::format(
          "At {:.3g} s {} has turned by half a turn, where the angle of its spring jumps. "
          "There engines that count whole turns part from those that do not. "
          "With limits less than a turn apart all count them.",
          static_cast<double>(solution.times[node]), scene.joint_name(axes[k].joint));
    }
  }
  return "";
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
    if (solved.contains(need.feature) || is_joint(need.feature)) continue;
    throw InputError(fmt::format("the truth 'reference' is for scenes without contacts; this one has {}: {}",
                                 word_of(need.feature), need.because));
  }
  ReferenceSolution solution = reference_solution(scene, duration);
  auto motion = reference_motion(scene, solution);
  std::string caveat = cut_at_jump(scene, solution);
  return std::make_unique<SolvedTruth>(std::move(motion), std::move(solution), std::move(caveat));
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
