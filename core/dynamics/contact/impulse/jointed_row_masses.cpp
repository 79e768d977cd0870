// What an impulse of a row does to the mechanism: the changes of velocity that the joints allow, and from them the
// row's effective mass.
#include <cmath>
#include <utility>

#include "core/dynamics/contact/impulse/jointed_rows.h"

namespace rigor::inline dynamics {

void JointedRows::place_bodies() {
  std::size_t next = 0;
  for (int c = 0; c < joints_.components(); ++c) {
    of_component_.push_back({next, joints_.bodies_of(c).size()});
    for (const int body : joints_.bodies_of(c)) place_[static_cast<std::size_t>(body)] = next++;
  }
  for (int body = 0; body < static_cast<int>(place_.size()); ++body)
    if (joints_.component_of(body) < 0) place_[static_cast<std::size_t>(body)] = next++;
}

JointedRows::Span JointedRows::span_of(int body) const {
  if (body == kWorld || system_.bodies[body].fixed) return {};
  const int component = joints_.component_of(body);
  return component < 0 ? Span{place_[static_cast<std::size_t>(body)], 1}
                       : of_component_[static_cast<std::size_t>(component)];
}

void JointedRows::factorise() {
  joints_.velocity_impulse(std::as_const(pose_).columns());
  is_factor_here_ = true;
}

// The part of the row's impulses that the joints allow, at the pose of the row itself: where the joints allow no motion
// along it, that is exactly none.
void JointedRows::know(Row& row) {
  if (!is_factor_here_) factorise();
  row.is_known = true;
  row.moved[0] = span_of(row.body[0]), row.moved[1] = span_of(row.body[1]);
  const bool is_same = row.moved[0].count > 0 && row.moved[0].first == row.moved[1].first;
  if (is_same) row.moved[1] = {};
  row.responses = responses_.size();
  const std::vector<int> bodies = through_joints_.moved_by(row.body[0], row.body[1]);
  for (int d = 0; d < row.directions; ++d) {
    const std::vector<Vec6>& change = through_joints_.of(bodies, row.body[0], row.J[d][0], row.body[1], row.J[d][1]);
    for (const int body : bodies) responses_.push_back(change[static_cast<std::size_t>(body)]);
  }
  find_masses(row);
  row.lever = lever_of(row);
}

void JointedRows::find_masses(Row& row) const {
  const std::size_t count = row.moved[0].count + row.moved[1].count;
  const auto K = [&](int d, int by) {
    double sum = 0;
    for (int end = 0; end < 2; ++end) {
      if (span_of(row.body[end]).count == 0) continue;
      const std::size_t place = place_[static_cast<std::size_t>(row.body[end])];
      const Span &first = row.moved[0], &second = row.moved[1];
      const std::size_t at =
          place - first.first < first.count ? place - first.first : first.count + place - second.first;
      sum += row.J[d][end].dot(responses_[row.responses + static_cast<std::size_t>(by) * count + at]);
    }
    return sum;
  };
  // A row along which the joints allow no motion gets no impulse.
  const auto inverse = [](double k, double scale) { return k > 1e-12 * scale ? 1 / k : 0; };
  const auto scale = [&](int d) {
    double sum = 0;
    for (int end = 0; end < 2; ++end) sum += row.J[d][end].dot(through_joints_.alone(row.body[end], row.J[d][end]));
    return sum;
  };
  row.mass = inverse(K(0, 0), scale(0));
  if (row.directions == 1) return;
  const double tt = K(1, 1), ss = K(2, 2), ts = K(1, 2);
  row.tangent_mass = tangent_mass_of(tt, ss, ts);
  if (tt * ss - ts * ts > 1e-12 * scale(1) * scale(2)) return;
  // The joints leave at most one direction to slip in: one mass for all.
  const double larger = 0.5 * (tt + ss) + std::hypot(0.5 * (tt - ss), ts);
  row.tangent_mass.slip = inverse(larger, scale(1) + scale(2));
  row.tangent_mass.tt = row.tangent_mass.ss = row.tangent_mass.slip, row.tangent_mass.ts = 0;
}

// The radius at which the bodies' mass would have the inertia that the row feels.
double JointedRows::lever_of(const Row& row) const {
  if (!row.turns) return 1;
  double inverse_mass = 0;
  for (const int body : row.body) inverse_mass += body == kWorld ? 0 : system_.bodies[body].inverse_mass;
  return std::sqrt(row.mass * inverse_mass);
}

}  // namespace rigor::inline dynamics
