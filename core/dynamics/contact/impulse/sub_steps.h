// How contact by impulses divides a step, and how soft its constraints are on sub-steps of that length.
#pragma once

#include "core/dynamics/contact/contact_method.h"
#include "core/dynamics/kernels/contact_rows.h"

namespace rigor::inline dynamics {

inline const OptionInfo kSubStepsOption{
    .name = "substeps",
    .meaning = "sub-steps of contact=impulse in a step",
    .min = 1,
    .max = 10000,
    .whole = true,
    .by_default = DefaultRule{"at least 4, more if bodies fall far for their size in a step"}};
inline const OptionInfo kImpactsOption{
    .name = "impacts",
    .meaning =
        "law of simultaneous impacts of contact=impulse: one after another, or all that touch together (Moreau's law)",
    .choices = {"sequential", "simultaneous"},
    .by_default = "sequential"};

// What is a whole number but for rounding is not made one more.
int rounded_up(double count);

// The length and the time by which a scene is measured, so that no threshold depends on units.
struct SceneScales {
  double length;  // m: half the edge of a cube of a body's volume, the mean over the moving bodies that collide
  double time;    // s: in which a body at rest starts to cross its own length; infinite if nothing moves it
  double speed() const { return length / time; }  // m/s
};

SceneScales scales_of(const Scene& scene);

class SubSteps {
 public:
  SubSteps(const Scene& scene, const ContactParts& parts);

  // See the option `impacts`.
  static bool takes_impacts_at_once(const Settings& settings);
  int of(double dt) const;
  // The number of them [at most `count`] in which contacts are found again; between these they keep their normals.
  int contact_updates(double dt, int count) const;
  // For sub-steps of h [s].
  SolverParameters parameters(double h) const;
  // The same, for sweeps that start with no impulses and go on until bodies at rest stay at rest. Points that touch are
  // rigid: a soft one would first give way.
  static SolverParameters until_at_rest(SolverParameters parameters, std::size_t constraints);
  // So many constraints at most: with more, these sweeps would take longer than the steps that follow.
  static constexpr std::size_t kMostAtRest = 1000;
  SettingsInForce settings_in_force() const;

 private:
  int given_;  // 0: as dt asks
  SceneScales scales_;
  double longest_sub_step_;  // in units of the scene's time
  double gravity_, theta_;   // m/s²; see SolverParameters
};

}  // namespace rigor::inline dynamics
