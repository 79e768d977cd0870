// The limits of hinges and sliders, and motors of a given speed, at an instant:
//   a limit x <= upper   takes an effort of at most 0, and none where x < upper; what hits it leaves with x' = -e x'
//   a motor              keeps x' = speed as long as |effort| <= most, and else pushes by `most` towards it
// A linear complementarity problem decides which of them are active, for impulses at an impact and for efforts after
// it. Principal pivoting on the first violated row solves it (K. G. Murty, 1974).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/dynamics/joints/joints.h"
#include "core/dynamics/model/loads/loads.h"
#include "core/dynamics/model/wrench_columns.h"

namespace rigor::inline engine {
class StateArchive;
}

namespace rigor::inline dynamics {

class JointStops {
 public:
  // `motors` alone where limits are a contact method's, which then asks settle_motors() and not settle().
  enum class Of { limits_and_motors, motors };
  // All must outlive it. Efforts of motors that push are set in `loads`, which are those of the system.
  JointStops(const Scene& scene, const System& system, Loads& loads, Joints& joints, Of what = Of::limits_and_motors);

  static bool are_in(const Scene& scene);  // whether there is anything for it to do
  static bool has_speed_motors(const Scene& scene);
  static bool has_servos(const Scene& scene);

  // Takes x and x' from a state, `since` [s] after the last; x is in the turn nearest to where x' has led.
  void read(BodyColumns state, double since);
  void read_settled();  // the values at which settle() left them
  void archive_state(StateArchive& archive);

  // Handles one instant: impacts change velocities, then the active limits and motors are determined. A bounce that
  // would end within `shortest_flight` [s] is suppressed. Returns false if there is no consistent answer.
  bool settle(MutableBodyColumns state, double t, double shortest_flight);
  // Before an impact, in which no motor has a part, for its effort has a bound.
  void let_go(BodyColumns state);
  // Determines the active motors. `wrench` returns, for the motors currently tried, the wrench columns of all loads
  // except joint forces; it may be null. Returns false if there is no consistent answer.
  using Wrench = std::function<const double*()>;
  bool settle_motors(BodyColumns state, double t, const Wrench& wrench);

  // The distance of each possible event of a coordinate at the state read last; below zero until it happens.
  enum class Event { upper, lower, motor, servo };
  static constexpr Event kEvents[] = {Event::upper, Event::lower, Event::motor, Event::servo};
  std::size_t size() const { return stops_.size(); }
  double distance_to(std::size_t stop, Event event) const;
  // The rate of what has to turn for an event to have come and gone: of x, or of a servo's distance.
  double rate(std::size_t stop, Event event) const;
  // Whether x may have gone over a limit and come back between the last settled state and the one read after `since`,
  // or a servo's effort over its bound.
  bool may_have_touched(std::size_t stop, Event event, double since) const;
  // Whether distance_to() needs efforts, which note_efforts() takes from the state that was read last.
  bool needs_efforts() const;
  void note_efforts(BodyColumns state, double t);
  void note_efforts(BodyColumns state, const double* wrench);  // as settle_motors() has it
  // How far the motors are from a change at the state that was read last: negative beyond it.
  double margin_of_motors() const;

  // The first instant in (t, end) at which a motor of given speed begins or ends, or a servo samples or has a corner;
  // `end` if there is none.
  double next_switch(double t, double end) const;

 private:
  enum class Drive { off, pushing, keeping };
  struct Stop {
    std::size_t joint;
    JointCoordinate coordinate;
    double lower, upper, restitution;
    std::vector<Motor> motors;                  // of given speed
    double unit = 1;                            // rad or m: of the thresholds of x
    std::vector<ServoDrive>* servos = nullptr;  // the loads' own; null if there are none
    double x = 0, rate = 0;
    double settled_x = 0, settled_rate = 0;             // when settle() was called last
    double acceleration = 0, settled_acceleration = 0;  // of x, with servos
    double effort = 0;
    int at = 0;  // kept at its lower (-1) or upper (1) limit, or at none
    Drive drive = Drive::off;
    const Motor* motor = nullptr;  // acts now
    double push = 0;
    double bounce = 0;  // x' that the impact at hand is to leave
    double touched(int side) const;
  };
  double at_rest(const Stop& stop) const;
  double no_change(const Stop& stop) const;
  double as_effort(const Stop& stop, double force) const;  // N m of a hinge's effort, for a force [N]
  double no_effort(const Stop& stop) const;
  bool touches(const Stop& stop, int side) const;
  bool is_hit(const Stop& stop, int side) const;
  int hit_side(const Stop& stop) const;
  void choose_motors(double t);
  void apply(BodyColumns state);
  void hold(BodyColumns state, const double* wrench);
  bool resolve_impacts(MutableBodyColumns state, double t, double shortest_flight);
  bool take_away_short_flights(BodyColumns state, double t, double shortest_flight, const std::vector<int>& hit);
  bool find_impulses(MutableBodyColumns state);
  void guess_modes();
  bool find_modes(BodyColumns state, const Wrench& wrench);
  Wrench loads_at(BodyColumns state, double t);
  bool change_if_violated(Stop& stop, BodyColumns state);
  // Of the servo whose branch changes next.
  ServoDrive::Distance servo_distance(const Stop& stop, double x, double rate, double acceleration, double t) const;

  Joints& joints_;
  Loads& loads_;
  WrenchColumns wrenches_;
  std::vector<Stop> stops_;
  BodyTable before_, after_;
  double time_unit_ = 1;             // s
  double no_force_ = 0;              // N: a smaller effort may be a rounding
  double settled_at_ = 0, now_ = 0;  // s: of the states settled and read last
};

}  // namespace rigor::inline dynamics
