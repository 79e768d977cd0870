// Rolling and torsional friction, for the method `impulse`. At each point with such a law a couple acts on the relative
// angular velocity w of the two bodies, as an impulse of at most a length times the normal impulse p_n:
//   rolling:   t <- onto the disc of radius rolling_friction p_n  (t - K_t^-1 w_t),   across the normal,
//   torsional: s <- onto [-1, 1] torsional_friction p_n           (s - w_n / k_n),    about the normal,
// with K = I_a^-1 + I_b^-1 (Johnson, Contact Mechanics, 1985, section 8.5, for the couple and its limit). The impulses
// of the sub-step before are part of the velocities when a sub-step begins, as those of all rows.
#pragma once

#include <vector>

#include "core/dynamics/contact/impulse/contact_row_layout.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline dynamics {

class TurningFriction {
 public:
  explicit TurningFriction(const Scene& scene);

  bool are_any() const { return !rows_.empty(); }

  // Takes the constraints, which `layout` has assigned, whose pairs have such a law. Impulses of points that persist
  // are multiplied by `impulse_scale`.
  void assign(const std::vector<ContactConstraint>& constraints, const ContactRowLayout& layout, double impulse_scale,
              const SolverBodies& bodies);
  // All impulses as they are.
  void warm_start(const SolverBodies& bodies) const;
  // One sweep, with the normal impulses that the rows have now.
  void solve(const SolverBodies& bodies);

  // A restored row hands its impulse on, and is then replaced.
  template <typename Archive>
  void archive_state(Archive& archive) {
    archive(rows_);
  }

 private:
  struct Row {
    int a, b;  // bodies
    std::uint32_t feature;
    double rolling, torsional;     // m
    Vec3 normal;                   // from b to a
    const double* normal_impulse;  // N s, of the contact's row
    Mat3 inertia_a, inertia_b;     // 1/(kg m²), inverse, in W
    Vec3 impulse = Vec3::Zero();   // N m s on a, in W
    template <typename Archive>
    void archive_state(Archive& archive) {
      archive(a, b, feature, impulse);
    }
  };
  static void turn(const Row& row, const Vec3& impulse, const SolverBodies& bodies);

  ContactLaws laws_;
  bool has_law_ = false;
  std::vector<Row> rows_;
};

}  // namespace rigor::inline dynamics
