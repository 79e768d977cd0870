#include "cases/analysis/conformance/conformance.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "cases/analysis/conformance/trial.h"
#include "core/base/error.h"
#include "core/engine/engine_failure.h"
#include "core/scene/toml/writing/scene_writer.h"

namespace rigor::inline analysis {
namespace conformance {
namespace {

std::string text_of(const Vec3& v) { return fmt::format("({:.12g}, {:.12g}, {:.12g})", v.x(), v.y(), v.z()); }
std::string text_of(const Quat& q) {
  return fmt::format("({:.12g}, {:.12g}, {:.12g}, {:.12g})", q.w(), q.x(), q.y(), q.z());
}

}  // namespace

CheckResult holds() { return {}; }
CheckResult not_asked(const std::string& why) { return {CheckResult::Answer::not_asked, "", "", "", why}; }
CheckResult broken(const std::string& sent, const std::string& came, const std::string& due) {
  return {CheckResult::Answer::broken, sent, came, due, ""};
}

double rounding_of(const Trial& trial) {
  return trial.info.precision == "single" ? std::numeric_limits<float>::epsilon()
                                          : std::numeric_limits<double>::epsilon();
}

void Comparison::number(const std::string& what, double came, double due, double tolerance) {
  if (result_.answer == CheckResult::Answer::broken || std::abs(came - due) <= tolerance) return;
  result_ =
      broken(sent_, fmt::format("{} {:.12g}", what, came), fmt::format("{:.12g}, give or take {:.2g}", due, tolerance));
}

void Comparison::vector(const std::string& what, const Vec3& came, const Vec3& due, double tolerance) {
  if (result_.answer == CheckResult::Answer::broken || (came - due).norm() <= tolerance) return;
  result_ = broken(sent_, fmt::format("{} {}", what, text_of(came)),
                   fmt::format("{}, give or take {:.2g}", text_of(due), tolerance));
}

void Comparison::orientation(const Quat& came, const Quat& due, double tolerance) {
  if (result_.answer == CheckResult::Answer::broken || angle_between(came, due) <= tolerance) return;
  result_ = broken(sent_, fmt::format("orientation (w, x, y, z) {}", text_of(came)),
                   fmt::format("{}, give or take {:.2g} rad", text_of(due), tolerance));
}

TriedWorld::TriedWorld(const Trial& trial, const Scene& scene)
    : world_(trial.engine.load(scene, trial.settings)), sent_("load " + scene_json(scene)) {}

TriedWorld& TriedWorld::step(double dt, int count) {
  sent_ += count == 1 ? fmt::format("; step {:g} s", dt) : fmt::format("; {} steps of {:g} s", count, dt);
  for (int n = 0; n < count; ++n) world_->step(dt);
  return *this;
}

BodyTable TriedWorld::state() {
  Snapshot now;
  world_->read(now);
  const std::string lost = world_->solver_warning();
  if (!lost.empty()) throw EngineFailure(FailureKind::diverged, lost);
  return BodyTable(now.bodies());
}

double TriedWorld::time() {
  Snapshot now;
  world_->read(now);
  return now.time;
}

bool TriedWorld::asks_for_contacts() {
  sent_ += "; ask for contacts";
  return ask_for_contacts(*world_);
}

std::vector<ReportedContact> TriedWorld::contacts() {
  sent_ += "; contacts";
  return reported_contacts(*world_);
}

Body round_body() {
  Body body;
  body.name = "body", body.mass = 3;
  body.position = {1, -2, 3}, body.orientation = Quat(0.1, 0.5, -0.3, 0.8).normalized();
  body.velocity = {0.4, -0.1, 0.7}, body.angular_velocity = {0.3, 0.9, -0.5};
  body.inertia = 1.5 * Mat3::Identity();
  return body;
}

Body odd_body() {
  Body body = round_body();
  body.inertia << 2.0, 0.3, -0.2, 0.3, 2.5, 0.1, -0.2, 0.1, 3.0;
  return body;
}

Scene scene_of(Body body, const Vec3& gravity) {
  Scene scene;
  scene.gravity = gravity, scene.bodies = {std::move(body)};
  return scene;
}

Body solid(const std::string& name, const Shape& shape, const Vec3& position) {
  Body body;
  body.name = name, body.mass = 2, body.shape = shape, body.position = position, body.collides = true;
  if (std::holds_alternative<Plane>(shape)) {
    body.fixed = true;
  } else {
    body.inertia = inertia_of(shape, body.mass);
  }
  return body;
}

std::string why_not(const Trial& trial, const Scene& scene, double dt) {
  return why_unsupported(trial.info, trial.settings, scene, dt);
}

}  // namespace conformance

const std::vector<ConformanceCheck>& conformance_checks() {
  static const std::vector<ConformanceCheck> table = [] {
    std::vector<ConformanceCheck> all;
    for (const auto& part : {conformance::seam_checks(), conformance::motion_checks(), conformance::load_checks(),
                             conformance::constraint_checks(), conformance::contact_checks()})
      all.insert(all.end(), part.begin(), part.end());
    return all;
  }();
  return table;
}

CheckResult check_result(const ConformanceCheck& check, const Trial& trial) {
  try {
    return check.run(trial);
  } catch (const EngineFailure& failure) {
    if (failure.kind() == FailureKind::timed_out) throw;  // no other check would do better
    return conformance::broken(check.asks, failure.what(), "an answer");
  } catch (const InputError& error) {
    return conformance::broken(check.asks, error.what(), "an answer");
  }
}

}  // namespace rigor::inline analysis
