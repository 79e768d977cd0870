#include "cases/analysis/divergence/parting_bounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/base/near_match.h"

namespace rigor::inline analysis {
namespace {

struct BoundedQuantity {
  const char* name;
  double PartingBounds::*value;
};
constexpr BoundedQuantity kQuantities[] = {{"position", &PartingBounds::position},
                                           {"orientation", &PartingBounds::orientation},
                                           {"velocity", &PartingBounds::velocity},
                                           {"angular_velocity", &PartingBounds::angular_velocity}};

struct UnitOfQuantity {
  const char* unit;
  int quantity;  // a row of kQuantities
  double size;   // in SI
};
constexpr double kPartingDegree = std::numbers::pi / 180;
constexpr UnitOfQuantity kPartingUnits[] = {{"m", 0, 1},
                                            {"cm", 0, 1e-2},
                                            {"mm", 0, 1e-3},
                                            {"um", 0, 1e-6},
                                            {"nm", 0, 1e-9},
                                            {"rad", 1, 1},
                                            {"mrad", 1, 1e-3},
                                            {"urad", 1, 1e-6},
                                            {"deg", 1, kPartingDegree},
                                            {"m/s", 2, 1},
                                            {"cm/s", 2, 1e-2},
                                            {"mm/s", 2, 1e-3},
                                            {"um/s", 2, 1e-6},
                                            {"rad/s", 3, 1},
                                            {"mrad/s", 3, 1e-3},
                                            {"deg/s", 3, kPartingDegree}};

[[noreturn]] void refuse_parting_bound(const std::string& text, const std::string& what) {
  throw InputError(fmt::format("--within: found '{}'{}; allowed: as 1mm, position=0.5cm, 1mrad, velocity=2cm/s, 1deg/s",
                               text, what));
}

int quantity_named(const std::string& name, const std::string& text) {
  std::vector<std::string> known;
  for (const BoundedQuantity& row : kQuantities) known.emplace_back(row.name);
  const auto at = std::find(known.begin(), known.end(), name);
  if (at == known.end())
    refuse_parting_bound(text, fmt::format(", and there is no quantity '{}'{}; there is: {}", name,
                                           did_you_mean(name, known), listed(known)));
  return static_cast<int>(at - known.begin());
}

void read_parting_bound(const std::string& text, PartingBounds& bounds) {
  std::string plain = text;
  std::erase(plain, ' ');
  const std::size_t equals = plain.find('=');
  const int named = equals == std::string::npos ? -1 : quantity_named(plain.substr(0, equals), text);
  const std::string value = equals == std::string::npos ? plain : plain.substr(equals + 1);
  double number = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  if (error != std::errc()) refuse_parting_bound(text, ", which begins with no number");
  if (!std::isfinite(number) || number <= 0) refuse_parting_bound(text, ", whose number is not greater than 0");
  const std::string unit(end, value.data() + value.size());
  if (unit.empty()) refuse_parting_bound(text, ", which has no unit");
  const auto row =
      std::find_if(std::begin(kPartingUnits), std::end(kPartingUnits), [&](const auto& r) { return unit == r.unit; });
  if (row == std::end(kPartingUnits)) refuse_parting_bound(text, fmt::format(", whose unit is '{}'", unit));
  const BoundedQuantity& quantity = kQuantities[row->quantity];
  if (named >= 0 && named != row->quantity)
    refuse_parting_bound(text, fmt::format(", but '{}' is a unit of {}", unit, quantity.name));
  double& bound = bounds.*quantity.value;
  if (std::isfinite(bound)) refuse_parting_bound(text, fmt::format(", but {} is bounded twice", quantity.name));
  bound = number * row->size;
}

bool can_body_move(const Scene& scene, int body) {
  return body != kWorld && !scene.bodies[static_cast<std::size_t>(body)].fixed;
}

// m: from the centre of a moving body to the joints and springs that hold it.
double longest_arm(const Scene& scene) {
  double longest = 0;
  for (const Joint& joint : scene.joints) {
    const Vec3* anchor = anchor_of(joint);
    if (!anchor) continue;
    for (const int body : {joint.a, joint.b}) {
      if (can_body_move(scene, body)) longest = std::max(longest, (*anchor - scene.pose(body).position).norm());
    }
  }
  for (const Spring& spring : scene.springs) {
    if (can_body_move(scene, spring.a)) longest = std::max(longest, spring.point_a.norm());
    if (can_body_move(scene, spring.b)) longest = std::max(longest, spring.point_b.norm());
  }
  return longest;
}

}  // namespace

double scene_size(const Scene& scene) {
  double size = longest_arm(scene), gyration = 0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.fixed) continue;
    if (body.shape) size = std::max(size, 2 * bounding_radius(*body.shape));
    gyration = std::max(gyration, std::sqrt(body.inertia.trace() / (2 * body.mass)));
    for (std::size_t k = 0; k < i; ++k) {
      if (!scene.bodies[k].fixed) size = std::max(size, (scene.bodies[k].position - body.position).norm());
    }
  }
  return size > 0 ? size : gyration;
}

PartingBounds default_parting_bounds(const Scene& scene) {
  constexpr double kOfSize = 1e-3, kAngle = 1e-3;  // of the scene's size; rad
  PartingBounds bounds;
  bounds.size = scene_size(scene);
  bounds.position = kOfSize * bounds.size, bounds.orientation = kAngle;
  return bounds;
}

PartingBounds parse_parting_bounds(const std::vector<std::string>& texts) {
  PartingBounds bounds;
  for (const std::string& text : texts) read_parting_bound(text, bounds);
  return bounds;
}

}  // namespace rigor::inline analysis
