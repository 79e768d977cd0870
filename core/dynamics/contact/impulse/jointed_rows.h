// Contact constraints, limits of joints and motors of given speed as rows of sequential impulses, for jointed bodies.
// An impulse of a row acts through the joints. V are the velocities and W = (1 - M⁻¹ Jᵀ S⁻¹ J) M⁻¹ the inverse masses
// that the joints leave. The impulse changes V by W rowᵀ p, for all bodies that are connected to the row's two. The
// velocities thus satisfy the joints after each single impulse, and a row's effective mass is that of the mechanism.
// W rowᵀ and the mass are worked out where a row first acts: a robot has many limits, and few joints are at one.
#pragma once

#include <vector>

#include "core/dynamics/contact/impulse/coulomb_disc.h"
#include "core/dynamics/contact/impulse/manifolds.h"
#include "core/dynamics/joints/impulse_responses.h"
#include "core/dynamics/kernels/contact_rows.h"

namespace rigor::inline dynamics {

class JointedRows {
 public:
  JointedRows(const Scene& scene, const System& system, Joints& joints);

  // Rows for these contacts, and for limits and motors, at a pose; impulses times `impulse_scale`.
  void assign(BodyColumns state, const std::vector<ContactConstraint>& contacts, double impulse_scale);
  void store_impulses(std::vector<ContactConstraint>& contacts);
  // Adds the impulse of the sub-step at each contact, on its body a [N s, in W].
  void add_impulses(Vec3* impulses) const;

  // Gaps, approach speeds and biases of a sub-step that begins at t with `state`.
  void prepare(BodyColumns state, double t, const SolverParameters& parameters);
  void load_velocities(BodyColumns state);
  void warm_start();
  void solve_with_bias();
  void relax();
  // No further than the energy of the loaded velocities.
  void apply_restitution(BodyColumns state);
  // The change of a body's velocity (v, w) since load_velocities().
  Vec6 change(std::size_t body) const { return velocities_[place_[body]] - loaded_[body]; }
  // Of limits and motors. Impulses of contacts are among the contacts that they were stored to.
  template <typename Archive>
  void archive_state(Archive& archive) {
    archive.each(coordinates_, [&](Coordinate& at) {
      archive(at.x, at.lower_impulse, at.upper_impulse, at.motor_impulse, at.speed, at.most_impulse);
    });
  }

 private:
  struct Span {  // of velocities_: the bodies that joints connect with one, or that one alone
    std::size_t first = 0, count = 0;
  };
  struct Row {
    int body[2] = {kWorld, kWorld};
    int directions = 1;  // a normal alone, or with two tangents
    Vec6 J[3][2] = {{Vec6::Zero(), Vec6::Zero()},
                    {Vec6::Zero(), Vec6::Zero()},
                    {Vec6::Zero(), Vec6::Zero()}};  // the wrench of a unit impulse on each body
    Vec3 arm_B[2] = {Vec3::Zero(), Vec3::Zero()};   // m, of a contact, in the bodies' frames
    Vec3 normal = Vec3::Zero(),
         apart = Vec3::Zero();  // of a contact: unit; m, from b's point to a's when contacts were updated
    double initial_gap = 0, friction = 0, restitution = 0;
    bool turns = false;  // an angle
    bool is_motor = false;
    bool is_known = false;          // what follows, up to the tangents' mass
    Span moved[2] = {};             // by its impulses
    std::size_t responses = 0;      // the first of those of direction 0; the others' follow
    double mass = 0;                // kg, along the normal; kg m² for an angle
    double lever = 1;               // m per rad for an angle: thresholds are speeds and lengths
    TangentMass tangent_mass = {};  // kg
    double gap = 0, approach = 0, bias = 0;
    double impulse[3] = {};
    double without_restitution[3] = {};
    bool is_impact = false;
  };
  struct Coordinate {  // of a joint: its rows follow the contacts' ones
    JointCoordinate coordinate;
    double lower, upper, restitution;
    std::vector<Motor> motors;
    double x = 0, lower_impulse = 0, upper_impulse = 0, motor_impulse = 0;
    double speed = 0, most_impulse = 0;  // of the motor that acts now
    std::size_t first_row = 0;           // lower, upper, motor
  };

  Row contact_row(BodyColumns state, const ContactConstraint& contact) const;
  Row coordinate_row(const JointCoordinate& coordinate, const JointCoordinate::Value& at, double sign,
                     double restitution) const;
  bool may_act(const Row& row) const;

  // jointed_row_masses.cpp
  void place_bodies();
  Span span_of(int body) const;
  void factorise();
  void know(Row& row);
  void find_masses(Row& row) const;
  double lever_of(const Row& row) const;

  double speed(const Row& row, int direction) const;  // of the row
  void apply(const Row& row, int direction, double impulse);
  void solve_normal(Row& row, double impulse);
  void solve_friction(Row& row);
  // Whether it rests or overlaps; a fast contact does not count, even if it is closed.
  bool is_soft(const Row& row) const {
    return row.is_known && row.lever * row.gap <= parameters_.touching &&
           row.lever * row.approach <= parameters_.restitution_threshold;
  }
  double bias_of(const Row& row) const;
  void solve_biased(Row& row);
  void solve_motors();
  template <typename Visit>
  void for_each_one_sided(const Visit& visit);
  template <typename Solve>
  void sweep_impacts(const Solve& solve);
  std::vector<Vec6> by_body() const;
  double contact_gap(const Row& row, BodyColumns state) const;
  void prepare_coordinate(Coordinate& coordinate, BodyColumns state, double t);

  const System& system_;
  Joints& joints_;
  std::vector<Row> rows_;
  BodyTable pose_;               // of the rows
  bool is_factor_here_ = false;  // whether the joints' last factor is of that pose
  ImpulseResponses through_joints_;
  std::vector<Vec6> responses_;  // of the bodies in a row's spans, to a unit impulse of one of its directions
  std::size_t contacts_ = 0;     // rows
  std::vector<Coordinate> coordinates_;
  std::vector<std::size_t> place_;         // by body, among the velocities: those in one component stand together
  std::vector<Vec6> velocities_, loaded_;  // by place; by body
  std::vector<Span> of_component_;
  bool are_restitutions_ = false;
  double energy_before_ = 0;      // twice that of the loaded velocities, J
  double restitution_share_ = 1;  // of the impulses of restitution, that their energy allows
  SolverParameters parameters_{};
};

}  // namespace rigor::inline dynamics
