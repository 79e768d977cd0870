#include "cases/analysis/small_motions/stiffest_frequency.h"

#include <cmath>
#include <tuple>
#include <vector>

namespace rigor::inline analysis {
namespace {

// The effect of a spring's unit pull on one of its bodies, in W.
struct Pull {
  int body;
  Vec3 force, torque;
};

std::vector<std::vector<Pull>> pulls_of(const Scene& scene) {
  const auto point_in_world = [&](int body, const Vec3& point) {
    return body == kWorld ? point : Vec3(scene.bodies[body].position + scene.bodies[body].orientation * point);
  };
  std::vector<std::vector<Pull>> pulls;
  for (const Spring& spring : scene.springs) {
    const Vec3 a = point_in_world(spring.a, spring.point_a), b = point_in_world(spring.b, spring.point_b);
    const Vec3 line = (b - a).normalized() * std::sqrt(stiffness_at(spring, scene.extension_at_start(spring)));
    auto& row = pulls.emplace_back();
    for (const auto& [body, point, force] : {std::tuple(spring.a, a, Vec3(-line)), std::tuple(spring.b, b, line)}) {
      if (body == kWorld || scene.bodies[body].fixed) continue;
      row.push_back({body, force, (point - scene.bodies[body].position).cross(force)});
    }
  }
  return pulls;
}

// One round of the power method: `mode`, one entry a spring, times K^½ J M⁻¹ Jᵀ K^½. Returns the product's norm.
double apply(const Scene& scene, const std::vector<std::vector<Pull>>& pulls, std::vector<double>& mode) {
  const std::size_t count = scene.bodies.size();
  std::vector<Vec3> linear(count, Vec3::Zero()), angular(count, Vec3::Zero());
  for (std::size_t i = 0; i < pulls.size(); ++i) {
    for (const Pull& pull : pulls[i])
      linear[pull.body] += mode[i] * pull.force, angular[pull.body] += mode[i] * pull.torque;
  }
  for (std::size_t b = 0; b < count; ++b) {
    const Body& body = scene.bodies[b];
    if (linear[b].isZero(0) && angular[b].isZero(0)) continue;
    linear[b] /= body.mass;
    angular[b] = body.orientation * (body.inertia.inverse() * (body.orientation.conjugate() * angular[b]));
  }
  double norm = 0;
  for (std::size_t i = 0; i < pulls.size(); ++i) {
    mode[i] = 0;
    for (const Pull& pull : pulls[i])
      mode[i] += pull.force.dot(linear[pull.body]) + pull.torque.dot(angular[pull.body]);
    norm += mode[i] * mode[i];
  }
  return std::sqrt(norm);
}

}  // namespace

double stiffest_frequency(const Scene& scene) {
  const auto pulls = pulls_of(scene);
  // 300 rounds settle the digits that a sentence shows.
  std::vector<double> mode(pulls.size());
  for (std::size_t i = 0; i < mode.size(); ++i) mode[i] = 1 + 0.1 * std::sin(1.0 + i);  // along no symmetry
  double eigenvalue = 0;
  for (int round = 0; round < 300 && !mode.empty(); ++round) {
    eigenvalue = apply(scene, pulls, mode);
    if (!(eigenvalue > 0)) return 0;
    for (double& entry : mode) entry /= eigenvalue;
  }
  return std::sqrt(eigenvalue);
}

}  // namespace rigor::inline analysis
