#include "tests/cases/metrics/pose_oracle.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace rigor::test {
namespace {

constexpr double kLargestTurn = 1.5;  // rad over two samples: over four, a turn must stay below a half

using Motion = PoseOracle::Motion;

Vec3 turn_from(const Quat& from, const Quat& to) {
  const Eigen::AngleAxisd turn(to.normalized() * from.normalized().conjugate());
  const double angle = std::remainder(turn.angle(), 2 * EIGEN_PI);
  return angle * turn.axis();
}

// Over the samples n - k and n + k.
Motion difference(const Trajectory& run, std::size_t n, std::size_t k, std::size_t i) {
  const Sample &before = run.samples[n - k], &after = run.samples[n + k];
  const BodyColumns from = before.bodies.columns(), to = after.bodies.columns();
  const double time = after.time - before.time;
  return {(to.position(i) - from.position(i)) / time, turn_from(from.orientation(i), to.orientation(i)) / time};
}

// At the first sample, of second order in the spacing.
Motion to_one_side(const Trajectory& run, std::size_t i) {
  const BodyColumns start = run.samples[0].bodies.columns(), next = run.samples[1].bodies.columns(),
                    later = run.samples[std::min<std::size_t>(2, run.samples.size() - 1)].bodies.columns();
  const double time = run.samples[1].time - run.samples[0].time;
  const auto slope = [&](const Vec3& first, const Vec3& second) { return Vec3((1.5 * first - 0.5 * second) / time); };
  return {slope(next.position(i) - start.position(i), later.position(i) - next.position(i)),
          slope(turn_from(start.orientation(i), next.orientation(i)),
                turn_from(next.orientation(i), later.orientation(i)))};
}

// Of fourth order in the spacing.
Motion finer(const Motion& over_two, const Motion& over_four) {
  return {(4 * over_two.velocity - over_four.velocity) / 3, (4 * over_two.spin - over_four.spin) / 3};
}

double kinetic(const Body& body, const Quat& orientation, const Motion& motion) {
  const Vec3 spin_B = orientation.normalized().conjugate() * motion.spin;
  return 0.5 * body.mass * motion.velocity.squaredNorm() + 0.5 * spin_B.dot(body.inertia * spin_B);
}

Vec3 end_point(BodyColumns bodies, int body, const Vec3& point) {
  if (body == kWorld) return point;
  return bodies.position(body) + bodies.orientation(body).normalized() * point;
}

double spring_energy(const Scene& scene, BodyColumns bodies) {
  double sum = 0;
  for (const Spring& s : scene.springs) {
    const double length = (end_point(bodies, s.a, s.point_a) - end_point(bodies, s.b, s.point_b)).norm();
    sum += 0.5 * s.stiffness * (length - s.rest_length) * (length - s.rest_length);
  }
  return sum;
}

double weight_energy(const Scene& scene, BodyColumns bodies) {
  double sum = 0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    sum -= scene.bodies[i].fixed ? 0 : scene.bodies[i].mass * scene.gravity.dot(bodies.position(i));
  return sum;
}

// J, of the centre of mass's own motion.
double bulk_energy(const Scene& scene, const std::vector<Motion>& motions) {
  Vec3 momentum = Vec3::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].fixed) continue;
    momentum += scene.bodies[i].mass * motions[i].velocity, mass += scene.bodies[i].mass;
  }
  return mass > 0 ? 0.5 * momentum.squaredNorm() / mass : 0;
}

double total_kinetic(const Scene& scene, BodyColumns at, const std::vector<Motion>& motions) {
  double sum = 0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    sum += scene.bodies[i].fixed ? 0 : kinetic(scene.bodies[i], at.orientation(i), motions[i]);
  return sum;
}

double mean(const std::vector<double>& values, std::size_t from, std::size_t count) {
  const auto first = values.begin() + static_cast<long>(from);
  return std::accumulate(first, first + static_cast<long>(count), 0.0) / static_cast<double>(count);
}

double median(const std::vector<double>& values, std::size_t from, std::size_t count) {
  std::vector<double> part(values.begin() + static_cast<long>(from), values.begin() + static_cast<long>(from + count));
  std::sort(part.begin(), part.end());
  return 0.5 * (part[(count - 1) / 2] + part[count / 2]);
}

bool may_touch(const Scene& scene) {
  for (std::size_t a = 0; a < scene.bodies.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const Body &one = scene.bodies[a], &other = scene.bodies[b];
      const bool both = one.collides && other.collides && !(one.fixed && other.fixed);
      if (both && scene.contact_law(static_cast<int>(a), static_cast<int>(b)).collides) return true;
    }
  }
  return false;
}

bool contact_loses(const Scene& scene) {
  for (std::size_t a = 0; a < scene.bodies.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const Body &one = scene.bodies[a], &other = scene.bodies[b];
      if (!one.collides || !other.collides || (one.fixed && other.fixed)) continue;
      const ContactLaw law = scene.contact_law(static_cast<int>(a), static_cast<int>(b));
      if (law.collides && (law.restitution < 1 || law.friction > 0)) return true;
    }
  }
  return false;
}

// m, of the largest sphere inside, and of the smallest around the centre. Nothing for other shapes.
struct Radii {
  double inner, outer;
};
std::optional<Radii> radii_of(const Shape& shape) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return Radii{sphere->radius, sphere->radius};
  if (const auto* box = std::get_if<Box>(&shape)) return Radii{0.5 * box->size.minCoeff(), 0.5 * box->size.norm()};
  if (const auto* capsule = std::get_if<Capsule>(&shape))
    return Radii{capsule->radius, capsule->radius + 0.5 * capsule->length};
  return {};
}

// m, how far the shape reaches along a unit direction from its centre.
double reach_along(const Shape& shape, const Quat& orientation, const Vec3& direction_W) {
  const Vec3 direction = orientation.normalized().conjugate() * direction_W;
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return sphere->radius;
  if (const auto* box = std::get_if<Box>(&shape)) return 0.5 * box->size.dot(direction.cwiseAbs());
  if (const auto* capsule = std::get_if<Capsule>(&shape))
    return capsule->radius + 0.5 * capsule->length * std::abs(direction.z());
  return 0;
}

// Whether a body comes out at the far side of another, by the path of its centre in the other's frame. Of a box the
// centre passes the middle along its thinnest axis. Of a sphere it is nearer than a share of the sum of the radii, and
// leaves with a direction opposed to that of its coming.
class Crossing {
 public:
  Crossing(const Body& mover, const Body& other, double share) : mover_(mover), other_(other), share_(share) {}

  bool comes_out(const Vec3& place_B) {
    const bool was_known = is_known_;
    const Vec3 before = last_;
    last_ = place_B, is_known_ = true;
    if (!was_known) came_from_ = place_B;
    if (const auto* box = std::get_if<Box>(&*other_.shape))
      return was_known && out_of(0.5 * box->size, before, place_B);
    const auto *ball = std::get_if<Sphere>(&*mover_.shape), *sphere = std::get_if<Sphere>(&*other_.shape);
    return was_known && ball && sphere && out_of(ball->radius, sphere->radius, before, place_B);
  }

 private:
  bool out_of(double radius, double others_radius, const Vec3& before, const Vec3& now) {
    const Vec3 way = now - before;
    const double along = way.squaredNorm() > 0 ? std::clamp(-before.dot(way) / way.squaredNorm(), 0.0, 1.0) : 0;
    nearest_ = std::min(nearest_, (before + along * way).norm());
    if (now.norm() < radius + others_radius) return false;
    const bool is_out = nearest_ < share_ * (radius + others_radius) && came_from_.dot(now) < 0;
    came_from_ = now, nearest_ = std::numeric_limits<double>::infinity();
    return is_out;
  }

  // Along the thinnest axis: from one side to the other while the other two coordinates are inside.
  bool out_of(const Vec3& half, const Vec3& before, const Vec3& now) {
    int thin = 0;
    half.minCoeff(&thin);
    const auto side = [&](const Vec3& p) { return p[thin] > half[thin] ? 1 : p[thin] < -half[thin] ? -1 : 0; };
    const int from = side(before), to = side(now);
    if (from != 0) entered_ = from;
    const double travel = now[thin] - before[thin];
    if (before[thin] * now[thin] < 0 || (before[thin] != 0 && now[thin] == 0)) {
      const Vec3 middle = before - before[thin] / travel * (now - before);
      is_inside_ = true;
      for (int axis = 0; axis < 3; ++axis)
        is_inside_ = is_inside_ && (axis == thin || std::abs(middle[axis]) < half[axis]);
    }
    const bool is_out = is_inside_ && entered_ != 0 && to == -entered_;
    if (to != 0) is_inside_ = false, entered_ = to;
    return is_out;
  }

  const Body &mover_, &other_;
  double share_;
  Vec3 last_ = Vec3::Zero(), came_from_ = Vec3::Zero();
  double nearest_ = std::numeric_limits<double>::infinity();
  bool is_known_ = false, is_inside_ = false;
  int entered_ = 0;
};

}  // namespace

Upkeep upkeep_of(const Scene& scene) {
  Upkeep found;
  found.is_driven = !scene.forces.empty() || !scene.motors.empty();
  found.may_lose = contact_loses(scene), found.can_touch = may_touch(scene), found.can_jump = found.can_touch;
  for (const Spring& spring : scene.springs) found.may_lose = found.may_lose || spring.damping != 0;
  for (const Joint& joint : scene.joints) {
    found.may_lose = found.may_lose || joint.damping != 0 || (joint.has_limits() && joint.restitution < 1);
    found.can_jump = found.can_jump || joint.has_limits();
    found.is_comparable = found.is_comparable && joint.stiffness == 0;
  }
  return found;
}

double exact_energy(const Scene& scene, BodyColumns bodies) {
  std::vector<Motion> motions;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    motions.push_back({bodies.velocity(i), bodies.angular_velocity(i)});
  return total_kinetic(scene, bodies, motions) + spring_energy(scene, bodies) + weight_energy(scene, bodies);
}

// At the start the scene gives the velocities. The differences there, to one side, only tell how far to trust them.
PoseOracle::PoseOracle(const Scene& scene, const Trajectory& run, double scale)
    : scene_(scene), run_(run), scale_(scale), upkeep_(upkeep_of(scene)) {
  for (std::size_t n = 0; n + 1 < run.samples.size(); ++n) {
    std::vector<Motion> coarse, fine;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      const Motion given{scene.bodies[i].velocity, scene.bodies[i].angular_velocity};
      const Motion near = n == 0 ? to_one_side(run, i) : difference(run, n, 1, i);
      const bool has_four = n >= 2 && n + 2 < run.samples.size();
      coarse.push_back(near);
      fine.push_back(n == 0 ? given : has_four ? finer(near, difference(run, n, 2, i)) : near);
      is_resolved_ = is_resolved_ && near.spin.norm() * 2 * spacing() < kLargestTurn;
    }
    add(run.samples[n].bodies.columns(), coarse, fine);
  }
}

double PoseOracle::spacing() const { return run_.samples[1].time - run_.samples[0].time; }

void PoseOracle::add(BodyColumns at, const std::vector<Motion>& coarse, const std::vector<Motion>& fine) {
  const double springs = spring_energy(scene_, at), height = weight_energy(scene_, at);
  const double slow = total_kinetic(scene_, at, coarse), fast = total_kinetic(scene_, at, fine);
  coarse_.push_back(slow + springs + height), fine_.push_back(fast + springs + height);
  internal_coarse_.push_back(slow + springs - bulk_energy(scene_, coarse));
  internal_fine_.push_back(fast + springs - bulk_energy(scene_, fine));
}

// Impacts spoil the differences beside them: where there may be some, medians leave these samples out.
Share PoseOracle::tenths(const std::vector<double>& coarse, const std::vector<double>& fine, std::size_t count,
                         double scale) const {
  const std::size_t tenth = count / 10;
  const auto moved = [&](const std::vector<double>& values, const auto& middle) {
    return (middle(values, count - tenth, tenth) - middle(values, 0, tenth)) / scale;
  };
  const double by_mean = moved(fine, mean), by_median = moved(fine, median);
  const double beside = upkeep_.can_jump ? moved(coarse, median) : moved(coarse, mean);
  const double value = upkeep_.can_jump ? by_median : by_mean;
  const double spread = upkeep_.can_jump ? std::abs(by_mean - by_median) : 0;
  return {value, std::abs(value - beside) + spread};
}

std::optional<Share> PoseOracle::drift(double end, const std::vector<double>& expected) const {
  std::size_t count = 0;
  while (count < fine_.size() && run_.samples[count].time <= end) ++count;
  if (count < 20 || !can_tell()) return {};
  Share found = tenths(coarse_, fine_, count, scale_);
  if (expected.empty()) return found;
  const std::size_t tenth = count / 10;
  found.value -= (mean(expected, count - tenth, tenth) - mean(expected, 0, tenth)) / scale_;
  return found;
}

std::optional<Share> PoseOracle::internal_drift() const {
  const std::size_t count = fine_.size();
  if (count < 20 || !can_tell() || !(internal_fine_.front() > 0)) return {};
  return tenths(internal_coarse_, internal_fine_, count, internal_fine_.front());
}

// Only samples count at which nothing jumps: a difference across an impact lies between both velocities.
Share PoseOracle::rise_at_least() const {
  Share most;
  double lowest = std::numeric_limits<double>::infinity(), lowest_error = 0;
  for (std::size_t n = 2; n + 2 < run_.samples.size(); ++n) {
    if (!is_smooth_at(n)) continue;
    const double rise = (fine_[n] - lowest) / scale_, error = std::abs(fine_[n] - coarse_[n]) / scale_;
    if (rise - error - lowest_error > most.value - most.error) most = {rise, error + lowest_error};
    if (fine_[n] < lowest) lowest = fine_[n], lowest_error = error;
  }
  return most;
}

// Whether the accelerations at the sample and at both its neighbours agree to a tenth, for each body.
bool PoseOracle::is_smooth_at(std::size_t n) const {
  constexpr double kAlike = 0.1;
  for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
    if (scene_.bodies[i].fixed) continue;
    Vec3 accelerations[3], spins[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const BodyColumns before = run_.samples[n + k - 2].bodies.columns(),
                        at = run_.samples[n + k - 1].bodies.columns(), after = run_.samples[n + k].bodies.columns();
      accelerations[k] = after.position(i) - 2 * at.position(i) + before.position(i);
      spins[k] =
          turn_from(at.orientation(i), after.orientation(i)) - turn_from(before.orientation(i), at.orientation(i));
    }
    const double fall = spacing() * spacing() * scene_.gravity.norm();
    for (const std::size_t k : {0, 2}) {
      const double turning = turn_from(run_.samples[n - 1].bodies.columns().orientation(i),
                                       run_.samples[n].bodies.columns().orientation(i))
                                 .norm();
      const double most = std::max(accelerations[1].norm(), fall),
                   most_spin = std::max(spins[1].norm(), kAlike * turning);
      if ((accelerations[k] - accelerations[1]).norm() > kAlike * most + 1e-12) return false;
      if ((spins[k] - spins[1]).norm() > kAlike * most_spin + 1e-12) return false;
    }
  }
  return true;
}

Share PoseOracle::rise_at_most() const {
  Share most;
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < fine_.size(); ++n) {
    lowest = std::min(lowest, std::min(coarse_[n], fine_[n]));
    most.value = std::max(most.value, (std::max(coarse_[n], fine_[n]) - lowest) / scale_);
  }
  return most;
}

std::optional<double> PoseOracle::passage(double share) const {
  for (std::size_t a = 0; a < scene_.bodies.size(); ++a) {
    for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
      const Body &mover = scene_.bodies[a], &other = scene_.bodies[b];
      if (a == b || mover.fixed || !mover.collides || !other.collides || !mover.shape || !other.shape) continue;
      if (!scene_.contact_law(static_cast<int>(a), static_cast<int>(b)).collides) continue;
      Crossing crossing(mover, other, share);
      for (const Sample& sample : run_.samples) {
        const BodyColumns at = sample.bodies.columns();
        const Vec3 place_B = at.orientation(b).normalized().conjugate() * Vec3(at.position(a) - at.position(b));
        if (crossing.comes_out(place_B)) return sample.time;
      }
    }
  }
  return {};
}

double PoseOracle::overlap() const {
  double most = 0;
  for (std::size_t a = 0; a < scene_.bodies.size(); ++a) {
    for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
      const Body &one = scene_.bodies[a], &other = scene_.bodies[b];
      if (a == b || one.fixed || !one.collides || !other.collides || !one.shape || !other.shape) continue;
      if (!scene_.contact_law(static_cast<int>(a), static_cast<int>(b)).collides) continue;
      const auto* plane = std::get_if<Plane>(&*other.shape);
      const auto *ball = std::get_if<Sphere>(&*one.shape), *second = std::get_if<Sphere>(&*other.shape);
      const auto radii = radii_of(*one.shape);
      if (!radii || (!plane && !(ball && second))) continue;
      const double thin = plane ? 2 * radii->inner : std::min(ball->radius, second->radius) * (other.fixed ? 2 : 1);
      std::optional<double> at_start;
      for (const Sample& sample : run_.samples) {
        const BodyColumns at = sample.bodies.columns();
        const double depth = plane ? plane->offset - plane->normal.dot(at.position(a)) +
                                         reach_along(*one.shape, at.orientation(a), plane->normal)
                                   : ball->radius + second->radius - (at.position(a) - at.position(b)).norm();
        if (!at_start) at_start = std::max(0.0, depth);
        most = std::max(most, (depth - *at_start) / thin);
      }
    }
  }
  return most;
}

std::optional<double> PoseOracle::fall() const {
  const BodyColumns start = run_.samples.front().bodies.columns();
  for (const Sample& sample : run_.samples) {
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      const Body& body = scene_.bodies[i];
      if (body.fixed || !body.shape) continue;
      const auto radii = radii_of(*body.shape);
      if (radii && (sample.bodies.columns().position(i) - start.position(i)).norm() > 0.5 * radii->outer)
        return sample.time;
    }
  }
  return {};
}

double PoseOracle::jump_between(double from, double to, int near) const {
  double most = 0;
  const auto& samples = run_.samples;
  const double spacing = samples[1].time - samples[0].time;
  for (std::size_t n = 1; n + 1 < samples.size(); ++n) {
    if (samples[n].time < from - near * spacing || samples[n].time > to + near * spacing) continue;
    const BodyColumns before = samples[n - 1].bodies.columns(), at = samples[n].bodies.columns(),
                      after = samples[n + 1].bodies.columns();
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      if (scene_.bodies[i].fixed) continue;
      const Vec3 change = (after.position(i) - 2 * at.position(i) + before.position(i)) / spacing;
      most = std::max(most, (change - spacing * scene_.gravity).norm());
    }
  }
  return most;
}

}  // namespace rigor::test
