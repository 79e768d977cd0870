// Contact by events. Inside a step the instants are found at which bodies meet and at which sliding ends, as roots of
// gaps and of sliding speeds along the integrator's own sub-steps from the last such instant; there impacts are
// resolved (impacts.h), and between them what touches is held (held_motion.h). A sequence of bounces ends by the rule
// of kRestSpeed. Bodies that overlap at the start are moved apart at once, without velocity. After kMostEvents in one
// step the rest of that step has no rebounds, after twice as many no events, and the run says so. A body that passes
// another's least half-width within a step has the step divided first, so that nothing passes through.
#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "core/dynamics/contact/contact_method.h"
#include "core/dynamics/contact/held_motion.h"

namespace rigor {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTouching = 1e-10;  // m: gaps this small are closed; at 1 m/s it is 1e-10 s
constexpr int kMostEvents = 300;
constexpr int kMostPieces = 10000;

class EventStepper : public ContactStepper {
 public:
  EventStepper(const Scene& scene, const ContactParts& parts)
      : touches_(scene),
        motion_(scene, parts.integrator, parts.orientation, parts.settings, touches_),
        impacts_(motion_.system()) {}

  void step(MutableBodyColumns state, double t, double dt) override {
    complaint_.clear();
    if (!(dt > 0)) return step_without_contact(state, t, dt);
    double done = 0;
    for (int events = 0; done < dt; ++events) {
      if (events == kMostEvents) note(fmt::format("more than {} events in a step: no rebounds in its rest", events));
      begin_part(state, events >= kMostEvents);
      const double end = motion_.system().loads.next_switch(t + done, t + dt);
      part_ = {t, done, end == t + dt ? dt : end - t};
      done = events < 2 * kMostEvents ? advance(state) : finish(state);
    }
  }

  std::string complaint() const override { return complaint_; }

  SettingsInForce settings_in_force() const override {
    return {{"impacts", "at their own instants, simultaneous ones together"},
            {"end of a sequence of bounces", fmt::format("no rebound from below {} m/s", kRestSpeed)},
            {"most events in a step", fmt::format("{}", kMostEvents)}};
  }

 private:
  // What is being advanced over: the time since the step's start t goes from `from` to `to`.
  struct Part {
    double t = 0, from = 0, to = 0;  // s
    double length() const { return to - from; }
  };

  void note(const std::string& complaint) {
    if (complaint_.empty()) complaint_ = complaint;
  }

  void step_without_contact(MutableBodyColumns state, double t, double dt) {
    motion_.hold(state, {});
    start_ = BodyColumns(state);
    motion_.advance(start_.columns(), state, t, dt);
  }

  // Impacts now, and what is held until the next event.
  void begin_part(MutableBodyColumns state, bool inelastic) {
    pairs_ = touches_.candidates(state, state, 0);
    motion_.close_gaps(state, pairs_);
    touching_.clear();
    touches_.find(state, pairs_, kTouching, touching_);
    impacts_.resolve(state, touching_, inelastic);
    note(impacts_.complaint());
    motion_.hold(state, touching_);
  }

  // As far as the next event, or to the part's end. Returns how far, in the time of the step.
  double advance(MutableBodyColumns state) {
    start_ = BodyColumns(state);
    end_ = BodyColumns(state);
    const double length = part_.length();
    pairs_.clear();
    attempt(length);
    pairs_ = touches_.candidates(start_.columns(), std::as_const(end_).columns(), length);
    const int pieces = pieces_of(length);
    double clear = 0, distance = distance_from_event();
    for (int k = 1; k <= pieces; ++k) {
      const double h = k == pieces ? length : length * k / pieces;
      if (pieces > 1) distance = attempt(h);
      if (distance < 0) return locate(state, clear, h, distance);
      clear = h;
    }
    return commit(state, part_.to);
  }

  // The state after h into end_. Positive before the first event, negative after it.
  double attempt(double h) {
    motion_.advance(start_.columns(), end_.columns(), part_.t + part_.from, h);
    return distance_from_event();
  }

  double distance_from_event() { return std::min(motion_.distance_from_sticking(), least_free_gap()); }

  double commit(MutableBodyColumns state, double done) {
    copy_columns(std::as_const(end_).columns(), state);
    note(motion_.complaint());
    return done;
  }

  // Without looking for events: what touches is held, whatever its velocity.
  double finish(MutableBodyColumns state) {
    note("too many events in a step: its rest was taken in one");
    start_ = BodyColumns(state);
    end_ = BodyColumns(state);
    motion_.advance(start_.columns(), end_.columns(), part_.t + part_.from, part_.length());
    return commit(state, part_.to);
  }

  // The first event lies between `low`, where all is clear, and `high`.
  double locate(MutableBodyColumns state, double low, double high, double distance_high) {
    double distance_low = 1;
    if (low == 0) {
      // Bodies that have just parted have no gap at the start yet: halved until it is seen.
      constexpr int kMostHalvings = 60;
      int halvings = 0;
      for (; halvings < kMostHalvings; ++halvings) {
        const double middle = 0.5 * high, distance = attempt(middle);
        if (distance >= 0) {
          low = middle, distance_low = distance;
          break;
        }
        high = middle, distance_high = distance;
      }
      if (halvings == kMostHalvings) return hold_slow_ones(state);
    } else {
      distance_low = attempt(low);
    }
    if (distance_low > 0) low = root(low, high, distance_low, distance_high);
    attempt(low);
    return commit(state, part_.from + low);
  }

  double root(double low, double high, double distance_low, double distance_high) {
    std::uintmax_t most = 200;
    // A step's own rounding: its share of dt, and that of a gap at the speed of sound.
    const double width = 1e-15 * part_.length();
    return boost::math::tools::toms748_solve([this](double h) { return attempt(h); }, low, high, distance_low,
                                             distance_high, [=](double a, double b) { return b - a <= width; }, most)
        .first;
  }

  // What parts so slowly that rounding hides its gap is held after all; if it is, the rest of the part goes without
  // looking for events.
  double hold_slow_ones(MutableBodyColumns state) {
    if (motion_.hold_slower_than(10 * kRestSpeed, state, touching_)) return advance(state);
    return finish(state);
  }

  // The least gap of points that are not held. Where others of the pair are, what these drift is allowed to them too.
  double least_free_gap() {
    double least = kInfinity;
    for (const auto& [a, b] : pairs_) {
      double drift = 0;
      for (const HeldPoint& held : motion_.points()) {
        if (held.at_end.a == a && held.at_end.b == b) drift = std::max(drift, 4 * std::abs(held.at_end.gap) + 1e-9);
      }
      for (const ContactPoint& point : touches_.manifold(end_.columns(), a, b)) {
        const bool is_held =
            drift > 0 && std::any_of(motion_.points().begin(), motion_.points().end(), [&](const auto& h) {
              return h.at_end.a == a && h.at_end.b == b && h.at_end.feature == point.feature;
            });
        if (!is_held) least = std::min(least, point.gap + drift);
      }
    }
    return least;
  }

  // So many that no body passes another's half-width in one of them.
  int pieces_of(double h) const {
    double most = 1;
    const BodyColumns from = start_.columns(), to = end_.columns();
    for (const auto& [a, b] : pairs_) {
      const Collider &first = touches_.colliders()[a], &second = touches_.colliders()[b];
      const double least = std::min(first.thickness, second.thickness);
      double way = turn_way(first, h) + turn_way(second, h);
      if (std::isfinite(first.reach) && std::isfinite(second.reach)) {
        way += h * std::max((from.velocity(first.body) - from.velocity(second.body)).norm(),
                            (to.velocity(first.body) - to.velocity(second.body)).norm());
      }
      most = std::max(most, std::ceil(way / least));
    }
    return static_cast<int>(std::min<double>(most, kMostPieces));
  }

  // How far the body's turning can take its surface.
  double turn_way(const Collider& collider, double h) const {
    if (collider.fixed || std::holds_alternative<Sphere>(collider.shape)) return 0;
    return h * collider.reach * start_.columns().angular_velocity(collider.body).norm();
  }

  Touches touches_;
  HeldMotion motion_;
  Impacts impacts_;
  Part part_;
  BodyTable start_, end_;
  std::vector<Touch> touching_;
  std::vector<std::pair<int, int>> pairs_;
  std::string complaint_;
};

}  // namespace

extern const ContactMethod kEventContact;
const ContactMethod kEventContact = {
    .name = "event",
    .summary = "impacts at their own instants, what touches held by exact forces; for few bodies",
    .features =
        joined(contacts_of_all_shapes(), {"friction:coulomb", "friction:infinite", "friction:none", "restitution"}),
    .make = make_contact_stepper<EventStepper>,
};

}  // namespace rigor
