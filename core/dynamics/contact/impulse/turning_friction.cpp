#include "core/dynamics/contact/impulse/turning_friction.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "core/dynamics/contact/impulse/coulomb_disc.h"

namespace rigor::inline dynamics {
namespace {

// Records hold v, then w.
Eigen::Map<Vec3> angular_velocity(const SolverBodies& bodies, int body) {
  return Eigen::Map<Vec3>(bodies.velocities + kRecord * static_cast<std::size_t>(body) + 3);
}

// Records hold xx, yy, zz, xy, xz, yz, and the inverse mass.
Mat3 inverse_inertia(const SolverBodies& bodies, int body) {
  const double* I = bodies.inverse_inertias + kRecord * static_cast<std::size_t>(body);
  Mat3 full;
  full << I[0], I[3], I[4], I[3], I[1], I[5], I[4], I[5], I[2];
  return full;
}

}  // namespace

TurningFriction::TurningFriction(const Scene& scene)
    : laws_(scene), has_law_(any_law(scene, [](const ContactLaw& law) { return law.resists_turning(); })) {}

void TurningFriction::assign(const std::vector<ContactConstraint>& constraints, const ContactRowLayout& layout,
                             double impulse_scale, const SolverBodies& bodies) {
  if (!has_law_) return;
  std::map<std::tuple<int, int, std::uint32_t>, Vec3> last;
  for (const Row& row : rows_) last.emplace(std::tuple(row.a, row.b, row.feature), row.impulse);
  rows_.clear();
  const std::vector<const double*> impulses = layout.normal_impulses(constraints.size());
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    const ContactConstraint& at = constraints[i];
    const ContactLaw& law = laws_.of(at.a, at.b);
    if (!law.resists_turning()) continue;
    Row row{at.a,
            at.b,
            at.feature,
            law.rolling_friction,
            law.torsional_friction,
            at.normal,
            impulses[i],
            inverse_inertia(bodies, at.a),
            inverse_inertia(bodies, at.b)};
    const auto old = last.find({at.a, at.b, at.feature});
    if (old != last.end()) row.impulse = impulse_scale * old->second;
    rows_.push_back(row);
  }
}

void TurningFriction::turn(const Row& row, const Vec3& impulse, const SolverBodies& bodies) {
  angular_velocity(bodies, row.a) += row.inertia_a * impulse;
  angular_velocity(bodies, row.b) -= row.inertia_b * impulse;
}

void TurningFriction::warm_start(const SolverBodies& bodies) const {
  for (const Row& row : rows_) turn(row, row.impulse, bodies);
}

void TurningFriction::solve(const SolverBodies& bodies) {
  for (Row& row : rows_) {
    const double pressing = std::max(0.0, *row.normal_impulse);
    const Vec3& n = row.normal;
    const Mat3 K = row.inertia_a + row.inertia_b;
    const auto slip = [&] { return Vec3(angular_velocity(bodies, row.a) - angular_velocity(bodies, row.b)); };
    const double about = n.dot(row.impulse), most = row.torsional * pressing;
    const double next = std::clamp(about - n.dot(slip()) / n.dot(K * n), -most, most);
    turn(row, (next - about) * n, bodies);
    const Vec3 t = n.unitOrthogonal(), s = n.cross(t), w = slip();
    const TangentMass mass = tangent_mass_of(t.dot(K * t), s.dot(K * s), t.dot(K * s));
    const Vec2 rolling =
        onto_disc({t.dot(row.impulse), s.dot(row.impulse)}, {t.dot(w), s.dot(w)}, mass, row.rolling * pressing);
    const Vec3 across = rolling.x() * t + rolling.y() * s;
    turn(row, across - (row.impulse - about * n), bodies);
    row.impulse = across + next * n;
  }
}

}  // namespace rigor::inline dynamics
