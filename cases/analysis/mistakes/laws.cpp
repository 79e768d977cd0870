#include "cases/analysis/mistakes/laws.h"

#include <algorithm>
#include <cmath>

#include "core/scene/contact_laws.h"

namespace rigor::inline analysis {
namespace {

const std::string kLinear = "linear momentum", kAngular = "angular momentum";

// One sample of a motion (motions.h).
class MotionSample {
 public:
  explicit MotionSample(const double* first) : first_(first) {}
  Vec3 velocity(std::size_t body) const { return vector(body, kVelocity); }
  Vec3 angular_momentum(std::size_t body, const Body& of) const {
    Mat3 R;
    for (int k = 0; k < 9; ++k)
      R(k / 3, k % 3) = first_[body * kMotionColumns + kRotationBegin + static_cast<std::size_t>(k)];
    return R * (of.inertia * (R.transpose() * vector(body, kSpin)));
  }

 private:
  static constexpr std::size_t kRotationBegin = 3, kVelocity = 12, kSpin = 15;
  Vec3 vector(std::size_t body, std::size_t column) const {
    const double* at = first_ + body * kMotionColumns + column;
    return {at[0], at[1], at[2]};
  }
  const double* first_;
};

bool is_from_outside(const Spring& spring, const Scene& scene) {
  const auto stands = [&](int body) { return body == kWorld || scene.bodies[static_cast<std::size_t>(body)].fixed; };
  return stands(spring.a) || stands(spring.b);
}

// The momentum that has come or gone by this sample, over the largest of the motion so far.
struct Momenta {
  double drift = 0, most = 0;
  double share() const { return most > 0 ? drift / most : 0; }
};

Vec3 linear_momentum(const Scene& scene, const MotionSample& sample, double time) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (!scene.bodies[i].fixed) sum += scene.bodies[i].mass * (sample.velocity(i) - time * scene.gravity);
  }
  return sum;
}

// The scale: what the bodies carry, not what is left of it in the sum.
double carried(const Scene& scene, const MotionSample& sample) {
  double sum = 0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (!scene.bodies[i].fixed) sum += scene.bodies[i].mass * sample.velocity(i).norm();
  }
  return sum;
}

double drift_of(const std::string& law, const ProbeScene& probe, const StateSeries& motion) {
  const Scene& scene = *probe.scene;
  const std::size_t row = scene.bodies.size() * kMotionColumns, samples = motion.states.size() / row;
  std::vector<Momenta> momenta(scene.bodies.size());  // of a body; of all, in the first
  for (std::size_t s = 0; s < samples; ++s) {
    const MotionSample first(motion.states.data()), now(motion.states.data() + s * row);
    if (law == kLinear) {
      const double time = probe.dt * static_cast<double>(s);
      const Vec3 change = linear_momentum(scene, now, time) - linear_momentum(scene, first, 0);
      momenta[0].drift = std::max(momenta[0].drift, change.norm());
      momenta[0].most = std::max(momenta[0].most, carried(scene, now));
      continue;
    }
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      if (scene.bodies[i].fixed) continue;
      const Vec3 L = now.angular_momentum(i, scene.bodies[i]), before = first.angular_momentum(i, scene.bodies[i]);
      momenta[i].drift = std::max(momenta[i].drift, (L - before).norm());
      momenta[i].most = std::max(momenta[i].most, L.norm());
    }
  }
  double worst = 0;
  for (const Momenta& one : momenta) worst = std::max(worst, one.share());
  return worst;
}

}  // namespace

std::vector<std::string> laws_of(const Scene& scene) {
  if (anything_can_touch(scene) || !scene.joints.empty() || !scene.forces.empty()) return {};
  const bool is_held = std::any_of(scene.springs.begin(), scene.springs.end(),
                                   [&](const Spring& spring) { return is_from_outside(spring, scene); });
  std::vector<std::string> laws;
  if (!is_held) laws.push_back(kLinear);
  if (scene.springs.empty()) laws.push_back(kAngular);
  return laws;
}

void LawWatch::add(const ProbeScene& probe, const StateSeries& motion, const StateSeries& at_half_dt) {
  if (!motion.why.empty() || !at_half_dt.why.empty()) return;
  // Roundings of some hundred steps, in a turned tensor.
  const double rounding = is_single_ ? 1e-4 : 1e-9;
  for (const std::string& law : laws_of(*probe.scene)) {
    const double drift = drift_of(law, probe, motion), half = drift_of(law, probe, at_half_dt);
    LawDrift& row = drifts_.try_emplace(law, LawDrift{law}).first->second;
    ++row.cases;
    row.is_kept = row.is_kept && std::max(drift, half) <= rounding;
    if (drift > row.drift) row.id = probe.id, row.dt = probe.dt, row.drift = drift, row.at_half_dt = half;
  }
}

std::vector<LawDrift> LawWatch::drifts() const {
  std::vector<LawDrift> all;
  for (const auto& [law, drift] : drifts_) all.push_back(drift);
  return all;
}

}  // namespace rigor::inline analysis
