// A scene in Siconos: Moreau and Jean's time-stepping, one step at a time.
#pragma once

#include <FrictionContact.hpp>
#include <MoreauJeanOSI.hpp>
#include <TimeStepping.hpp>
#include <memory>
#include <optional>
#include <string>

#include "adapters/siconos/process/siconos_contacts.h"
#include "core/engine/clock.h"

namespace rigor::inline adapters::siconos {

struct StepSettings {
  double theta = 0.5;  // weight of the step's end
  bool is_matched = true;
  std::optional<double> tolerance;  // of the contact solver; none: as shipped
  std::optional<int> iterations;    // its most; none: as shipped
};

class SiconosWorld {
 public:
  SiconosWorld(Scene scene, const StepSettings& settings);

  void step(double dt);
  double time() const { return clock_.time(); }  // s
  BodyColumns state() const { return bodies_->state(); }
  // Why the last step is less accurate than the method promises; empty if it is not.
  const std::string& warning() const { return warning_; }
  // Of the last step. A point of two of its parts is there twice: forces of a pair are sums.
  const std::vector<ReportedContact>& contacts() const { return reports_; }
  int lost_body() const;  // the first whose state is not finite; -1 for none
  std::vector<std::pair<std::string, std::string>> settings_in_force() const;

 private:
  void start(double time, double dt);
  void set_newton();
  void look_back();
  void step_part(double from, double dt, double whole);
  std::shared_ptr<LinearOSNS> contact_problem();

  Scene scene_;
  StepSettings settings_;
  std::unique_ptr<Bodies> bodies_;
  std::shared_ptr<Contacts> contacts_;
  std::shared_ptr<MoreauJeanOSI> integrator_;
  std::shared_ptr<LinearOSNS> problem_;
  std::shared_ptr<TimeStepping> simulation_;
  std::shared_ptr<NonSmoothDynamicalSystem> system_;
  double dt_ = 0, middle_ = 0;  // s, of the last step
  std::string warning_;
  std::vector<ReportedContact> reports_;
  Clock clock_;
};

}  // namespace rigor::inline adapters::siconos
