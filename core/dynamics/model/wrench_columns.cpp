#include "core/dynamics/model/wrench_columns.h"

#include <algorithm>

namespace rigor::inline dynamics {

WrenchColumns::WrenchColumns(const System& system)
    : loads_(system.loads),
      bodies_(system.constants),
      constants_(kSpringColumns, loads_.springs().size()),
      pulls_(kPullColumns, loads_.springs().size()),
      a_(constants_.stride()),
      b_(constants_.stride()) {
  if (!loads_.empty()) wrenches_.resize(kWrenchColumns, system.size());
  for (std::size_t k = 0; k < loads_.springs().size(); ++k) set_spring(k, loads_.springs()[k]);
  list_pulls_on_bodies();
}

void WrenchColumns::set_spring(std::size_t k, const Spring& spring) {
  a_[k] = std::max(spring.a, 0);
  b_[k] = std::max(spring.b, 0);
  for (int c = 0; c < 3; ++c) {
    constants_.column(kPointA + c)[k] = spring.point_a[c];
    constants_.column(kPointB + c)[k] = spring.point_b[c];
  }
  constants_.column(kAMoves)[k] = spring.a == kWorld ? 0 : 1;
  constants_.column(kBMoves)[k] = spring.b == kWorld ? 0 : 1;
  constants_.column(kStiffness)[k] = spring.stiffness;
  constants_.column(kDamping)[k] = spring.damping;
  constants_.column(kRestLength)[k] = spring.rest_length;
  constants_.column(kQuadratic)[k] = spring.quadratic_stiffness;
}

void WrenchColumns::list_pulls_on_bodies() {
  const std::vector<Spring>& springs = loads_.springs();
  first_pull_.assign(bodies_.size() + 1, 0);
  for (const Spring& s : springs) {
    for (const int body : {s.a, s.b}) {
      if (body != kWorld) ++first_pull_[body + 1];
    }
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) first_pull_[i + 1] += first_pull_[i];
  pulls_on_.resize(first_pull_.back());
  std::vector<std::size_t> next(first_pull_.begin(), first_pull_.end() - 1);
  for (std::size_t k = 0; k < springs.size(); ++k) {
    if (springs[k].a != kWorld) pulls_on_[next[springs[k].a]++] = 2 * k;
    if (springs[k].b != kWorld) pulls_on_[next[springs[k].b]++] = 2 * k + 1;
  }
}

const double* WrenchColumns::over_step(BodyColumns state, double t, double dt, std::optional<double> instant) {
  if (loads_.empty()) return nullptr;
  const bool has_springs = !loads_.springs().empty();
  if (has_springs) {
    bodies_.for_each_share(loads_.springs().size(), [&](std::size_t first, std::size_t last) {
      const Springs springs = {.begin = first,
                               .end = last,
                               .stride = constants_.stride(),
                               .constants = constants_.data(),
                               .a = a_.data(),
                               .b = b_.data(),
                               .damped = loads_.damped(),
                               .quadratic = loads_.quadratic()};
      kernels().springs(springs, state.column(0), state.stride(), pulls_.data());
    });
    bodies_.for_each_share(bodies_.size(), [&](std::size_t first, std::size_t last) { sum_pulls(first, last); });
  }
  bool acts = add_forces(state, t, dt, has_springs) || has_springs;
  if (loads_.drives_joints()) add_drives(state, t, dt, instant, acts), acts = true;
  return acts ? wrenches_.data() : nullptr;
}

void WrenchColumns::sum_pulls(std::size_t first, std::size_t last) {
  const std::size_t from = pulls_.stride(), to = wrenches_.stride();
  const double* const pulls = pulls_.data();
  double* out = wrenches_.data() + first;
  for (std::size_t i = first; i < last; ++i, ++out) {
    double sum[kWrenchColumns] = {};
    for (std::size_t p = first_pull_[i]; p < first_pull_[i + 1]; ++p) {
      const bool on_b = pulls_on_[p] & 1;
      const double* pull = pulls + pulls_on_[p] / 2;
      const double* torque = pull + (on_b ? kTorqueB : kTorqueA) * from;
      const double sign = on_b ? 1 : -1;
      for (std::size_t c = 0; c < 3; ++c) {
        sum[kForce + c] += sign * pull[c * from];
        sum[kTorque + c] += torque[c * from];
      }
    }
    for (std::size_t c = 0; c < kWrenchColumns; ++c) out[c * to] = sum[c];
  }
}

// Says whether any force acts; if none does, columns that are not clear are left as they are.
bool WrenchColumns::add_forces(BodyColumns state, double t, double dt, bool is_clear) {
  bool acts = false;
  loads_.for_each_acting(t, dt, [&](const TimedForce& force, double share) {
    if (!acts && !is_clear) std::fill_n(wrenches_.data(), kWrenchColumns * wrenches_.stride(), 0.0);
    acts = true;
    const Vec3 F = share * force.force;
    const Vec3 torque = (state.rotation(force.body) * force.point).cross(F) + share * force.torque;
    for (int c = 0; c < 3; ++c) {
      wrenches_.column(kForce + c)[force.body] += F[c];
      wrenches_.column(kTorque + c)[force.body] += torque[c];
    }
  });
  return acts;
}

void WrenchColumns::add_drives(BodyColumns state, double t, double dt, std::optional<double> instant, bool is_clear) {
  if (!is_clear) std::fill_n(wrenches_.data(), kWrenchColumns * wrenches_.stride(), 0.0);
  loads_.for_each_drive(state, t, dt, instant, [&](int body, double effort, const Vec3& force, const Vec3& torque) {
    if (body == kWorld) return;
    for (int c = 0; c < 3; ++c) {
      wrenches_.column(kForce + c)[body] += effort * force[c];
      wrenches_.column(kTorque + c)[body] += effort * torque[c];
    }
  });
}

}  // namespace rigor::inline dynamics
