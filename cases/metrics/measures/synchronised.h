// Brings velocities to the time of the positions. A semi-implicit step stores the mean velocity of the step before, so
// that velocity belongs half a step earlier than the position. Read as it is, the energy oscillates by the difference
// between the two instants. That is sampling, not loss (Hairer, Lubich, Wanner, Geometric Numerical Integration, 2nd
// ed., section I.3.1: Störmer-Verlet).
//
// The rule, for velocities v_n at samples h apart and for the mean velocity d_n = (x_n - x_{n-1})/h between two of
// them:
//   a velocity that lags by the share s of h fulfils v_n - d_n = (1/2 - s) (v_n - v_{n-1}), up to O(h²)
//   v* = v_n + s (v_{n+1} - v_n)
// The acceleration is that of the run itself, so contacts, joints, friction and dampers take part in it. The free
// acceleration would leave them out. The method declares s. The positions overrule it where they show less than half of
// that: in a contact that is held by forces at each stage, or in a step that is divided into many.
//
// An impact is no acceleration. Where velocities can jump, the smaller of the changes before and after the sample
// counts if the two differ by more than a factor of 2. Two opposed changes of about one size are two impacts: none
// counts.
//
// A joint turns the velocity of a body. Engines in joint coordinates step the speed and turn it exactly. So the speed
// of a jointed body is brought forward, and its direction stays. Its s is fitted over the whole run, for the curved
// path adds O(h²) to d_n.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/engine/trajectory.h"
#include "core/scene/scene.h"

namespace rigor {

class Synchroniser {
 public:
  // `stagger`: the declared lag in steps, see MethodInfo::leapfrog_stagger. The trajectory must outlive this object.
  Synchroniser(const Scene& scene, const Trajectory& run, double stagger);

  // Replaces the velocities of the n-th sample's bodies.
  void apply(std::size_t n, MutableBodyColumns bodies) const;

 private:
  enum class Rate { linear, angular };
  static constexpr std::array<Rate, 2> kRates = {Rate::linear, Rate::angular};

  Vec3 rate(Rate kind, std::size_t i, std::size_t n) const;
  Vec3 mean_rate(Rate kind, std::size_t i, std::size_t n) const;  // between the samples n - 1 and n
  Vec3 change(Rate kind, std::size_t i, std::size_t n) const { return rate(kind, i, n) - rate(kind, i, n - 1); }
  double speed_change(Rate kind, std::size_t i, std::size_t n) const;
  double lag(Rate kind, std::size_t i, std::size_t n) const;
  double fitted_lag(Rate kind, std::size_t i) const;
  double lag_for(double share) const;
  Vec3 brought_forward(Rate kind, std::size_t i, std::size_t n) const;

  std::optional<std::size_t> interval_after(Rate kind, std::size_t i, std::size_t n) const;

  const Scene& scene_;
  const Trajectory& run_;
  double spacing_ = 1;     // s, between samples
  double declared_ = 0;    // of the spacing
  bool can_jump_ = false;  // whether velocities can
  std::vector<bool> jointed_;
  std::vector<std::array<double, 2>> lags_;  // of jointed bodies, by Rate
};

}  // namespace rigor
