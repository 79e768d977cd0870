// Contact by events. Inside a step the method finds the instants at which bodies meet, separate, begin or cease to
// slide. They are roots of gaps, forces and slips along the integrator's own sub-steps from the last event. Impacts are
// resolved there (impacts.h); between them contact is persistent (persistent_contact.h). A sequence of bounces ends by
// the rule of kRestitutionThreshold. Bodies that overlap at the start are separated at once, without velocity. If no
// forces between touching bodies satisfy the laws (Painlevé's paradox: a rod that slides at a steep angle), an impact
// without collision continues, with a step of kInstant. If bodies may meet (conservative_advancement.h,
// acceleration_bounds.h), the time is halved, so that nothing passes through and no graze is missed. Limits of joints
// are contacts without friction. With joints, impulses and forces act through them.
//
// The number of events is bounded, because they may crowd: a row of dominoes comes to rest in infinitely many small
// impacts. Beyond the budget the rest of a step uses steps without a search for events (crowded_steps.h), and the run
// reports the time from which this holds (reduced_order()). The same applies if more bodies touch each other than their
// forces can be solved for at each stage.
#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "core/dynamics/contact/contact_method.h"
#include "core/dynamics/contact/event/clearance/clearance.h"
#include "core/dynamics/contact/event/crowded_steps.h"
#include "core/dynamics/contact/event/event_forces.h"
#include "core/dynamics/contact/event/event_options.h"
#include "core/dynamics/contact/event/persistent/persistent_contact.h"
#include "core/dynamics/contact/event/persistent/rest.h"
#include "core/engine/option_values.h"
#include "core/engine/state_archive.h"

namespace rigor::inline dynamics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kInstant = 1e-5;   // in the scene's units of time: a step over an instant without forces
constexpr int kMostInstants = 100;  // in a step
// Steps of the integrator times moving bodies: the largest saved amount, and the amount for each step of the run. An
// impact costs some ten of them. A ball that bounces with e = 0.9 comes to rest within 1700.
constexpr double kMostSaved = 6000, kForEachStep = 200;
constexpr double kForEachPart = 3;    // in such steps: the cost of finding contacts and their modes
constexpr double kForNoForces = 400;  // the same, where in the end no forces are found

// Bodies in contact with each other: the equations of their forces are dense, with some six rows each. A stage of the
// integrator takes 0.04 s at this number, and grows as its cube.
constexpr std::size_t kMostTogether = 128;

// Relative. Parts that end where a slow slip limits the step are no events, and cost nothing of the budget. If the slip
// changes by more than this in each part, the run takes some 10/kSteady of them. A slip that stays slow would take any
// number.
constexpr double kSteady = 2e-4;

constexpr int kMostPieces = 200;  // of the time to the next event, while bodies are not seen to stay apart

bool is_finite(BodyColumns state) {
  for (std::size_t i = 0; i < state.size(); ++i) {
    if (!state.position(i).allFinite() || !state.orientation(i).coeffs().allFinite()) return false;
    if (!state.velocity(i).allFinite() || !state.angular_velocity(i).allFinite()) return false;
  }
  return true;
}

class EventStepper : public ContactStepper {
 public:
  EventStepper(const Scene& scene, const ContactParts& parts)
      : contact_points_(scene, number_option(parts.settings, kThresholdsOption)),
        loads_(parts.system.loads),
        persistent_contact_(parts, contact_points_),
        impacts_(parts.system, contact_points_.scales(),
                 restitution_threshold(parts.settings, contact_points_.scales()), parts.joints),
        crowded_(parts, contact_points_),
        clearance_(parts.system, contact_points_, persistent_contact_),
        patience_(number_option(parts.settings, kPatienceOption)),
        moving_(std::max<double>(
            1, static_cast<double>(std::count_if(parts.system.bodies.begin(), parts.system.bodies.end(),
                                                 [](const Inertia& body) { return !body.fixed; })))) {
    for (const Body& body : scene.bodies) names_.push_back(body.name);
  }

  void step(MutableBodyColumns state, double t, double dt) override {
    solver_warning_.clear();
    is_smooth_ = true;
    if (!(dt > 0)) return step_without_contact(state, t, dt);
    forces_.begin_step();
    saved_ = std::min(saved_ + kForEachPart + patience_ * kForEachStep / moving_, patience_ * kMostSaved / moving_);
    if (rest_.goes_on(state, t, dt)) return stay(state, dt);
    rest_.begin_step(state);
    pairs_ = contact_points_.candidates(state);
    persistent_contact_.close_gaps(state, pairs_, PersistentContact::Closing::overlaps);
    note_jam();
    instants_ = 0;
    crowded_step_ = crowded_.longest(dt);
    instant_ = kInstant * contact_points_.scales().time;
    for (double done = 0; done < dt;) {
      if (!is_finite(state)) return note("the state of a body is no longer finite");
      const double end = persistent_contact_.next_switch(t + done, loads_.next_switch(t + done, t + dt));
      is_smooth_ = is_smooth_ && end == t + dt;
      part_ = {t, done, end == t + dt ? dt : end - t};
      const long work_before = work_so_far();
      follows_slip_ = false;
      done = saved_ > 0 ? take_part(state) : take_crowded_step(state, crowded_step_);
      if (!follows_slip_) saved_ -= kForEachPart + static_cast<double>(work_so_far() - work_before);
    }
    note(persistent_contact_.take_projection_warning());
    forces_.end_step(dt);
    if (is_smooth_ && is_at_rest_ && solver_warning_.empty())
      rest_.end_step(state, t, persistent_contact_.next_switch(t, loads_.next_switch(t, kInfinity)));
  }

  ReportsContacts* contact_reports() override { return &forces_; }

  std::string solver_warning() const override { return solver_warning_; }
  void archive_state(StateArchive& archive) override {
    archive(saved_, crowded_from_, flat_from_, are_many_, longest_, last_damping_, is_smooth_, solver_warning_);
    archive.resized(ties_);
    for (ContactTie& tie : ties_) archive(tie.time, tie.pairs);
    archive(contact_points_, persistent_contact_, crowded_);
    rest_.forget();
  }
  bool was_smooth() const override { return is_smooth_; }
  long work() const override { return persistent_contact_.passes(); }
  void watch_ties() override { impacts_.watch_ties(); }
  std::vector<ContactTie> ties() const override { return ties_; }
  std::optional<ReducedOrder> reduced_order() const override {
    constexpr const char* kOnPoints = "with the flat end of a cylinder on four points of its rim";
    if (!crowded_from_) return flat_from_ ? std::optional(ReducedOrder{*flat_from_, kOnPoints}) : std::nullopt;
    const std::string many = fmt::format(" or more than {} bodies touch each other", kMostTogether);
    return ReducedOrder{std::min(*crowded_from_, flat_from_.value_or(kInfinity)),
                        "in part by " + crowded_.wording() + ", for events crowd there" + (are_many_ ? many : "") +
                            (flat_from_ ? std::string("; in part ") + kOnPoints : "")};
  }

  SettingsInForce settings_in_force() const override {
    return {{"impacts", "at their own instants, simultaneous ones together"},
            {persistent_contact_.has_joints() ? "joints and persistent contact" : "persistent contact",
             "by forces at each stage of " + persistent_contact_.integrator_in_contact()},
            {"end of a sequence of bounces",
             fmt::format("no rebound from below {:.2g} m/s", impacts_.restitution_threshold())},
            {"where events crowd",
             fmt::format("inelastic steps of first order, of {:.2g} s or a quarter of the run's at most",
                         crowded_.longest(kInfinity))}};
  }

 private:
  // What is being advanced over: the time since the step's start t goes from `from` to `to`.
  struct Part {
    double t = 0, from = 0, to = 0;  // s
    double length() const { return to - from; }
  };

  // The choice of sticking points does not count. On the verge of sliding it takes long in every step without any
  // crowd.
  long work_so_far() const { return persistent_contact_.passes() + impacts_.work(); }

  void note(const std::string& solver_warning) {
    if (solver_warning_.empty()) solver_warning_ = solver_warning;
  }

  void note_jam() {
    const ContactPoint* jam = persistent_contact_.jam();
    if (!jam) return;
    note(fmt::format("{} and {} overlap by {:.2g} m, and no way was found to part all bodies", names_[jam->cone.a],
                     names_[jam->cone.b], -jam->gap));
  }

  void stay(BodyColumns state, double dt) {
    if (forces_.is_asked()) persistent_contact_.visit_forces_at_rest(state, dt, see_force_);
    forces_.end_step(dt);
  }

  void step_without_contact(MutableBodyColumns state, double t, double dt) {
    rest_.forget();
    persistent_contact_.select(state, {}, t, dt);
    start_ = BodyColumns(state);
    persistent_contact_.advance(start_.columns(), state, t, dt);
  }

  // Impacts now, and what stays in contact until the next event.
  double take_part(MutableBodyColumns state) {
    pairs_ = contact_points_.candidates(state);
    touching_.clear();
    contact_points_.find(state, pairs_, ContactPoint::kClosed, touching_);
    if (static_cast<double>(persistent_contact_.most_together(touching_)) > patience_ * kMostTogether) {
      are_many_ = true;
      return take_crowded_step(state, crowded_step_);
    }
    note_flat_ends(state);
    start_ = BodyColumns(state);
    persistent_contact_.let_go_motors(state);
    has_impact_ = impacts_.resolve(state, touching_);
    if (has_impact_) is_smooth_ = false;
    if (!impacts_.tied().empty()) ties_.push_back({part_.t + part_.from, impacts_.tied()});
    if (!impacts_.solver_warning().empty()) {
      copy_columns(std::as_const(start_).columns(), state);
      return take_crowded_step(state, crowded_step_);
    }
    for (std::size_t i = 0; i < touching_.size() && forces_.is_asked(); ++i)
      forces_.add(touching_[i], touching_[i].cone, state, touching_[i].cone.frame * impacts_.impulses()[i]);
    if (!persistent_contact_.select(state, touching_, part_.t + part_.from, part_.length())) return skip_instant(state);
    return advance(state);
  }

  // How an end that lies flat shares its force over its rim is not known, and four points stand for all. They count
  // where more than one of them stays or is struck.
  void note_flat_ends(BodyColumns state) {
    if (flat_from_) return;
    const auto stays = [&](const ContactPoint& contact) {
      return ConeSolver::velocity_at(contact.cone, state).x() <= impacts_.restitution_threshold() &&
             contact_points_.is_of_flat_end(state, contact);
    };
    if (std::count_if(touching_.begin(), touching_.end(), stays) < 2) return;
    flat_from_ = part_.t + part_.from;
    if (patience_ > 1) note("the flat end of a cylinder shares its force over its rim in an unknown way");
  }

  // As far as the next event, or to the part's end. Returns how far, in the time of the step.
  double advance(MutableBodyColumns state) {
    start_ = BodyColumns(state);
    end_ = BodyColumns(state);
    pairs_.clear();
    is_at_rest_ = persistent_contact_.is_at_rest(state);
    if (is_at_rest_) {
      if (forces_.is_asked()) persistent_contact_.visit_forces_at_rest(state, part_.length(), see_force_);
      return part_.to;
    }
    const double of_slips = persistent_contact_.choose_step(state, part_.length()),
                 rate = persistent_contact_.fastest_damping();
    const bool may_follow =
        !has_impact_ && of_slips < part_.length() && std::abs(rate - last_damping_) > kSteady * rate;
    const double longest = std::min(longest_, of_slips);
    if (longest < part_.length()) part_.to = part_.from + longest;
    last_damping_ = rate;
    longest_ = kInfinity;
    attempt(part_.length());
    shorten_until_bounded();
    pairs_ = contact_points_.candidates(start_.columns(), std::as_const(end_).columns(), part_.length(),
                                        clearance_.bounds());
    clear_ = std::as_const(start_).columns();
    double clear = 0;
    ahead_ = {part_.length()};
    for (int pieces = 0; !ahead_.empty(); ++pieces) {
      const double h = ahead_.back(), distance = pieces == 0 ? distance_from_event() : attempt(h);
      if (distance < 0) return locate(state, clear, h, distance);
      if (pieces > patience_ * kMostPieces) return go_past_neighbours(state, clear);
      if (!is_clear_until(clear, h)) {
        ahead_.push_back(0.5 * (clear + h));
        continue;
      }
      clear = h, clear_ = std::as_const(end_).columns();
      ahead_.pop_back();
    }
    follows_slip_ = may_follow && part_.to == part_.from + of_slips;
    return commit(state, part_.to);
  }

  // For bodies that stay too near each other to decide whether they touch; up to `clear` they surely do not.
  double go_past_neighbours(MutableBodyColumns state, double clear) {
    if (clear == 0) return take_crowded_step(state, crowded_step_);
    attempt(clear);
    return commit(state, part_.from + clear);
  }

  // Starts at clear_, the state after `clear`, and goes to end_ after h.
  bool is_clear_until(double clear, double h) {
    const BodyColumns from = std::as_const(clear_).columns(), to = std::as_const(end_).columns();
    return are_bounded(from, clear, h - clear) && clearance_.all_stay_apart(pairs_, touching_, {from, clear}, {to, h});
  }

  // The effect of a stiff spring within a long step is unbounded.
  void shorten_until_bounded() {
    constexpr int kMostTimes = 30;
    for (int k = 0; k < kMostTimes && !are_bounded(start_.columns(), 0, part_.length()); ++k) {
      part_.to = part_.from + 0.5 * part_.length();
      attempt(part_.length());
      longest_ = 2 * part_.length();  // of the next part
    }
  }

  // The accelerations on the way from the state after `after` to end_, h after it.
  bool are_bounded(BodyColumns from, double after, double h) {
    return clearance_.find_bounds(from, std::as_const(end_).columns(), part_.t + part_.from + after, h);
  }

  double least_gap() { return clearance_.least_gap(pairs_, touching_, {std::as_const(end_).columns(), reach_}); }

  // The state after h into end_. Positive before the first event, negative after it.
  double attempt(double h) {
    reach_ = h;
    persistent_contact_.advance(start_.columns(), end_.columns(), part_.t + part_.from, h);
    return distance_from_event();
  }

  // Finite, for the search of a root.
  double distance_from_event() {
    constexpr double kFar = 1;
    return std::min({kFar, persistent_contact_.distance_from_change(), least_gap()});
  }

  double commit(MutableBodyColumns state, double done) {
    copy_columns(std::as_const(end_).columns(), state);
    note(persistent_contact_.solver_warning());
    if (forces_.is_asked())
      persistent_contact_.visit_forces(std::as_const(start_).columns(), part_.t + part_.from, done - part_.from,
                                       see_force_);
    contact_points_.note_turns(state, done - part_.from);
    persistent_contact_.close_joints(state);
    if (persistent_contact_.points().empty()) return done;
    pairs_ = contact_points_.candidates(state);
    persistent_contact_.close_gaps(state, pairs_, PersistentContact::Closing::all);
    persistent_contact_.stop_points(state, PersistentContact::When::after);
    return done;
  }

  // Over an instant for which there are no forces that obey the laws.
  double skip_instant(MutableBodyColumns state) {
    is_smooth_ = false;
    saved_ -= kForNoForces;
    if (++instants_ > kMostInstants)
      note("no forces between the touching bodies obey the laws of contact and friction (Painlevé's paradox)");
    return take_crowded_step(state, instants_ > kMostInstants ? crowded_step_ : instant_);
  }

  double take_crowded_step(MutableBodyColumns state, double longest) {
    is_smooth_ = false;
    if (patience_ > 1 && longest > instant_) note("events crowd more than its patience allows");
    if (!crowded_from_ && longest > instant_) crowded_from_ = part_.t + part_.from;
    const double h = crowded_.take(state, part_.t + part_.from, part_.length(), longest);
    for (std::size_t i = 0; i < crowded_.contacts().size() && forces_.is_asked(); ++i)
      forces_.add(crowded_.contacts()[i], crowded_.contacts()[i].cone, state, crowded_.impulses()[i]);
    contact_points_.note_turns(state, h);
    persistent_contact_.forget_points();
    pairs_ = contact_points_.candidates(state);
    persistent_contact_.close_gaps(state, pairs_, PersistentContact::Closing::overlaps);
    note(crowded_.solver_warning());
    return h == part_.length() ? part_.to : part_.from + h;
  }

  // The first event lies between `low`, where all is clear, and `high`.
  double locate(MutableBodyColumns state, double low, double high, double distance_high) {
    double distance_low = 1;
    if (low == 0) {
      if (!narrow_from_start(low, high, distance_low, distance_high)) return skip_instant(state);
    } else {
      distance_low = attempt(low);
    }
    is_smooth_ = false;
    if (distance_low > 0)
      std::tie(low, high) = root(low, high, distance_low, distance_high);
    else
      high = low;  // it is there, to the last bit
    // What a mode ends with is chosen anew beyond its end; bodies that meet are stopped before they overlap.
    const bool is_change = (attempt(high), persistent_contact_.distance_from_change() < 0) && least_gap() >= 0;
    if (!is_change) attempt(low), high = low;
    return commit(state, part_.from + high);
  }

  // Bodies that have just separated have no gap at the start, and a bounce may be far shorter than the part. Finds an
  // instant just before the event, from the root of d(h)/h, which is linear where d is a parabola. Returns false if
  // there is none.
  bool narrow_from_start(double& low, double& high, double& distance_low, double& distance_high) {
    constexpr int kMostTrials = 80, kMostGuesses = 20;
    constexpr double kBefore = 0.95, kLeastShare = 1.0 / 64;
    double share = 0.5;
    for (int k = 0; k < kMostTrials; ++k) {
      const double middle = share * high, distance = attempt(middle);
      if (distance >= 0) {
        low = middle, distance_low = distance;
        return true;
      }
      const double rate = distance / middle, rate_high = distance_high / high;
      const double guess = kBefore * (middle - rate * (high - middle) / (rate_high - rate)) / middle;
      // A root beyond the middle is not the one before it: bodies that close a gap of next to nothing from the start
      // on.
      const bool is_guessed = k < kMostGuesses && guess > 0 && guess < 1;
      share = is_guessed ? std::clamp(guess, kLeastShare, kBefore) : 0.5;
      high = middle, distance_high = distance;
    }
    return false;
  }

  std::pair<double, double> root(double low, double high, double distance_low, double distance_high) {
    std::uintmax_t most = 200;
    // A step's own rounding: its share of dt, and that of a gap at the speed of sound.
    const double width = 1e-14 * part_.length();
    return boost::math::tools::toms748_solve([this](double h) { return attempt(h); }, low, high, distance_low,
                                             distance_high, [=](double a, double b) { return b - a <= width; }, most);
  }

  ContactPoints contact_points_;
  const Loads& loads_;
  PersistentContact persistent_contact_;
  Impacts impacts_;
  CrowdedSteps crowded_;
  EventForces forces_;
  const PersistentContact::SeeForce see_force_ = [this](const PersistentPoint& point, BodyColumns then,
                                                        double seconds) {
    forces_.add(point.contact, point.cone(), then, seconds * (point.frame * point.force));
  };
  Clearance clearance_;
  double patience_;
  double moving_;                                      // bodies
  double saved_ = std::numeric_limits<double>::max();  // of the budget, in steps of the integrator
  double crowded_step_ = 0, instant_ = 0;              // s
  std::optional<double> crowded_from_, flat_from_;     // s
  bool are_many_ = false;                              // somewhere, more than kMostTogether
  Part part_;
  double longest_ = kInfinity;                      // s, of the next part
  double last_damping_ = 0;                         // 1/s, by friction, when the last part began
  bool has_impact_ = false, follows_slip_ = false;  // the part at hand; and it ends where a slip limits its length
  int instants_ = 0;                                // skipped in this step
  bool is_smooth_ = true;
  bool is_at_rest_ = false;  // in the last part, if that was no crowded step
  Rest rest_;
  BodyTable start_, end_, clear_;
  double reach_ = 0;           // s, from start_ to end_
  std::vector<double> ahead_;  // s, ends of the intervals still to be looked at, the next one last
  std::vector<ContactPoint> touching_;
  std::vector<std::pair<int, int>> pairs_;
  std::vector<std::string> names_;
  std::vector<ContactTie> ties_;
  std::string solver_warning_;
};

}  // namespace

extern const ContactMethod kEventContact;
const ContactMethod kEventContact = {
    .name = "event",
    .summary = "impacts at their own instants, persistent contact by forces at each stage; for few bodies",
    .features =
        joined(joined(contacts_among<Box, Capsule, Convex, Plane, Sphere>(),
                      joined(contacts_on<Heightfield, Box, Capsule, Convex, Sphere>(),
                             contacts_on<Mesh, Box, Capsule, Convex, Sphere>())),
               {contact_feature<Cylinder, Plane>(), contact_feature<Cylinder, Sphere>(),
                contact_feature<Ellipsoid, Plane>(), contact_feature<Ellipsoid, Sphere>(), Feature::placed_shapes,
                Feature::contact_filter, Feature::friction_coulomb, Feature::friction_infinite, Feature::friction_none,
                Feature::restitution, Feature::joints_with_contacts, Feature::joint_limit, Feature::motor_speed,
                Feature::joint_friction, Feature::static_friction}),
    .options = {kRestitutionThresholdOption, kThresholdsOption, kPatienceOption},
    .make = make_contact_stepper<EventStepper>,
};

}  // namespace rigor::inline dynamics
