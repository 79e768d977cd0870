#include "adapters/mujoco3/mujoco3_engine.h"

#include <fmt/format.h>

#include <algorithm>

#include "adapters/common/engine_row.h"
#include "adapters/mujoco/mujoco_calls.h"
#include "adapters/mujoco/mujoco_engine.h"
#include "adapters/mujoco/mujoco_mjcf.h"
#include "adapters/mujoco/mujoco_model.h"
#include "adapters/mujoco/mujoco_options.h"
#include "adapters/mujoco/mujoco_reactions.h"
#include "adapters/mujoco/mujoco_values.h"
#include "adapters/mujoco3/mujoco3_package.h"
#include "core/base/json.h"
#include "core/engine/option_values.h"

namespace rigor::inline adapters {
namespace {

PluginStart start_of(const std::string& folder) {
  constexpr double kLimit = 60;  // s; a cell has its own limit
  return {fmt::format("node --no-warnings '{}' '{}'", mujoco3_script(), folder), kLimit, -1};
}

// `implicit` without the derivatives of Coriolis forces, which MuJoCo 2.2 does not have.
MethodInfo implicitfast() {
  MethodInfo method = mujoco_methods()[1];
  method.name = "implicitfast";
  method.summary = "the same without the derivatives of Coriolis forces";
  return method;
}

// Forces of given size come from Rigor. MuJoCo itself has springs, dampers, limits and friction.
PluginInfo description(const std::string& folder) {
  PluginInfo info;
  info.engine = {.name = "mujoco3",
                 .version = mujoco3_version(folder),
                 .precision = "double",
                 .features = mujoco_features(),
                 .methods = mujoco_methods()};
  info.engine.methods.insert(info.engine.methods.begin() + 2, implicitfast());
  info.declared = info.engine.features;
  info.declared.insert(Feature::wrench);
  for (const Feature of_rigor :
       {Feature::timed_force, Feature::motor_effort, Feature::motor_servo, Feature::motor_table})
    info.declared.erase(of_rigor);
  info.can_run = info.has_state = info.has_contacts = info.has_reactions = true;
  return info;
}

Json values_json(const std::vector<MujocoValue>& values) {
  Json rows = Json::array();
  for (const MujocoValue& one : values)
    rows.push_back(
        {{"array", one.array}, {"length", one.length}, {"at", one.at}, {"value", one.value}, {"per_dt", one.per_dt}});
  return rows;
}

// Moments, then the quaternion (w, x, y, z) of their axes; null where MuJoCo's own are exact.
Json inertia_json(const Body& body) {
  const auto inertia = inertia_to_set(body);
  if (!inertia) return nullptr;
  const Vec3& m = inertia->moments;
  const Quat& q = inertia->axes;
  return {m.x(), m.y(), m.z(), q.w(), q.x(), q.y(), q.z()};
}

// A row for each joint: the hanging body and the coordinate whose effort is no reaction, or the equalities that close a
// loop. Null if a joint is neither.
Json reactions_json(const Scene& scene, const SpanningTree& tree) {
  std::vector<Json> rows(scene.joints.size());
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    const int k = scene.bodies[static_cast<std::size_t>(i)].fixed ? -1 : tree.links[static_cast<std::size_t>(i)].joint;
    if (k < 0) continue;
    const Joint& joint = scene.joints[static_cast<std::size_t>(k)];
    Json& row = rows[static_cast<std::size_t>(k)] = {{"body", i}};
    if (free_axis(joint)) row["joint"] = fmt::format("j{}", k), row["turns"] = turns(joint), row["b"] = joint.b;
  }
  int equality = 0;
  for (const int k : tree.loops) {
    const Joint& joint = scene.joints[static_cast<std::size_t>(k)];
    Json& row = rows[static_cast<std::size_t>(k)] = {{"body", joint.a != kWorld ? joint.a : joint.b}};
    for (std::size_t n = 0; n < mjcf_loop(joint).points.size(); ++n) row["equalities"].push_back(equality++);
  }
  return std::any_of(rows.begin(), rows.end(), [](const Json& row) { return row.is_null(); }) ? Json() : Json(rows);
}

// A pair's margin is the sum of both geoms' here, and the larger one in MuJoCo 2.2.
std::vector<std::string> mujoco3_calls(const Settings& settings, const std::string& dt) {
  Settings halved = settings;
  if (is_named(settings, kMujocoContactMargin))
    halved.options[kMujocoContactMargin.name] = fmt::format("{}", number_option(settings, kMujocoContactMargin) / 2);
  return mujoco_calls(halved, dt, kMujoco3);
}

}  // namespace

Mujoco3Engine::Mujoco3Engine(const std::string& folder) : ProcessEngine(start_of(folder), description(folder)) {}

WorldTerms Mujoco3Engine::terms_of(const Scene& scene, const Settings& settings) const {
  const SpanningTree tree = spanning_tree(scene);
  Json mjcf = {{"text", mujoco_mjcf(scene, tree, settings, kMujoco3)},
               {"contacts", values_json(mujoco_contact_values(settings))},
               {"stiff", settings.track == Track::matched ? values_json(mujoco_stiff_values()) : Json::array()},
               {"heights", mujoco_heights(scene)},
               {"inertias", Json::array()},
               {"speeds", Json::array()}};
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    mjcf["inertias"].push_back(inertia_json(scene.bodies[static_cast<std::size_t>(i)]));
    mjcf["speeds"].push_back(mujoco_speeds(scene, tree, i));
  }
  const bool is_rk4 = settings.method == "rk4";  // it leaves the forces of its last stage, which are no mean
  bool are_reactions_said = MujocoReactions(scene, tree, settings.method).are_said();
  if (are_reactions_said) {
    mjcf["reactions"] = reactions_json(scene, tree);
    are_reactions_said = !mjcf["reactions"].is_null();
  }
  return {fmt::format(",\"mjcf\":{}", mjcf.dump()), !is_rk4, are_reactions_said};
}

// The formulas of smooth steps are those of MuJoCo 2.2.
std::string Mujoco3Engine::twin(const Settings& settings) const {
  return settings.method == "implicitfast" ? "" : fmt::format("core:mujoco-{}-twin", settings.method);
}

EngineRow mujoco3_row() {
  return {.make = []() -> std::unique_ptr<Engine> {
            const std::string folder = mujoco3_package_folder();
            if (folder.empty()) return nullptr;
            return std::make_unique<Mujoco3Engine>(folder);
          },
          .calls = mujoco3_calls,
          .how_to_get =
              "npm install @mujoco/mujoco, and set RIGOR_MUJOCO3 to that folder; RIGOR_ENGINES=all "
              "cases/setup does so for a build"};
}

}  // namespace rigor::inline adapters
