// Upper bounds of the accelerations of bodies at any instant of the time h between two states. They follow from the
// loads. The states alone do not show a motion that swings out and back between them.
//
// Every instant is at most h/2 from one of the states. With A and B the largest accelerations of a body's centre and of
// its rotation, a point at r from the centre moves by no more than
//   u = u_e + h/2 (A + (w² + B) r),   u_e the faster of the two states,
// so that a spring pulls with no more than k (x_e + h/2 u) + c u, x_e its longer extension in them. With F and T the
// sums of all forces and torques,
//   A <= F/m,   B <= (T + w² (I_max - I_min)/2) / I_min.
// A guess that these right sides do not exceed encloses the motion (Nedialkov, Jackson, Corliss, Validated solutions of
// initial value problems for ordinary differential equations, Appl. Math. Comput. 105, 1999, section 4). If there is
// none, h is too long for the stiffness of the springs: some 1.4 sqrt(m/k).
#pragma once

#include <vector>

#include "core/dynamics/model/system.h"

namespace rigor::inline dynamics {

struct AccelerationBound {
  double linear = 0;   // m/s², of the centre of mass
  double angular = 0;  // rad/s²
  double spin = 0;     // rad/s, of the angular velocity
  // m/s², of a point at `distance` [m] from the centre of mass.
  double of_point(double distance) const { return linear + (spin * spin + angular) * distance; }
};

// How much of a force and of a torque acts on a body at most.
struct Loading {
  double force = 0, torque = 0;  // N, N m
};

class AccelerationBounds {
 public:
  explicit AccelerationBounds(const System& system);

  // Bounds from one state at t to the other at t + h. No timed force begins or ends between them, and contacts load the
  // bodies by at most `contacts`, one for each body. Returns false if nothing is enclosed; the bounds are then only a
  // guess, and a shorter time may work.
  bool find(BodyColumns from, BodyColumns to, double t, double h, const std::vector<Loading>& contacts);
  const AccelerationBound& of(int body) const { return bounds_[body]; }

 private:
  using Bounds = std::vector<AccelerationBound>;
  struct Ends {
    BodyColumns from, to;
    double t, h;
  };

  void load_by_forces(const Ends& ends, const std::vector<Loading>& contacts);
  void load_by_springs(const Ends& ends, const Bounds& guess);
  double largest_spin(std::size_t body, const Ends& ends, double torque) const;
  void guess_twice(const Ends& ends);
  void apply(const Ends& ends, const Bounds& guess, Bounds& out);

  const System& system_;
  std::vector<Vec3> moments_;  // kg m², ascending; of each body
  std::vector<Loading> by_forces_, loading_;
  Bounds bounds_, guess_;
};

}  // namespace rigor::inline dynamics
