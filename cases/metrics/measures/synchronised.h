// Brings velocities to the time of the positions. A semi-implicit step stores the mean velocity of the step before, so
// that velocity belongs half a step earlier than the position. Read as it is, the energy oscillates by the difference
// between the two instants. That is sampling, not loss (Hairer, Lubich, Wanner, Geometric Numerical Integration, 2nd
// ed., section I.3.1: Störmer-Verlet).
//
// The rule, for velocities v_n at samples h apart and for the mean velocity d_n = (x_n - x_{n-1})/h between two of
// them:
//   a velocity that lags by the share s of h fulfils v_n - d_n = (1/2 - s) (v_n - v_{n-1}), up to O(h²)
//   v* = v_n + s (v_{n+1} - v_n)
// Explicit Euler moves by the velocity before the step, so its velocities lead: s = -1/2, v* = v_n + s (v_n - v_{n-1}).
// The acceleration is that of the run itself, so contacts, joints, friction and dampers take part in it. The free
// acceleration would leave them out. The method declares s. The positions overrule it where they show less than half of
// that: in a contact that is held by forces at each stage, or in a step that is divided into many.
//
// An impact is no acceleration. Where velocities can jump, the change that gravity alone makes marks a flight, and a
// flight on either side of the sample gives the acceleration. Without one, the two changes may disagree: one is more
// than twice the other, or they are opposed. Then the velocity at the positions' time is not determined. Every reading
// between the velocity as stored and the velocity brought forward by gravity or by a neighbouring change is possible.
// So the energy has bounds there, and a metric may charge only what lies outside of them.
//
// A joint turns the velocity of a body. Engines in joint coordinates step the speed and turn it exactly. So the speed
// of a jointed body is brought forward, and its direction stays. Its s is fitted over the whole run, for the curved
// path adds O(h²) to d_n.
#pragma once

#include <array>
#include <vector>

#include "core/engine/trajectory.h"
#include "core/scene/scene.h"

namespace rigor::inline metric {

class Synchroniser {
 public:
  // `stagger`: the declared lag in steps, see MethodInfo::leapfrog_stagger. The trajectory must outlive this object.
  Synchroniser(const Scene& scene, const Trajectory& run, double stagger);

  // Replaces the velocities of the n-th sample's bodies by their likeliest reading.
  void apply(std::size_t n, MutableBodyColumns bodies) const;
  // Replaces them by the readings of least and of most kinetic energy. They agree where the velocity is determined.
  void apply_bounds(std::size_t n, MutableBodyColumns least, MutableBodyColumns most) const;

 private:
  enum class Rate { linear, angular };
  static constexpr std::array<Rate, 2> kRates = {Rate::linear, Rate::angular};

  struct Readings {
    std::array<Vec3, 5> list;  // the likeliest first
    std::size_t count = 0;
    void add(const Vec3& reading) { list[count++] = reading; }
  };

  Vec3 rate(Rate kind, std::size_t i, std::size_t n) const;
  Vec3 mean_rate(Rate kind, std::size_t i, std::size_t n) const;  // between the samples n - 1 and n
  Vec3 change(Rate kind, std::size_t i, std::size_t n) const { return rate(kind, i, n) - rate(kind, i, n - 1); }
  double speed_change(Rate kind, std::size_t i, std::size_t n) const;
  double lag(Rate kind, std::size_t i, std::size_t n) const;
  double fitted_lag(Rate kind, std::size_t i) const;
  double lag_for(double share) const;
  double kinetic(Rate kind, std::size_t i, const Mat3& rotation, const Vec3& rate) const;  // J

  struct Intervals {
    std::size_t nearest, other;
  };
  Intervals intervals_at(std::size_t n) const;
  bool is_flight(Rate kind, std::size_t i, std::size_t n) const;
  Vec3 brought_forward(Rate kind, std::size_t i, std::size_t n, double lag, std::size_t interval) const;
  Readings readings(Rate kind, std::size_t i, std::size_t n) const;
  Readings readings_beside_impacts(Rate kind, std::size_t i, std::size_t n, double lag) const;

  const Scene& scene_;
  const Trajectory& run_;
  double spacing_ = 1;     // s, between samples
  double declared_ = 0;    // of the spacing
  bool can_jump_ = false;  // whether velocities can
  std::vector<bool> jointed_;
  std::vector<std::array<double, 2>> lags_;  // of jointed bodies, by Rate
};

}  // namespace rigor::inline metric
