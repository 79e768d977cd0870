// Shared by the checks: scenes, worlds that record their calls, and comparisons in words.
#pragma once

#include <string>

#include "cases/analysis/conformance/conformance.h"

namespace rigor::inline analysis::conformance {

CheckResult holds();
CheckResult not_asked(const std::string& why);
CheckResult broken(const std::string& sent, const std::string& came, const std::string& due);

// The unit roundoff of the engine's declared precision.
double rounding_of(const Trial& trial);

// Keeps the first of several values that exceeds its tolerance.
class Comparison {
 public:
  explicit Comparison(std::string sent) : sent_(std::move(sent)) {}
  void number(const std::string& what, double came, double due, double tolerance);
  void vector(const std::string& what, const Vec3& came, const Vec3& due, double tolerance);
  void orientation(const Quat& came, const Quat& due, double tolerance);  // rad
  CheckResult result() const { return result_; }

 private:
  std::string sent_;
  CheckResult result_;
};

// A world that records its calls.
class TriedWorld {
 public:
  TriedWorld(const Trial& trial, const Scene& scene);
  TriedWorld& step(double dt, int count = 1);
  BodyTable state();
  double time();
  // Switches reports of contact forces on; false if it has none.
  bool asks_for_contacts();
  std::vector<ReportedContact> contacts();  // of the last step
  const std::string& sent() const { return sent_; }

 private:
  std::unique_ptr<World> world_;
  std::string sent_;
};

// A tilted, moving body with all six entries of inertia; a ball with equal moments; both of 3 kg.
Body odd_body();
Body round_body();
Scene scene_of(Body body, const Vec3& gravity = Vec3::Zero());
Body solid(const std::string& name, const Shape& shape, const Vec3& position);

// The reason why the engine cannot run the scene; empty if it declares that it can.
std::string why_not(const Trial& trial, const Scene& scene, double dt);

// The tables of checks, one per file.
std::vector<ConformanceCheck> seam_checks();
std::vector<ConformanceCheck> motion_checks();
std::vector<ConformanceCheck> load_checks();
std::vector<ConformanceCheck> constraint_checks();
std::vector<ConformanceCheck> contact_checks();

}  // namespace rigor::inline analysis::conformance
