// Contact by impulses, for piles: the step is divided into small sub-steps of the integrator, and within
// each the bodies move freely by its scheme and are then corrected (pile_solver.h). Contacts are found once a step, and
// in long ones once every kLongestStretch (manifolds.h). What is fast and far enough to meet something by the next time
// is seen before it does, so that it cannot pass through.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/dynamics/contact/contact_method.h"
#include "core/dynamics/contact/impulse/sequential_impulses.h"
#include "core/engine/option_values.h"

namespace rigor {
namespace {

// So short that what a spring as stiff as a sub-step allows gives way under ten bodies is a fraction of a millimetre.
// Who takes steps longer than kCoarse wants their number small, and can do with more work in each; and what weighs many
// times as much as another needs it: of boxes in a pyramid on sub-steps of 1/480 s, a top of thirty or a hundred times
// the others' mass moves them by 5 mm at most, one of three hundred by up to 10 cm.
constexpr double kCoarse = 1.0 / 50, kLongestSubStep = 1.0 / 480, kShorter = 1.0 / 960;  // s
constexpr double kUneven = 30;                                                           // to one
constexpr int kFewestSubSteps = 4;

constexpr double kLongestStretch = 1.0 / 120;  // s, over which contacts keep their normals

// What is a whole number but for rounding is not made one more.
int rounded_up(double count) { return static_cast<int>(std::ceil(count - 1e-9)); }

bool has_uneven_masses(const Scene& scene) {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const Body& body : scene.bodies) {
    if (!body.fixed && body.collides) least = std::min(least, body.mass), most = std::max(most, body.mass);
  }
  return most > kUneven * least;
}

class ImpulseStepper : public ContactStepper {
 public:
  ImpulseStepper(const Scene& scene, const ContactParts& parts)
      : sub_steps_(static_cast<int>(number_option(parts.settings, "substeps", 0))),
        longest_(has_uneven_masses(scene) ? kShorter : kLongestSubStep),
        manifolds_(scene),
        solver_(parts.system, parts.integrator.leapfrog_stagger > 0 ? 1 : 0.5),
        stepper_(parts.integrator.make({parts.system, nullptr, parts.orientation, parts.settings})) {}

  void step(MutableBodyColumns state, double t, double dt) override {
    if (!(dt > 0)) return stepper_->step(state, t, dt);
    const int count = sub_steps_of(dt), stretches = std::min(count, rounded_up(dt / kLongestStretch));
    const double h = dt / count;
    for (int stretch = 0, k = 0; stretch < stretches; ++stretch) {
      const int end = (stretch + 1) * count / stretches;
      solver_.begin_stretch(state, manifolds_.find(state, (end - k) * h), h);
      for (; k < end; ++k) {
        solver_.begin_sub_step(state);
        stepper_->step(state, t + k * h, h);
        solver_.first_pass(state);
        solver_.second_pass(state);
      }
      solver_.end_stretch();
    }
  }

  std::string solver_warning() const override { return stepper_->solver_warning(); }

  SettingsInForce settings_in_force() const override {
    return {{"contact solver", "sequential impulses, two passes a sub-step, warm start"},
            {"contacts", fmt::format("found once a step and every 1/{:.0f} s", 1 / kLongestStretch)},
            {"sub-steps",
             sub_steps_ > 0
                 ? fmt::format("{} a step", sub_steps_)
                 : fmt::format("at least {} a step, none longer than 1/{:.0f} s (1/{:.0f} s in steps over 1/50 s)",
                               kFewestSubSteps, 1 / longest_, 1 / kShorter)}};
  }

 private:
  int sub_steps_of(double dt) const {
    if (sub_steps_ > 0) return sub_steps_;
    return std::max(kFewestSubSteps, rounded_up(dt / (dt > kCoarse ? kShorter : longest_)));
  }

  int sub_steps_;   // 0: as dt asks
  double longest_;  // s
  Manifolds manifolds_;
  PileSolver solver_;
  std::unique_ptr<Stepper> stepper_;
};

}  // namespace

extern const ContactMethod kImpulseContact;
const ContactMethod kImpulseContact = {
    .name = "impulse",
    .summary = "velocities corrected in small sub-steps, with warm starting; for piles",
    .features =
        joined(contacts_of_all_shapes(), {"friction:coulomb", "friction:infinite", "friction:none", "restitution"}),
    .options = {{.name = "substeps",
                 .meaning = "of contact=impulse in a step; default: at least 4, none longer than 1/480 s, or 1/960 s "
                            "in steps over 1/50 s and where masses differ by more than 30 to 1",
                 .min = 1,
                 .max = 10000,
                 .whole = true}},
    .make = make_contact_stepper<ImpulseStepper>,
};

}  // namespace rigor
