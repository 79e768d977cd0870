// The truth is one run of an adaptive method. Three others judge it: two of the same method, looser or with other
// thresholds, and one of another integrator in fixed steps, which are halved until the two agree. Each sees the scene
// mirrored, turned or with its bodies in reverse order, so that a tie that is broken by order or direction shows. All
// are in units of the scene's own, so that no threshold depends on the user's units.
#include "cases/truth/solved/events/events_solver.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cases/truth/distance.h"
#include "cases/truth/solved/events/events_stepping.h"
#include "cases/truth/solved/pose_interpolation.h"

namespace rigor::inline truth {
namespace {

const EventsWay kFinest = {"dormand-prince", "1e-12", "0.05", {}};
const EventsWay kJudges[] = {
    {"dormand-prince", "1e-11", "1.5", {true, Quat(0.8, 0.2, -0.4, 0.4), true}},
    {"dormand-prince", "3e-12", "0.1", {false, Quat(0.5, -0.1, 0.7, 0.5), false}},
};
const EventsWay kInSteps = {"rkmk4", nullptr, "0.2", {true, Quat::Identity(), true}};

// In own units of time: a node that is this far from the next leaves the cubic between them right to some 1e-9.
constexpr double kNodeDistance = 1.0 / 64, kLongestNodeDistance = 1;
constexpr int kMostHalvings = 4;
constexpr double kWantedEventsError = 1e-8;  // m and rad; metrics ask for a hundred times that
constexpr double kUseful = 1e-6;             // m and rad, what metrics ask for
constexpr double kInterpolation = 1e-9;      // m and rad: nodes are nearer to each other where the cubic misses more
constexpr double kMostWork = 2e5;            // steps of a body, of some 20 µs each where it touches others
constexpr double kShareOfNodes = 20;         // nodes take a twentieth of the work at most, events the rest
constexpr double kSafety = 3;                // the distance of the ways is a sample of the error
// All ways share the gaps that count as closed, and the speeds of separating or sliding that count as none.
constexpr double kClosed = 1e-10, kStill = 1e-10;  // m and rad; own units of length for each unit of time
// From a tie on: m and rad. The other outcome is as right as the one that was found.
constexpr double kUnknown = 1;

void add_node(ReferenceSolution& solution, double t, BodyColumns state) {
  solution.times.push_back(t);
  for (int c = 0; c < kRotation; ++c)
    solution.states.insert(solution.states.end(), state.column(c), state.column(c) + state.size());
  solution.states.push_back(0);
}

struct Nodes {
  long count;     // intervals between them
  double length;  // s
  double at(long n) const { return static_cast<double>(n) * length; }
};

class Solver {
 public:
  Solver(const Scene& scene, double duration)
      : scene_(scene), duration_(duration), units_(own_units(scene)), nodes_(nodes_at(kNodeDistance)) {}

  ReferenceSolution solve() {
    best_ = solve(kFinest, 1);
    place_nodes_closer();
    note_interpolation();
    // Another partition of time finds other steps, and may find another event.
    const int parts = 6 * work_ < kMostWork ? 3 : 1;
    take_into_account(distances_from(solve(kJudges[0], 1)));
    take_into_account(distances_from(solve(kJudges[1], parts)));
    take_into_account(distances_in_steps());
    note_errors();
    return std::move(best_);
  }

 private:
  using Distances = std::vector<double>;  // by node, as far as they are known; they never fall

  Nodes nodes_at(double distance) const {
    const double own = duration_ * units_.time, bodies = static_cast<double>(scene_.bodies.size());
    const double afforded = kShareOfNodes * own * bodies / kMostWork;
    const double length = std::max(distance, std::min(afforded, kLongestNodeDistance));
    const long count = std::max(1L, static_cast<long>(std::ceil(own / length - 1e-9)));
    return {count, duration_ / static_cast<double>(count)};
  }

  // In `parts` steps from node to node. Ends early where the method warns, or when the work is more than is allowed.
  ReferenceSolution solve(const EventsWay& way, int parts) {
    EventsStepping stepping(scene_, way, units_);
    BodyTable state(scene_.bodies.size());
    stepping.start(state.columns());
    ReferenceSolution solution;
    solution.dimension = kRotation * state.size() + 1;
    add_node(solution, 0, std::as_const(state).columns());
    solution.complete = true;
    for (long n = 0; n < nodes_.count && solution.complete; ++n) {
      bool is_smooth = true;
      for (int k = 0; k < parts && solution.complete; ++k) {
        const double from = nodes_.at(n) + k * nodes_.length / parts;
        solution.complete = stepping.step(state.columns(), from, nodes_.length / parts);
        work_ = static_cast<double>(stepping.work()) * static_cast<double>(state.size());
        solution.complete = solution.complete && work_ <= kMostWork;
        is_smooth = is_smooth && stepping.was_smooth();
      }
      if (!solution.complete) break;
      solution.states.back() = is_smooth ? 1 : 0;
      add_node(solution, nodes_.at(n + 1), std::as_const(state).columns());
    }
    solution.ties = stepping.ties();
    return solution;
  }

  BodyColumns node(const ReferenceSolution& of, std::size_t n) const {
    const std::size_t bodies = scene_.bodies.size();
    return {&of.states[n * of.dimension], bodies, bodies, false};
  }

  // The distance of node n + 1 from the cubic between its two neighbours.
  double missed_by_cubic(std::size_t n) const {
    const auto is_smooth = [&](std::size_t k) { return best_.states[(k + 1) * best_.dimension - 1] == 1; };
    if (!is_smooth(n) || !is_smooth(n + 1)) return 0;
    const BodyColumns from = node(best_, n), middle = node(best_, n + 1), to = node(best_, n + 2);
    BodyTable cubic(from.size());
    for (std::size_t b = 0; b < from.size(); ++b)
      cubic.columns().set_body(b, between(from.body(b), to.body(b), 2 * nodes_.length, 0.5));
    return distance_between(std::as_const(cubic).columns(), middle);
  }

  // Half the distance leaves a sixteenth.
  Distances missed_between_nodes() const {
    Distances missed(best_.times.size(), 0);
    for (std::size_t n = 0; n + 2 < best_.times.size(); ++n) missed[n + 1] = missed_by_cubic(n) / 16;
    return missed;
  }

  void place_nodes_closer() {
    constexpr double kMostTimes = 8;
    const Distances missed = missed_between_nodes();
    const double most = *std::max_element(missed.begin(), missed.end());
    const double times = std::min(kMostTimes, std::ceil(std::pow(most / kInterpolation, 0.25)));
    if (!(times > 1) || !best_.complete || work_ * times > kMostWork) return;
    nodes_ = {nodes_.count * static_cast<long>(times), nodes_.length / times};
    best_ = solve(kFinest, 1);
  }

  void note_interpolation() {
    distances_ = missed_between_nodes();
    for (std::size_t n = 1; n < distances_.size(); ++n) distances_[n] = std::max(distances_[n], distances_[n - 1]);
  }

  Distances distances_from(const ReferenceSolution& other) const {
    Distances distances;
    double largest = 0;
    for (std::size_t n = 0; n < std::min(best_.times.size(), other.times.size()); ++n) {
      largest = std::max(largest, distance_between(node(best_, n), node(other, n)));
      distances.push_back(largest);
    }
    return distances;
  }

  // Both are of fourth order between events, and shorter steps err less: the shortest that can be had count.
  Distances distances_in_steps() {
    Distances best;
    for (int k = 0; k <= kMostHalvings; ++k) {
      Distances now = distances_from(solve(kInSteps, 1 << k));
      // An error that half the step does not reduce is no error of the step.
      const bool is_steady = k > 0 && now.size() <= best.size() && now.back() > 0.5 * best.back();
      const bool is_last = work_ > kMostWork || is_steady;
      if (k == 0 || reach(now, kUseful) > reach(best, kUseful) ||
          (now.size() >= best.size() && now.back() < best.back()))
        best = std::move(now);
      if (is_last || reach(best, kWantedEventsError / kSafety) >= best_.times.size()) break;
    }
    return best;
  }

  // How many nodes are within the error.
  static std::size_t reach(const Distances& distances, double error) {
    return static_cast<std::size_t>(std::upper_bound(distances.begin(), distances.end(), error) - distances.begin());
  }

  void take_into_account(const Distances& distances) {
    distances_.resize(std::min(distances_.size(), distances.size()));
    for (std::size_t n = 0; n < distances_.size(); ++n) distances_[n] = std::max(distances_[n], distances[n]);
  }

  void note_errors() {
    const double gap = kClosed * std::max(1.0, 1 / units_.length), drift = kStill * std::max(1.0, 1 / units_.length);
    const double tied = best_.ties.empty() ? duration_ : best_.ties.front().time;
    for (std::size_t n = 0; n < distances_.size(); ++n) {
      const auto t = static_cast<double>(best_.times[n]);
      const double error = kSafety * distances_[n] + gap + drift * t * units_.time;
      best_.error_times.push_back(t);
      best_.errors.push_back(t > tied ? std::max(error, kUnknown) : error);
    }
  }

  const Scene& scene_;
  double duration_;
  OwnUnits units_;
  Nodes nodes_;
  ReferenceSolution best_;
  Distances distances_;
  double work_ = 0;  // of the last solve()
};

}  // namespace

ReferenceSolution solve_events(const Scene& scene, double duration) { return Solver(scene, duration).solve(); }

void state_at(const ReferenceSolution& solution, const Scene& scene, double t, MutableBodyColumns out) {
  const auto next = std::upper_bound(solution.times.begin(), solution.times.end(), static_cast<long double>(t));
  const auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(next - solution.times.begin(), 1) - 1);
  const std::size_t bodies = scene.bodies.size();
  const auto node = [&](std::size_t n) {
    return BodyColumns(&solution.states[n * solution.dimension], bodies, bodies, false);
  };
  const BodyColumns from = node(i);
  const double after = t - static_cast<double>(solution.times[i]);
  if (i + 1 == solution.times.size() || !(after > 0)) {
    for (std::size_t b = 0; b < bodies; ++b) out.set_body(b, from.body(b));
    return;
  }
  const double h = static_cast<double>(solution.times[i + 1] - solution.times[i]);
  if (solution.states[(i + 1) * solution.dimension - 1] == 1) {
    for (std::size_t b = 0; b < bodies; ++b) out.set_body(b, between(from.body(b), node(i + 1).body(b), h, after / h));
    return;
  }
  EventsStepping stepping(scene, kFinest, own_units(scene));
  stepping.set(from);
  BodyTable state(bodies);
  stepping.step(state.columns(), static_cast<double>(solution.times[i]), after);
  for (std::size_t b = 0; b < bodies; ++b) out.set_body(b, std::as_const(state).columns().body(b));
}

}  // namespace rigor::inline truth
