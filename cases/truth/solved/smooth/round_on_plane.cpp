// A body that touches a plane at one point of a round surface, and rolls or slides there: rattleback, disk, tippe-top.
//   r, r'   from its centre of mass to the contact point, and the rate of that
//   n, g    the plane's normal, and the gravity against it
//   F       the plane's force for each kg
// Its rotation is solved in two forms, of which the first one's distance from the second is the truth's error:
//   body rates:  I w' = -w x I w + m r x F                                              about the centre
//   momentum:    M' = m g r x n - m r' x v,  M = I w - m r x v                          about the contact point
// (Goldstein, Classical Mechanics, 3rd ed., section 1.2, for the momentum about a moving point). A body that rolls has
// v = r x w, which gives F and turns I into I - m [r]² (Garcia and Hubbard, Spin reversal of the rattleback: theory and
// experiment, Proc. R. Soc. A 418, 1988). A body that slides has F = N (n - mu u/|u|) with the slip u = v + w x r. Its
// N follows from n . (v' + w' x r + w x r') = 0.
//
// The surface x = c + G u/sqrt(u . G u) has its outward normal along u. With G = A Aᵀ and the half-axes A it is an
// ellipsoid about c; without a third half-axis, the rim of a disk.
//
// Both forms share r, r' and N. The tests check these: the contact stays closed, a body that rolls keeps its energy and
// stays at rest there, a ball that slides keeps Jellett's integral and loses what friction takes. The truth ends where
// the plane would have to pull, where friction would leave its cone, and where a slip ends.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "cases/truth/provenance.h"
#include "cases/truth/solved/extrapolation.h"
#include "cases/truth/solved/smooth/solved_truth.h"
#include "core/base/error.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline truth {
namespace {

using namespace solving;

// x = centre + squares u/sqrt(u . squares u), of the outward normal u; in B.
struct RoundSurface {
  Vec3 centre;   // m
  Mat3 squares;  // m²

  Vec3 lowest(const Vec3& up) const { return centre - squares * up / std::sqrt(up.dot(squares * up)); }
};

struct RoundScene {
  Scene scene;
  std::size_t body;  // on the plane
  RoundSurface surface;
  Vec3 normal;     // of the plane, in W
  double gravity;  // m/s², against the normal
  bool slides;     // else it rolls
  double friction;
};

template <typename Real>
class RoundMotion {
 public:
  // Of the body: position, quaternion (w, x, y, z), w_B or M, and the velocity, which what rolls has not.
  using State = std::vector<Real>;
  using Vector = Eigen::Matrix<Real, 3, 1>;
  using Matrix = Eigen::Matrix<Real, 3, 3>;

  RoundMotion(const RoundScene& round, Formulation form)
      : round_(round),
        form_(form),
        inertia_(of().inertia.template cast<Real>()),
        to_turning_(inertia_.inverse()),
        squares_(round.surface.squares.template cast<Real>()),
        middle_(round.surface.centre.template cast<Real>()),
        normal_(round.normal.template cast<Real>()),
        mass_(of().mass),
        gravity_(round.gravity),
        friction_(round.friction) {}

  State start() const {
    const Body& body = of();
    const Quat q = body.orientation.normalized();
    State state = {body.position.x(), body.position.y(), body.position.z(), q.w(), q.x(), q.y(), q.z(), 0, 0, 0};
    state.resize(size());
    const Matrix R = rotation_of(state);
    const Vector w = R.transpose() * body.angular_velocity.template cast<Real>(),
                 r = contact(R.transpose() * normal_).at;
    const Vector v = round_.slides ? Vector(R.transpose() * body.velocity.template cast<Real>()) : Vector(r.cross(w));
    const bool is_turning = form_ == Formulation::body_rates;
    put(state, kTurning, is_turning ? w : Vector(R * (inertia_ * w - mass_ * r.cross(v))));
    if (round_.slides) put(state, kVelocity, R * v);
    return state;
  }

  class Interval {
   public:
    explicit Interval(const RoundMotion& motion) : motion_(&motion) {}
    void operator()(const State& state, State& change, Real) { motion_->evaluate(state, change); }

   private:
    const RoundMotion* motion_;
  };
  Interval during(double) const { return Interval(*this); }

  template <typename Number>
  void write(const Number* numbers, MutableBodyColumns out) const {
    for (std::size_t i = 0; i < round_.scene.bodies.size(); ++i) {
      const Body& fixed = round_.scene.bodies[i];
      out.set_body(i, {fixed.position, fixed.orientation, Vec3::Zero(), Vec3::Zero()});
    }
    const State state(numbers, numbers + size());
    const Matrix R = rotation_of(state);
    const Moving now = moving(state, R);
    const Quat q(static_cast<double>(state[3]), static_cast<double>(state[4]), static_cast<double>(state[5]),
                 static_cast<double>(state[6]));
    out.set_body(round_.body, {get(state, 0).template cast<double>(), q.normalized(),
                               (R * now.v).template cast<double>(), (R * now.w).template cast<double>()});
  }

 private:
  static constexpr int kTurning = 7, kVelocity = 10;

  struct Contact {
    Vector at, down;  // m, from the centre of mass, and from the surface's own
    Real length;      // m: sqrt(u . G u)
  };
  // All in the body's frame.
  struct Moving {
    Vector up, r, v, w;  // the plane's normal; m, to the contact; m/s, rad/s
    Vector r_rate;       // m/s, of r in W
  };
  struct Forced {
    Vector turning, push;  // rad/s², N/kg: w' and the plane's force
  };

  const Body& of() const { return round_.scene.bodies[round_.body]; }
  std::size_t size() const { return round_.slides ? kVelocity + 3 : kVelocity; }
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

  Contact contact(const Vector& up) const {
    using std::sqrt;
    const Vector squared = squares_ * up;
    const Real length = sqrt(up.dot(squared));
    return {middle_ - squared / length, -squared / length, length};
  }
  Matrix about_contact(const Vector& r) const {
    const Matrix across = cross(r);
    return inertia_ - mass_ * across * across;
  }

  Moving moving(const State& state, const Matrix& R) const {
    Moving now;
    now.up = R.transpose() * normal_;
    const Contact touch = contact(now.up);
    now.r = touch.at;
    const Vector own = get(state, kTurning);
    if (round_.slides) now.v = R.transpose() * get(state, kVelocity);
    if (form_ == Formulation::body_rates)
      now.w = own;
    else if (round_.slides)
      now.w = to_turning_ * (R.transpose() * own + mass_ * now.r.cross(now.v));
    else
      now.w = about_contact(now.r).inverse() * (R.transpose() * own);
    if (!round_.slides) now.v = now.r.cross(now.w);
    const Vector up_rate = now.up.cross(now.w);
    const Real length_rate = (squares_ * now.up).dot(up_rate) / touch.length;
    now.r_rate = -(squares_ * up_rate + touch.down * length_rate) / touch.length + now.w.cross(now.r);
    return now;
  }

  Forced rolls(const Moving& now) const {
    const auto& [up, r, v, w, r_rate] = now;
    const Vector weight = gravity_ * up;
    const Vector turning =
        about_contact(r).inverse() * (-w.cross(inertia_ * w) + mass_ * r.cross(Vector(r_rate.cross(w) + weight)));
    const Vector push = r_rate.cross(w) + r.cross(turning) + weight;
    const Real normal = up.dot(push), along = (push - normal * up).norm();
    const bool slips = round_.friction != kInfiniteFriction && along > friction_ * normal;
    return {turning, normal > 0 && !slips ? push : no_push()};
  }

  Forced slides(const Moving& now) const {
    constexpr double kStopped = 1e-9;  // of the speed of the contact point on the body
    const auto& [up, r, v, w, r_rate] = now;
    const Vector carried = w.cross(r), slip = v + carried;
    const Real speed = slip.norm();
    const Vector along = up - friction_ * slip / speed, of_push = mass_ * (to_turning_ * r.cross(along)),
                 freely = to_turning_ * -w.cross(inertia_ * w);
    const Real response = 1 + up.dot(of_push.cross(r)),
               normal = (gravity_ - up.dot(freely.cross(r) + w.cross(r_rate))) / response;
    const bool goes_on = normal > 0 && response > 0 && speed > kStopped * carried.norm();
    return {freely + normal * of_push, goes_on ? Vector(normal * along) : no_push()};
  }

  // No solution goes on from there.
  static Vector no_push() { return Vector::Constant(std::numeric_limits<Real>::quiet_NaN()); }

  void evaluate(const State& state, State& change) const {
    const Matrix R = rotation_of(state);
    const Moving now = moving(state, R);
    const auto& [up, r, v, w, r_rate] = now;
    const Forced forced = round_.slides ? slides(now) : rolls(now);
    change.resize(state.size());
    put(change, 0, R * v);
    const Eigen::Quaternion<Real> q(state[3], state[4], state[5], state[6]),
        rate = q * Eigen::Quaternion<Real>(0, w.x() / 2, w.y() / 2, w.z() / 2);
    change[3] = rate.w(), change[4] = rate.x(), change[5] = rate.y(), change[6] = rate.z();
    put(change, kTurning,
        form_ == Formulation::body_rates
            ? forced.turning
            : Vector(R * (mass_ * r.cross(Vector(gravity_ * up)) - mass_ * r_rate.cross(v))));
    if (round_.slides) put(change, kVelocity, R * (forced.push - gravity_ * up));
    if (!forced.push.allFinite()) change[0] = std::numeric_limits<Real>::quiet_NaN();
  }

  RoundScene round_;
  Formulation form_;
  Matrix inertia_, to_turning_;  // kg m², about the centre of mass, in B; and its inverse
  Matrix squares_;               // m²
  Vector middle_;                // m, of the surface
  Vector normal_;
  Real mass_, gravity_, friction_;
};

[[noreturn]] void refuse_round(const std::string& why) {
  throw InputError("the truth 'round-on-plane' is for one ellipsoid, ball or cylinder on a plane: " + why);
}

// `up`: the plane's normal in the part's frame.
struct SurfaceOf {
  Vec3 up;

  std::optional<RoundSurface> operator()(const Ellipsoid& ellipsoid) const {
    return RoundSurface{Vec3::Zero(), ellipsoid.radii.cwiseAbs2().asDiagonal()};
  }
  std::optional<RoundSurface> operator()(const Sphere& sphere) const {
    return (*this)(Ellipsoid{Vec3::Constant(sphere.radius)});
  }
  // The rim that is lower.
  std::optional<RoundSurface> operator()(const Cylinder& cylinder) const {
    constexpr double kFlat = 1e-9;  // the sine of the tilt of an end or a side that lies on the plane
    if (std::hypot(up.x(), up.y()) < kFlat) refuse_round("its end lies flat");
    if (std::abs(up.z()) < kFlat) refuse_round("it lies on its side");
    const double square = cylinder.radius * cylinder.radius;
    return RoundSurface{{0, 0, std::copysign(0.5 * cylinder.length, -up.z())}, Vec3(square, square, 0).asDiagonal()};
  }
  template <typename Other>
  std::optional<RoundSurface> operator()(const Other&) const {
    return {};
  }
};

std::optional<RoundSurface> surface_of(const Body& body, const Vec3& up_W) {
  PlacedShape part{*body.shape, {}};
  if (const auto* compound = std::get_if<Compound>(&*body.shape)) {
    if (compound->parts.size() != 1) return {};
    part = compound->parts[0];
  }
  const Quat to_part = part.pose.orientation.conjugate() * body.orientation.conjugate();
  std::optional<RoundSurface> surface = std::visit(SurfaceOf{to_part * up_W}, part.shape);
  if (!surface) return {};
  const Mat3 R = part.pose.orientation.toRotationMatrix();
  return RoundSurface{part.pose.position + R * surface->centre, R * surface->squares * R.transpose()};
}

RoundScene round_scene(const Scene& scene) {
  std::optional<std::size_t> body;
  const Plane* plane = nullptr;
  int ground = kWorld;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& one = scene.bodies[i];
    if (one.fixed && one.shape && std::holds_alternative<Plane>(*one.shape) && one.collides && !plane) {
      plane = &std::get<Plane>(*one.shape), ground = static_cast<int>(i);
    } else if (!one.fixed && one.shape && one.collides && !body) {
      body = i;
    } else {
      refuse_round(fmt::format("body '{}' is neither", one.name));
    }
  }
  if (!body || !plane) refuse_round(body ? "there is no plane" : "there is no body on it");
  if (!scene.springs.empty() || !scene.forces.empty() || !scene.joints.empty())
    refuse_round("something else acts on it");
  const ContactLaw law = scene.contact_law(static_cast<int>(*body), ground);
  if (!law.collides || law.is_soft() || law.resists_turning())
    refuse_round("they have to touch, without rolling friction or softness");
  const Vec3 &n = plane->normal, &g = scene.gravity;
  constexpr double kRoundings = 1e-12;  // some thousand, as a share
  if (!(-g.dot(n) > 0) || g.cross(n).norm() > kRoundings * g.norm()) refuse_round("gravity is not against the plane");
  const Body& of = scene.bodies[*body];
  const std::optional<RoundSurface> surface = surface_of(of, n);
  if (!surface) refuse_round(fmt::format("body '{}' has another shape", of.name));
  const Vec3 lowest = of.orientation * surface->lowest(of.orientation.conjugate() * n);
  const double gap = n.dot(of.position + lowest) - plane->offset, size = bounding_radius(*of.shape);
  if (std::abs(gap) > kRoundings * size) refuse_round(fmt::format("it starts {:.3g} m above", gap));
  const Vec3 slip = of.velocity + of.angular_velocity.cross(lowest);
  const double roundings = kRoundings * (of.velocity.norm() + of.angular_velocity.norm() * lowest.norm()),
               rises = n.dot(slip);
  if (std::abs(rises) > roundings) refuse_round(fmt::format("its contact point starts upwards at {:.3g} m/s", rises));
  constexpr double kSlides = 1e6;  // roundings: a slip below that is meant to be none
  const bool slides = slip.norm() > roundings;
  if (slides && slip.norm() < kSlides * roundings)
    refuse_round(fmt::format("its contact point starts at {:.3g} m/s, too little to slide", slip.norm()));
  if (slides && law.friction == kInfiniteFriction)
    refuse_round(fmt::format("its contact point starts at {:.3g} m/s, under infinite friction", slip.norm()));
  if (!slides && law.friction == 0) refuse_round("it starts without slip, and friction has to hold it");
  return {scene, *body, *surface, n, -g.dot(n), slides, slides ? law.friction : law.sticking_friction()};
}

// Tolerances and numbers of columns as in reference_solver.cpp, of which the second solution has others.
ReferenceSolution solve_round(const RoundScene& round, double duration) {
  using Extended = long double;
  const auto nodes = [&](Formulation form, int columns, double tolerance) {
    return solve(RoundMotion<Extended>(round, form), Extrapolation<Extended>(columns, tolerance), {0, duration},
                 kMostTries);
  };
  const auto in_double = [&](Formulation form) {
    return std::make_unique<InDouble<RoundMotion<double>>>(RoundMotion<double>(round, form));
  };
  Judged judged(in_double(Formulation::body_rates), round.scene.bodies.size(),
                nodes(Formulation::body_rates, 6, 4e-17));
  const auto other = in_double(Formulation::momentum);
  judged.compare([&](const double* state, MutableBodyColumns out) { other->write(state, out); },
                 nodes(Formulation::momentum, 7, 2e-16));
  return judged.solution();
}

}  // namespace

Provenance round_on_plane_provenance() {
  return {"round-on-plane",
          "solved twice from equations of rolling or sliding, independent of every engine and method"};
}

TruthRow round_on_plane_truth() {
  return {"round-on-plane", "a round body that rolls or slides on a plane, solved twice in high precision",
          [](const Scene& scene, double duration) -> std::unique_ptr<Truth> {
            const RoundScene round = round_scene(scene);
            using Motion = RoundMotion<double>;
            return std::make_unique<SolvedTruth>(
                std::make_unique<InDouble<Motion>>(Motion(round, Formulation::body_rates)),
                solve_round(round, duration));
          }};
}

}  // namespace rigor::inline truth
