// Decides from positions and orientations alone whether a run drifts, gains energy, falls, or passes a wall. It shares
// no code with the verdicts: velocities are central differences, energies are summed here, walls are boxes and spheres.
//
// Central differences over two and over four samples differ by three times the error of the first, nearly. That
// difference is the oracle's own error. Where it is too large to decide, the oracle abstains.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/engine/trajectory.h"
#include "core/scene/scene.h"

namespace rigor::test {

// A share of the energy scale, and the error of that share.
struct Share {
  double value = 0, error = 0;
};

// What acts on the energy of a scene: by its description, and by how the exact motion's energy stays.
struct Upkeep {
  bool is_driven = false;     // by forces or motors
  bool may_lose = false;      // by dampers, friction or inelastic impacts
  bool can_touch = false;     // any two bodies
  bool can_jump = false;      // by impacts, or at limits of joints
  bool is_comparable = true;  // false where a joint's spring holds energy, which the oracle does not compute
};
Upkeep upkeep_of(const Scene& scene);

// J, of a state whose velocities are exact.
double exact_energy(const Scene& scene, BodyColumns bodies);

class PoseOracle {
 public:
  struct Motion {
    Vec3 velocity, spin;  // m/s, rad/s in W
  };

  // `scale`: J, of the energy in play.
  PoseOracle(const Scene& scene, const Trajectory& run, double scale);

  // False where a joint's spring holds energy, or a body turns too far between two samples.
  bool can_tell() const { return upkeep_.is_comparable && is_resolved_; }
  // From the first to the last tenth of the samples before `end` [s], less the change that `expected` [J] makes
  // between the same samples. It is empty where nothing should change. None for a run of less than twenty samples.
  std::optional<Share> drift(double end, const std::vector<double>& expected = {}) const;
  // Likewise of the energy about the centre of mass, as a share of its start.
  std::optional<Share> internal_drift() const;
  // The rise above the lowest earlier energy: at least, between samples without impacts, and at most.
  Share rise_at_least() const;
  Share rise_at_most() const;

  // The first instant [s] at which a body's centre has come through a box or a sphere, and is outside again. Of a
  // sphere it came nearer than `share` of the sum of the radii: a glancing impact may also end on the far side.
  std::optional<double> passage(double share) const;
  // m, the deepest overlap of a sphere, a box or a capsule with a half-space or of two spheres, less that at the start,
  // as a share of the smallest radius that fits inside (of two that move: of half that).
  double overlap() const;
  // The first instant [s] at which a body is farther from its start than half its bounding radius.
  std::optional<double> fall() const;
  // m/s, the largest change of a body's mean velocity between neighbouring samples, less gravity's. It looks from one
  // instant [s] to another, and at `near` samples before and after.
  double jump_between(double from, double to, int near) const;

 private:
  double spacing() const;  // s
  bool is_smooth_at(std::size_t n) const;
  void add(BodyColumns at, const std::vector<Motion>& coarse, const std::vector<Motion>& fine);
  Share tenths(const std::vector<double>& coarse, const std::vector<double>& fine, std::size_t count,
               double scale) const;

  const Scene& scene_;
  const Trajectory& run_;
  double scale_;
  Upkeep upkeep_;
  bool is_resolved_ = true;
  std::vector<double> coarse_, fine_;                    // J, by differences over two and four samples
  std::vector<double> internal_coarse_, internal_fine_;  // J, about the centre of mass
};

}  // namespace rigor::test
