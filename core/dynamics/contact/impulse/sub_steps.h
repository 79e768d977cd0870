// How contact by impulses divides a step, and how soft its constraints are on sub-steps of that length.
#pragma once

#include "core/dynamics/contact/contact_method.h"
#include "core/dynamics/kernels/contact_rows.h"

namespace rigor {

// Contacts keep their normals for so long.
inline constexpr double kContactUpdateInterval = 1.0 / 120;  // s

// What is a whole number but for rounding is not made one more.
int rounded_up(double count);

class SubSteps {
 public:
  SubSteps(const Scene& scene, const ContactParts& parts);

  // See the option `impacts`.
  static bool takes_impacts_at_once(const Settings& settings);
  int of(double dt) const;
  // For sub-steps of h [s].
  SolverParameters parameters(double h) const;
  SettingsInForce settings_in_force() const;

 private:
  int given_;                // 0: as dt asks
  double longest_sub_step_;  // s
  double gravity_, theta_;   // m/s²; see SolverParameters
};

}  // namespace rigor
