// An ellipsoid that rolls on a plane without slipping: the rattleback, or wobblestone. With r from its centre to the
// contact point, n the plane's normal, g the gravity against it and v = r x w, in two forms:
//   body rates:  (I - m [r]²) w' = -w x I w + m r x (r' x w + g n)                                     about the centre
//   momentum:    M' = m g r x n - m r' x v,  M = (I - m [r]²) w                                 about the contact point
// (Garcia and Hubbard, Spin reversal of the rattleback: theory and experiment, Proc. R. Soc. A 418, 1988; Goldstein,
// Classical Mechanics, 3rd ed., section 1.2, for the momentum about a moving point). The ellipsoid x = D² u/|D u| has
// its outward normal along u, with D the half-axes. The first form's distance from the second is the truth's error.
// Both share r and r', which the tests check: the contact stays closed and at rest, and the energy is kept. The truth
// ends where the plane would have to pull, or where friction would leave its cone.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

#include "cases/truth/provenance.h"
#include "cases/truth/solved/extrapolation.h"
#include "cases/truth/solved/smooth/solved_truth.h"
#include "core/base/error.h"
#include "core/scene/contact_laws.h"

namespace rigor {
namespace {

using namespace solving;

struct RollingScene {
  Scene scene;
  std::size_t body;  // that rolls
  Vec3 normal;       // of the plane, in W
  double gravity;    // m/s², against the normal
  double friction;
};

template <typename Real>
class RollingMotion {
 public:
  using State = std::vector<Real>;  // of the body: position, quaternion (w, x, y, z), and w_B or M
  using Vector = Eigen::Matrix<Real, 3, 1>;
  using Matrix = Eigen::Matrix<Real, 3, 3>;

  RollingMotion(const RollingScene& rolling, Formulation form)
      : rolling_(rolling),
        form_(form),
        inertia_(of().inertia.template cast<Real>()),
        squares_(std::get<Ellipsoid>(*of().shape).radii.cwiseAbs2().template cast<Real>()),
        normal_(rolling.normal.template cast<Real>()),
        mass_(of().mass),
        gravity_(rolling.gravity) {}

  State start() const {
    const Body& body = of();
    const Quat q = body.orientation.normalized();
    State state = {body.position.x(), body.position.y(), body.position.z(), q.w(), q.x(), q.y(), q.z(), 0, 0, 0};
    const Matrix R = rotation_of(state);
    const Vector w = body.angular_velocity.template cast<Real>(), r = contact(R.transpose() * normal_);
    const Vector w_B = R.transpose() * w;
    put(state, 7, form_ == Formulation::body_rates ? w_B : Vector(R * (about_contact(r) * w_B)));
    return state;
  }

  class Interval {
   public:
    explicit Interval(const RollingMotion& motion) : motion_(&motion) {}
    void operator()(const State& state, State& change, Real) { motion_->evaluate(state, change); }

   private:
    const RollingMotion* motion_;
  };
  Interval during(double) const { return Interval(*this); }

  template <typename Number>
  void write(const Number* numbers, MutableBodyColumns out) const {
    for (std::size_t i = 0; i < rolling_.scene.bodies.size(); ++i) {
      const Body& fixed = rolling_.scene.bodies[i];
      out.set_body(i, {fixed.position, fixed.orientation, Vec3::Zero(), Vec3::Zero()});
    }
    const State state(numbers, numbers + 10);
    const Matrix R = rotation_of(state);
    const Moving now = moving(state, R);
    const Quat q(static_cast<double>(state[3]), static_cast<double>(state[4]), static_cast<double>(state[5]),
                 static_cast<double>(state[6]));
    out.set_body(rolling_.body,
                 {get(state, 0).template cast<double>(), q.normalized(),
                  (R * now.r.cross(now.w)).template cast<double>(), (R * now.w).template cast<double>()});
  }

 private:
  // All in the body's frame.
  struct Moving {
    Vector up, r, w;  // the plane's normal; m, from the centre to the contact; rad/s
    Vector r_rate;    // m/s, of r as the body carries it
  };

  const Body& of() const { return rolling_.scene.bodies[rolling_.body]; }
  static Vector get(const State& state, int first) { return {state[first], state[first + 1], state[first + 2]}; }
  static void put(State& state, int first, const Vector& v) {
    for (int k = 0; k < 3; ++k) state[first + k] = v[k];
  }
  static Matrix rotation_of(const State& state) {
    return Eigen::Quaternion<Real>(state[3], state[4], state[5], state[6]).normalized().toRotationMatrix();
  }
  static Matrix cross(const Vector& v) {
    Matrix m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
  }

  Vector contact(const Vector& up) const {
    using std::sqrt;
    const Vector squared = squares_.cwiseProduct(up);
    return -squared / sqrt(up.dot(squared));
  }
  Matrix about_contact(const Vector& r) const {
    const Matrix across = cross(r);
    return inertia_ - mass_ * across * across;
  }

  Moving moving(const State& state, const Matrix& R) const {
    using std::sqrt;
    Moving now;
    now.up = R.transpose() * normal_, now.r = contact(now.up);
    const Vector own = get(state, 7);
    now.w = form_ == Formulation::body_rates ? own : Vector(about_contact(now.r).inverse() * (R.transpose() * own));
    const Vector up_rate = now.up.cross(now.w), squared = squares_.cwiseProduct(now.up);
    const Real length = sqrt(now.up.dot(squared)), length_rate = squared.dot(up_rate) / length;
    now.r_rate = -squares_.cwiseProduct(up_rate) / length - now.r * (length_rate / length) + now.w.cross(now.r);
    return now;
  }

  void evaluate(const State& state, State& change) const {
    const Matrix R = rotation_of(state);
    const Moving now = moving(state, R);
    const auto& [up, r, w, r_rate] = now;
    const Vector v = r.cross(w), weight = gravity_ * up;
    const Vector turning =
        about_contact(r).inverse() * (-w.cross(inertia_ * w) + mass_ * r.cross(Vector(r_rate.cross(w) + weight)));
    change.resize(state.size());
    put(change, 0, R * v);
    const Eigen::Quaternion<Real> q(state[3], state[4], state[5], state[6]),
        rate = q * Eigen::Quaternion<Real>(0, w.x() / 2, w.y() / 2, w.z() / 2);
    change[3] = rate.w(), change[4] = rate.x(), change[5] = rate.y(), change[6] = rate.z();
    put(change, 7,
        form_ == Formulation::body_rates ? turning : Vector(R * (mass_ * r.cross(weight) - mass_ * r_rate.cross(v))));
    const Vector force = r_rate.cross(w) + r.cross(turning) + weight;  // of the plane, for each kg
    const Real normal = up.dot(force), along = (force - normal * up).norm();
    const bool slips = rolling_.friction != kInfiniteFriction && along > static_cast<Real>(rolling_.friction) * normal;
    if (!(normal > 0) || slips) change[0] = std::numeric_limits<Real>::quiet_NaN();  // no solution goes on
  }

  RollingScene rolling_;
  Formulation form_;
  Matrix inertia_;  // kg m², about the centre, in B
  Vector squares_;  // m², of the half-axes
  Vector normal_;
  Real mass_, gravity_;
};

[[noreturn]] void refuse_rolling(const std::string& why) {
  throw InputError("the truth 'rolling-ellipsoid' is for one ellipsoid that rolls on a plane: " + why);
}

RollingScene rolling_scene(const Scene& scene) {
  std::optional<std::size_t> body;
  const Plane* plane = nullptr;
  int ground = kWorld;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& one = scene.bodies[i];
    if (one.fixed && one.shape && std::holds_alternative<Plane>(*one.shape) && one.collides && !plane) {
      plane = &std::get<Plane>(*one.shape), ground = static_cast<int>(i);
    } else if (!one.fixed && one.shape && std::holds_alternative<Ellipsoid>(*one.shape) && one.collides && !body) {
      body = i;
    } else {
      refuse_rolling(fmt::format("body '{}' is neither", one.name));
    }
  }
  if (!body || !plane) refuse_rolling(body ? "there is no plane" : "there is no ellipsoid");
  if (!scene.springs.empty() || !scene.forces.empty() || !scene.joints.empty())
    refuse_rolling("something else acts on it");
  const ContactLaw law = scene.contact_law(static_cast<int>(*body), ground);
  if (!law.collides || law.friction == 0 || law.is_soft() || law.resists_turning())
    refuse_rolling("friction has to hold it, without rolling friction or softness");
  const Vec3 &n = plane->normal, &g = scene.gravity;
  constexpr double kRoundings = 1e-12;  // some thousand, as a share
  if (!(-g.dot(n) > 0) || g.cross(n).norm() > kRoundings * g.norm()) refuse_rolling("gravity is not against the plane");
  const Body& of = scene.bodies[*body];
  const Ellipsoid& shape = std::get<Ellipsoid>(*of.shape);
  const Vec3 lowest = of.orientation * shape.support(of.orientation.conjugate() * -n);
  const double gap = n.dot(of.position + lowest) - plane->offset;
  if (std::abs(gap) > kRoundings * shape.radii.maxCoeff()) refuse_rolling(fmt::format("it starts {:.3g} m above", gap));
  const double slip = (of.velocity + of.angular_velocity.cross(lowest)).norm();
  if (slip > kRoundings * (of.velocity.norm() + of.angular_velocity.norm() * lowest.norm()))
    refuse_rolling(fmt::format("its contact point starts at {:.3g} m/s", slip));
  return {scene, *body, n, -g.dot(n), law.sticking_friction()};
}

// Tolerances and numbers of columns as in reference_solver.cpp, of which the second solution has others.
ReferenceSolution solve_rolling(const RollingScene& rolling, double duration) {
  using Extended = long double;
  const auto nodes = [&](Formulation form, int columns, double tolerance) {
    return solve(RollingMotion<Extended>(rolling, form), Extrapolation<Extended>(columns, tolerance), {0, duration},
                 kMostTries);
  };
  const auto in_double = [&](Formulation form) {
    return std::make_unique<InDouble<RollingMotion<double>>>(RollingMotion<double>(rolling, form));
  };
  Judged judged(in_double(Formulation::body_rates), rolling.scene.bodies.size(),
                nodes(Formulation::body_rates, 6, 4e-17));
  const auto other = in_double(Formulation::momentum);
  judged.compare([&](const double* state, MutableBodyColumns out) { other->write(state, out); },
                 nodes(Formulation::momentum, 7, 2e-16));
  return judged.solution();
}

}  // namespace

Provenance rolling_ellipsoid_provenance() {
  return {"rolling-ellipsoid", "solved twice from equations of rolling, independent of every engine and method"};
}

TruthRow rolling_ellipsoid_truth() {
  return {"rolling-ellipsoid", "an ellipsoid that rolls on a plane, solved twice in high precision",
          [](const Scene& scene, double duration) -> std::unique_ptr<Truth> {
            const RollingScene rolling = rolling_scene(scene);
            using Motion = RollingMotion<double>;
            return std::make_unique<SolvedTruth>(
                std::make_unique<InDouble<Motion>>(Motion(rolling, Formulation::body_rates)),
                solve_rolling(rolling, duration));
          }};
}

}  // namespace rigor
