#include "cases/laboratory/knobs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "core/base/error.h"
#include "core/base/near_match.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline laboratory {
namespace {

constexpr double kRange = 100;  // a logarithmic knob reaches from a hundredth of its value to a hundred times it

const Body* first_moving(const Scene& scene) {
  const auto found = std::find_if(scene.bodies.begin(), scene.bodies.end(), [](const Body& one) { return !one.fixed; });
  return found == scene.bodies.end() ? nullptr : &*found;
}

// The law of the first pair that collides, else that of all other pairs.
ContactLaw first_law(const Scene& scene) {
  for (const ContactPair& pair : scene.contact_pairs)
    if (pair.law.collides) return pair.law;
  return scene.contact_default;
}

// A soft law has no restitution.
void for_each_law(Scene& scene, const std::function<void(ContactLaw&)>& change) {
  change(scene.contact_default);
  for (ContactPair& pair : scene.contact_pairs)
    if (pair.law.collides && !pair.law.is_soft()) change(pair.law);
}

// A row of the table: what of a scene it shows, and how it changes it.
struct KnobRow {
  std::optional<Knob> (*of)(const Scene& scene);  // nothing: the scene has no such value
  void (*set)(Scene& scene, double value);
};

Knob logarithmic(const char* name, const std::string& label, const char* unit, double value) {
  return {name, label, unit, value, value / kRange, value * kRange, true};
}

std::string of_springs(const char* what, const Scene& scene) {
  return fmt::format("{} of the {}", what, scene.springs.size() > 1 ? "springs" : "spring");
}

std::optional<Knob> gravity_of(const Scene& scene) {
  const double size = scene.gravity.norm();
  if (size == 0) return {};
  return Knob{"gravity", "Gravity", "m/s²", size, 0, std::max(30.0, 3 * size)};
}
void set_gravity(Scene& scene, double value) { scene.gravity *= value / scene.gravity.norm(); }

std::optional<Knob> mass_of(const Scene& scene) {
  const Body* body = first_moving(scene);
  if (!body) return {};
  const auto moving =
      std::count_if(scene.bodies.begin(), scene.bodies.end(), [](const Body& one) { return !one.fixed; });
  return logarithmic("mass", moving > 1 ? fmt::format("Mass of '{}' (all in proportion)", body->name) : "Mass", "kg",
                     body->mass);
}
void set_mass(Scene& scene, double value) {
  const double factor = value / first_moving(scene)->mass;
  for (Body& body : scene.bodies)
    if (!body.fixed) body.mass *= factor, body.inertia *= factor;
}

const Spring* first_spring(const Scene& scene) {
  const auto found =
      std::find_if(scene.springs.begin(), scene.springs.end(), [](const Spring& one) { return one.stiffness > 0; });
  return found == scene.springs.end() ? nullptr : &*found;
}

std::optional<Knob> stiffness_of(const Scene& scene) {
  const Spring* spring = first_spring(scene);
  if (!spring) return {};
  return logarithmic("stiffness", of_springs("Stiffness", scene), "N/m", spring->stiffness);
}
void set_stiffness(Scene& scene, double value) {
  const double factor = value / first_spring(scene)->stiffness;
  for (Spring& spring : scene.springs) spring.stiffness *= factor;
}

// Up to twice the critical damping of the first body on the first spring.
std::optional<Knob> damping_of(const Scene& scene) {
  const Spring* spring = first_spring(scene);
  const Body* body = first_moving(scene);
  if (!spring || !body) return {};
  const double critical = 2 * std::sqrt(spring->stiffness * body->mass);
  return Knob{"damping", of_springs("Damping", scene),
              "N s/m",   spring->damping,
              0,         std::max(2 * critical, 2 * spring->damping)};
}
void set_damping(Scene& scene, double value) {
  for (Spring& spring : scene.springs) spring.damping = value;
}

bool has_rigid_contacts(const Scene& scene) { return anything_can_touch(scene) && !first_law(scene).is_soft(); }

std::optional<Knob> restitution_of(const Scene& scene) {
  if (!has_rigid_contacts(scene)) return {};
  return Knob{"restitution", "Restitution", "", first_law(scene).restitution, 0, 1};
}
void set_restitution(Scene& scene, double value) {
  for_each_law(scene, [&](ContactLaw& law) { law.restitution = value; });
}

std::optional<Knob> friction_of(const Scene& scene) {
  if (!has_rigid_contacts(scene)) return {};
  const double value = first_law(scene).friction;
  return Knob{"friction", "Friction", "", value, 0, std::max(1.0, std::isfinite(value) ? 2 * value : 0), false, true};
}
void set_friction(Scene& scene, double value) {
  for_each_law(scene, [&](ContactLaw& law) { law.friction = value; });
}

const std::vector<KnobRow>& knob_rows() {
  static const std::vector<KnobRow> table = {
      {stiffness_of, set_stiffness},     {damping_of, set_damping},   {mass_of, set_mass},
      {restitution_of, set_restitution}, {friction_of, set_friction}, {gravity_of, set_gravity},
  };
  return table;
}

void check_value(const Knob& knob, double value) {
  const bool is_allowed = knob.may_be_infinite && value == HUGE_VAL;
  if (is_allowed || (value >= knob.least && value <= knob.most)) return;
  throw InputError(fmt::format("{}: found {:g}; allowed: {:g} to {:g}{}{}", knob.name, value, knob.least, knob.most,
                               knob.unit.empty() ? "" : " " + knob.unit, knob.may_be_infinite ? ", or infinite" : ""));
}

}  // namespace

std::vector<Knob> knobs_of(const Scene& scene) {
  std::vector<Knob> knobs;
  for (const KnobRow& row : knob_rows())
    if (auto knob = row.of(scene)) knobs.push_back(*knob);
  return knobs;
}

Scene with_knobs(const Scene& scene, const KnobValues& values) {
  std::vector<std::string> names;
  for (const Knob& knob : knobs_of(scene)) names.push_back(knob.name);
  for (const auto& [name, value] : values) {
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw InputError(
          fmt::format("the scene has no knob '{}'{}; it has: {}", name, did_you_mean(name, names), listed(names)));
  }
  Scene changed = scene;
  for (const KnobRow& row : knob_rows()) {
    const auto knob = row.of(scene);
    const auto found = knob ? values.find(knob->name) : values.end();
    if (found == values.end() || found->second == knob->value) continue;
    check_value(*knob, found->second);
    row.set(changed, found->second);
  }
  return changed;
}

}  // namespace rigor::inline laboratory
