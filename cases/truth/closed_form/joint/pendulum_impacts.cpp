// Balls on hinges or threads that swing to their lowest point and hit something there (pendulum_phase.h):
//   one ball and a wall   after n impacts sin(x_n/2) = e^n sin(x_0/2): what it leaves with, it comes back with
//   a cradle              equal balls in a row that touch, e = 1: what comes in at one end leaves at the other, half a
//                         period after it the other way round (Newton's cradle; Goldsmith, Impact, chapter 2)
// The first impact is a quarter period after it is let go, each of the next half a period of its swing later.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "cases/truth/closed_form/contact/plane_contact.h"
#include "cases/truth/closed_form/joint/swinging_body.h"
#include "cases/truth/closed_form/smooth/jacobi_elliptic.h"
#include "core/base/error.h"

namespace rigor::inline truth {
namespace {

constexpr const char* kImpactsAreFor =
    "balls let go on hinges or threads that hit a wall or each other where they hang";

[[noreturn]] void refuse_impacts(const std::string& why) {
  throw InputError(fmt::format("the truth 'pendulum-impacts' is for {}: {}", kImpactsAreFor, why));
}

// How one ball hangs: its angle x counts from its lowest point, about `axis`.
struct Hanging {
  ExtendedVec3 pivot = ExtendedVec3::Zero(), axis = ExtendedVec3::Zero(), down = ExtendedVec3::Zero();  // m; unit
  Extended length = 0;                                                                                  // m
  Extended square = 0;                                                                                  // 1/s², w0²
  Extended angle = 0;                                                                                   // rad, at t = 0
  bool turns = false;  // with x: it is on a hinge

  ExtendedVec3 side() const { return axis.cross(down); }
  ExtendedVec3 lowest() const { return pivot + length * down; }
};

class ImpactSwing final : public BodyMotion {
 public:
  struct Piece {
    Extended from;                       // s
    std::optional<PendulumPhase> phase;  // or it hangs still
    Extended start;                      // rad, the angle at which it begins
  };
  ImpactSwing(const Body& body, Hanging hanging, std::vector<Piece> pieces)
      : hanging_(std::move(hanging)), pieces_(std::move(pieces)), orientation_(extended(body.orientation)) {
    misses_ = (position(hanging_.angle) - extended(body.position)).norm();
  }

  ExtendedState at(Extended t) const override {
    const Piece& piece = pieces_[index_at(t)];
    Extended angle = piece.start, rate = 0;
    if (piece.phase) {
      const PendulumPhase::HalfTurn half = piece.phase->at(t - piece.from);
      angle += 2 * std::atan(half.sine / half.cosine), rate = half.rate;  // by less than half a turn
    }
    const ExtendedVec3 velocity =
        hanging_.length * rate * (std::cos(angle) * hanging_.side() - std::sin(angle) * hanging_.down);
    if (!hanging_.turns) return {position(angle), orientation_, velocity, ExtendedVec3::Zero()};
    return {position(angle), turn((angle - hanging_.angle) * hanging_.axis) * orientation_, velocity,
            rate * hanging_.axis};
  }

  // The error of the pieces' phases, and the rounding of the scene's numbers.
  double error(double t) const override {
    double sum = static_cast<double>(misses_) + kEpsilon * static_cast<double>(hanging_.pivot.norm());
    const std::size_t last = index_at(t);
    for (std::size_t i = 0; i <= last; ++i) {
      const Extended until = i == last ? t : pieces_[i + 1].from;
      if (pieces_[i].phase) sum += pieces_[i].phase->error(static_cast<double>(until - pieces_[i].from));
    }
    return (1 + static_cast<double>(hanging_.length)) * (sum + kEpsilon * (1 + t));
  }

 private:
  ExtendedVec3 position(Extended angle) const {
    return hanging_.pivot + hanging_.length * (std::cos(angle) * hanging_.down + std::sin(angle) * hanging_.side());
  }
  std::size_t index_at(Extended t) const {
    std::size_t i = 0;
    while (i + 1 < pieces_.size() && pieces_[i + 1].from <= t) ++i;
    return i;
  }

  Hanging hanging_;
  std::vector<Piece> pieces_;
  ExtendedQuat orientation_;
  Extended misses_;  // m
};

// The only joint on which a ball hangs from a fixed body.
const Joint& joint_of(const Scene& scene, int ball) {
  const Joint* own = nullptr;
  for (const Joint& joint : scene.joints) {
    if (joint.a != ball && joint.b != ball) continue;
    if (own) refuse_impacts(fmt::format("'{}' hangs on two joints", scene.body_name(ball)));
    own = &joint;
  }
  if (!own) refuse_impacts(fmt::format("'{}' hangs on nothing", scene.body_name(ball)));
  if (!stands(scene, own->a == ball ? own->b : own->a)) refuse_impacts("a joint is not to what stands still");
  return *own;
}

// Sets the pivot, and of a hinge the axis; returns the moment about it [kg m²] that turns with the angle.
Extended hang_up(const Scene& scene, int ball, Hanging& hanging) {
  const Joint& joint = joint_of(scene, ball);
  const Body& body = scene.bodies[ball];
  if (const auto* hinge = std::get_if<HingeJoint>(&joint.type)) {
    hanging.axis = extended(hinge->axis).normalized(), hanging.turns = true;
    if (std::abs(hanging.axis.dot(hanging.down)) > kTouching) refuse_impacts("a hinge's axis is not level");
    const ExtendedVec3 anchor = extended(hinge->anchor), n = extended(body.orientation).conjugate() * hanging.axis;
    hanging.pivot = anchor + hanging.axis.dot(extended(body.position) - anchor) * hanging.axis;
    return n.dot(extended(body.inertia) * n);
  }
  const auto* thread = std::get_if<DistanceJoint>(&joint.type);
  if (!thread) refuse_impacts("a joint is neither a hinge nor a distance joint");
  const bool is_a = joint.a == ball;
  if (!(is_a ? thread->point_a : thread->point_b).isZero(0))
    refuse_impacts("a thread does not hold its ball at its centre");
  hanging.pivot =
      is_a ? standing_point(scene, joint.b, thread->point_b) : standing_point(scene, joint.a, thread->point_a);
  return 0;
}

Hanging hanging_of(const Scene& scene, int ball) {
  const Body& body = scene.bodies[ball];
  if (!body.velocity.isZero(0) || !body.angular_velocity.isZero(0))
    refuse_impacts(fmt::format("'{}' is not let go from rest", body.name));
  const ExtendedVec3 g = extended(scene.gravity);
  if (g.isZero(0)) refuse_impacts("there is no gravity");
  Hanging hanging;
  hanging.down = g.normalized();
  const Extended moment = hang_up(scene, ball, hanging), mass = body.mass;
  const ExtendedVec3 arm = extended(body.position) - hanging.pivot, normal = hanging.down.cross(arm);
  hanging.length = arm.norm();
  // A thread leaves it to the arm in which plane it swings; one that hangs straight gets its neighbour's.
  if (!hanging.turns && normal.norm() > kTouching * hanging.length) hanging.axis = normal.normalized();
  hanging.square = mass * g.norm() * hanging.length / (moment + mass * hanging.length * hanging.length);
  hanging.angle = std::atan2(hanging.side().dot(arm), hanging.down.dot(arm));
  if (std::abs(hanging.angle) <= kTouching) hanging.angle = 0;
  return hanging;
}

// s: of a swing that reaches `angle`, from its lowest point to there.
Extended quarter_of(Extended angle, Extended square) {
  return quarter_period(std::abs(std::cos(angle / 2))) / std::sqrt(square);
}

Extended radius_of(const Scene& scene, int index) {
  const Body& body = scene.bodies[index];
  const auto* sphere = body.collides ? std::get_if<Sphere>(&*body.shape) : nullptr;
  if (!sphere) refuse_impacts(fmt::format("'{}' is no sphere that collides", body.name));
  return sphere->radius;
}

using Pieces = std::vector<ImpactSwing::Piece>;

// Checks that it reaches its lowest point from the free side of the wall, and touches the wall exactly there.
Pieces at_wall(const Scene& scene, int ball, int wall, const Hanging& hanging, double duration) {
  const auto* plane = std::get_if<Plane>(&*scene.bodies[wall].shape);
  if (!plane) refuse_impacts(fmt::format("'{}' is no plane", scene.bodies[wall].name));
  const ExtendedVec3 normal = extended(plane->normal).normalized();
  if (std::abs(normal.dot(hanging.lowest()) - Extended(plane->offset) - radius_of(scene, ball)) > kTouching)
    refuse_impacts("the ball does not touch the wall just where it hangs");
  if (normal.cross(hanging.side()).norm() > kTouching) refuse_impacts("the wall is not upright across its way");
  if (!(normal.dot(hanging.side()) * hanging.angle > 0)) refuse_impacts("the ball is not let go before the wall");
  const Extended e = scene.contact_law(ball, wall).restitution;
  Pieces pieces = {{0, PendulumPhase(hanging.angle, 0, hanging.square), hanging.angle}};
  Extended height = std::sin(std::abs(hanging.angle) / 2), time = quarter_of(hanging.angle, hanging.square);
  while (time < duration) {
    height *= e;
    if (!(height > 0)) {
      pieces.push_back({time, std::nullopt, 0});
      break;
    }
    const Extended rate = std::copysign(2 * std::sqrt(hanging.square) * height, hanging.angle);
    pieces.push_back({time, PendulumPhase(0, rate, hanging.square), 0});
    time += 2 * quarter_of(2 * std::asin(height), hanging.square);
  }
  return pieces;
}

// The balls in their order from the one that is raised; each entry its index in the scene.
std::vector<int> row_of(const Scene& scene, const std::vector<int>& balls, std::vector<Hanging>& hangings) {
  std::vector<int> row = balls;
  const auto raised = [&](int ball) { return hangings[ball].angle != 0; };
  if (std::count_if(balls.begin(), balls.end(), raised) != 1) refuse_impacts("not just one ball is raised");
  const int first = *std::find_if(balls.begin(), balls.end(), raised);
  const Hanging& lead = hangings[first];
  // Towards the others, which it swings to.
  const ExtendedVec3 onward = (lead.angle > 0 ? -1 : 1) * lead.side();
  for (const int ball : balls) hangings[ball].axis = lead.axis;
  std::sort(row.begin(), row.end(),
            [&](int a, int b) { return onward.dot(hangings[a].lowest()) < onward.dot(hangings[b].lowest()); });
  if (row.front() != first) refuse_impacts("the ball that is raised is not at the end of the row");
  for (std::size_t i = 0; i + 1 < row.size(); ++i) {
    const int a = row[i], b = row[i + 1];
    const ExtendedVec3 apart = hangings[b].lowest() - hangings[a].lowest();
    const Extended touching = radius_of(scene, a) + radius_of(scene, b);
    if ((apart - touching * onward).norm() > kTouching) refuse_impacts("the balls do not touch in one line");
    const bool alike = scene.bodies[a].mass == scene.bodies[b].mass &&
                       std::abs(hangings[a].square - hangings[b].square) <= kTouching * hangings[a].square;
    if (!alike || hangings[b].turns || hangings[a].turns) refuse_impacts("the balls are not alike, on threads");
    if (scene.contact_law(a, b).restitution != 1) refuse_impacts("balls in a row lose energy");
  }
  return row;
}

// The motion of the first and the last of the row; those between hang still.
std::pair<Pieces, Pieces> in_cradle(const Hanging& lead, double duration) {
  const Extended quarter = quarter_of(lead.angle, lead.square),
                 rate = std::copysign(2 * std::sqrt(lead.square) * std::sin(std::abs(lead.angle) / 2), lead.angle);
  Pieces first = {{0, PendulumPhase(lead.angle, 0, lead.square), lead.angle}}, last = {{0, std::nullopt, 0}};
  bool last_swings = true;
  for (Extended time = quarter; time < duration; time += 2 * quarter, last_swings = !last_swings) {
    first.push_back({time, std::nullopt, 0}), last.push_back({time, std::nullopt, 0});
    Pieces& moving = last_swings ? last : first;
    moving.back().phase.emplace(0, last_swings ? -rate : rate, lead.square);
  }
  return {first, last};
}

std::unique_ptr<Truth> make_pendulum_impacts(const Scene& scene, double duration) {
  check_needs(scene, "pendulum-impacts", kImpactsAreFor,
              {joint_feature<HingeJoint>(), joint_feature<DistanceJoint>(), Feature::joints_with_contacts,
               contact_feature<Plane, Sphere>(), contact_feature<Sphere, Sphere>(), Feature::restitution,
               Feature::friction_none});
  std::vector<int> balls, walls;
  std::vector<Hanging> hangings(scene.bodies.size());
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    const Body& body = scene.bodies[i];
    if (!body.fixed) balls.push_back(i), hangings[i] = hanging_of(scene, i);
    if (body.fixed && body.collides) walls.push_back(i);
  }
  std::vector<Pieces> pieces(scene.bodies.size(), {{0, std::nullopt, 0}});
  if (balls.size() == 1 && walls.size() == 1) {
    pieces[balls[0]] = at_wall(scene, balls[0], walls[0], hangings[balls[0]], duration);
  } else if (balls.size() > 1 && walls.empty()) {
    const std::vector<int> row = row_of(scene, balls, hangings);
    std::tie(pieces[row.front()], pieces[row.back()]) = in_cradle(hangings[row.front()], duration);
  } else {
    refuse_impacts(fmt::format("there are {} balls and {} walls", balls.size(), walls.size()));
  }
  return closed_form(scene, [&](const Body& body) {
    const auto i = static_cast<std::size_t>(&body - scene.bodies.data());
    return std::make_unique<ImpactSwing>(body, hangings[i], pieces[i]);
  });
}

}  // namespace

TruthRow pendulum_impacts_truth() {
  return {"pendulum-impacts", "a pendulum that hits a wall where it hangs, and Newton's cradle, in elliptic functions",
          make_pendulum_impacts};
}

}  // namespace rigor::inline truth
