#include "bench/scenes.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "adapters/engines.h"
#include "cases/analysis/repeats/reordered_scene.h"
#include "cases/case/suite.h"
#include "cases/cli/vocabulary.h"

namespace rigor::bench {
namespace {

Body body(int index, const Vec3& position) {
  Body b;
  b.name = "body " + std::to_string(index);
  b.mass = 1 + 0.1 * (index % 7);
  b.inertia = Vec3(0.1, 0.2, 0.25).asDiagonal();
  b.position = position;
  b.angular_velocity = {0.5 + 0.01 * (index % 11), -0.3, 0.2};
  return b;
}

// Tumbling bodies on their way, without gravity, so that nothing grows however long they are timed.
Scene free_bodies(const SceneRow&, int count) {
  Scene scene;
  scene.bodies.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    Body b = body(i, {0.5 * i, 0, 0});
    b.velocity = {0, 0.1 * (i % 5), 1};
    scene.bodies.push_back(b);
  }
  return scene;
}

void tie(Scene& scene, int a, int b, const Vec3& point_a, const Vec3& point_b, double rest_length) {
  Spring s;
  s.a = a, s.b = b, s.point_a = point_a, s.point_b = point_b;
  s.stiffness = 200, s.rest_length = rest_length;
  scene.springs.push_back(s);
}

constexpr double kSpacing = 0.5, kArm = 0.1;  // m

// Bodies in a row, each connected with the next off-centre, the ends with the world. Every other body starts displaced.
Scene spring_chain(const SceneRow&, int count) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  for (int i = 0; i < count; ++i) {
    Body b = body(i, {kSpacing * (i + 1), 0, 0});
    b.velocity = {0, i % 2 ? 0.2 : -0.2, 0};
    scene.bodies.push_back(b);
  }
  for (int i = -1; i < count; ++i) {
    const bool last = i + 1 == count;
    tie(scene, i, last ? kWorld : i + 1, i < 0 ? Vec3(kArm, 0, 0) : Vec3(kArm, 0, 0.02),
        last ? Vec3(kSpacing * (count + 1) - kArm, 0, 0) : Vec3(-kArm, 0, 0.02), kSpacing - 2 * kArm);
  }
  return scene;
}

// A square net: each body is connected with its four neighbours, the first and last rows with the world.
Scene spring_net(const SceneRow&, int count) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  const int side = static_cast<int>(std::lround(std::sqrt(count)));
  for (int i = 0; i < side * side; ++i) {
    Body b = body(i, {kSpacing * (i % side), kSpacing * (i / side), 0});
    b.velocity = {0, 0, i % 3 ? 0.2 : -0.4};
    scene.bodies.push_back(b);
  }
  const double rest = kSpacing - 2 * kArm;
  for (int i = 0; i < side * side; ++i) {
    const Vec3 p = scene.bodies[static_cast<std::size_t>(i)].position;
    if ((i + 1) % side) tie(scene, i, i + 1, {kArm, 0, 0.02}, {-kArm, 0, 0.02}, rest);
    if (i + side < side * side) tie(scene, i, i + side, {0, kArm, 0.02}, {0, -kArm, 0.02}, rest);
    if (i < side) tie(scene, kWorld, i, p - Vec3(0, kSpacing - kArm, 0), {0, -kArm, 0}, rest);
    if (i >= side * (side - 1)) tie(scene, i, kWorld, {0, kArm, 0}, p + Vec3(0, kSpacing - kArm, 0), rest);
  }
  return scene;
}

Body ground() {
  Body b;
  b.name = "ground";
  b.shape = Plane{Vec3::UnitZ(), 0};
  b.fixed = b.collides = true;
  return b;
}

Body ball(int index, double mass, const Vec3& position) {
  Body b = body(index, position);
  b.mass = mass;
  b.inertia = 0.4 * mass * 0.01 * Mat3::Identity();
  b.angular_velocity.setZero();
  b.shape = Sphere{0.1};
  b.collides = true;
  return b;
}

// Elastic spheres over the ground, in a square grid wide enough that they never meet; each starts at its own height.
Scene bouncing_spheres(const SceneRow&, int count) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  scene.contact_default = {1, kInfiniteFriction};
  const int side = static_cast<int>(std::ceil(std::sqrt(count)));
  for (int i = 0; i < count; ++i) {
    scene.bodies.push_back(ball(i, 1 + 0.1 * (i % 7), {0.5 * (i % side), 0.5 * (i / side), 0.3 + 0.05 * (i % 13)}));
  }
  scene.bodies.push_back(ground());
  return scene;
}

// A cube of spheres 1 cm apart, every one moved aside by up to 1 mm, falls onto the ground and becomes a pile.
Scene pile(const SceneRow&, int count) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  scene.contact_default = {0, 0.5};
  const int side = static_cast<int>(std::lround(std::cbrt(count)));
  for (int i = 0; i < count; ++i) {
    const int x = i % side, y = i / side % side, z = i / side / side;
    const Vec3 aside(0.001 * std::sin(1.0 * i), 0.001 * std::cos(2.0 * i), 0);
    scene.bodies.push_back(ball(i, 10, Vec3(0.21 * x, 0.21 * y, 0.1 + 0.21 * z) + aside));
  }
  scene.bodies.push_back(ground());
  return scene;
}

// The same cube of spheres over a hollow of 2,048 triangles with waves on its sides.
Scene balls_on_hills(const SceneRow& row, int count) {
  Scene scene = pile(row, count);
  Heightfield hills;
  hills.size = {6, 6};  // m
  constexpr std::size_t kRows = 33;
  for (std::size_t i = 0; i < kRows; ++i) {
    std::vector<double>& heights = hills.heights.emplace_back();
    for (std::size_t k = 0; k < kRows; ++k) {
      const double x = 6 * (static_cast<double>(k) / (kRows - 1) - 0.5),
                   y = 6 * (static_cast<double>(i) / (kRows - 1) - 0.5);
      heights.push_back(0.2 * (x * x + y * y) + 0.05 * std::sin(4 * x) * std::cos(5 * y));
    }
  }
  hills.surface = height_surface(hills.size, hills.heights);
  Body& ground = scene.bodies.back();
  ground.shape = hills, ground.position = {0.5, 0.5, -0.4};
  return scene;
}

// The same cube of other solids, all alike, turned in different ways.
Scene pile_of(const Shape& shape, const SceneRow& row, int count) {
  Scene scene = pile(row, count);
  for (Body& body : scene.bodies) {
    if (body.fixed) continue;
    body.shape = shape;
    body.inertia = inertia_of(shape, body.mass);
    body.orientation =
        rotation_by(Vec3(1.7, 0.9, -1.1) * std::sin(1.0 + static_cast<double>(&body - scene.bodies.data())));
    body.position *= 1.1;
  }
  return scene;
}

// Rocks with 32 corners.
Scene hulls(const SceneRow& row, int count) {
  std::vector<Vec3> corners;
  for (int k = 0; k < 32; ++k) {  // a spiral on the sphere, a little uneven
    const double z = 1 - (2 * k + 1) / 32.0, around = 2.399963 * k, r = std::sqrt(1 - z * z);
    corners.push_back((0.1 + 0.003 * std::sin(7.0 * k)) * Vec3(r * std::cos(around), r * std::sin(around), z));
  }
  return pile_of(Convex{hull_of(corners)}, row, count);
}

// Cubes, which no engine is told to be boxes.
Scene cube_hulls(const SceneRow& row, int count) {
  std::vector<Vec3> corners;
  for (int k = 0; k < 8; ++k) corners.push_back(0.06 * Vec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1));
  return pile_of(Convex{hull_of(corners)}, row, count);
}

Scene cylinders(const SceneRow& row, int count) { return pile_of(Cylinder{0.07, 0.14}, row, count); }

// A square pyramid of boxes, each layer one box narrower than the one below; 15 layers are 1,240 boxes.
Scene pyramid(const SceneRow&, int count) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  scene.contact_default = {0, 0.5};
  const double edge = 0.2;
  int base = 1;
  for (int boxes = 1; boxes < count; boxes += base * base) ++base;
  for (int layer = 0; layer < base; ++layer) {
    const int side = base - layer;
    for (int i = 0; i < side * side; ++i) {
      Body b = body(static_cast<int>(scene.bodies.size()),
                    {edge * (i % side - 0.5 * side), edge * (i / side - 0.5 * side), edge * (layer + 0.5)});
      b.mass = 8;
      b.shape = Box{Vec3::Constant(edge)};
      b.inertia = inertia_of(*b.shape, b.mass);
      b.angular_velocity.setZero();
      b.collides = true;
      scene.bodies.push_back(b);
    }
  }
  scene.bodies.push_back(ground());
  return scene;
}

Scene suite_scene(const std::string& id) {
  return select_cases({id}, default_suite_dir(), vocabulary_of(infos_of(engines()))).front().scene;
}

// A scene of the course, by its row's name.
Scene of_the_suite(const SceneRow& row, int) { return suite_scene(row.name); }

constexpr double kLink = 0.5;  // m

// A rod between two points, of uniform density.
Body rod(int index, const Vec3& from, const Vec3& to) {
  Body b = body(index, 0.5 * (from + to));
  b.mass = kLink;
  b.shape = Capsule{0.02, (to - from).norm() - 0.04};
  b.inertia = inertia_of(*b.shape, b.mass);
  b.orientation = Quat::FromTwoVectors(Vec3::UnitZ(), to - from);
  b.angular_velocity.setZero();
  return b;
}

// Rods on ball joints, hung from the world at 30° and let go.
Scene joint_chain(const SceneRow&, int count) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  const Vec3 along = kLink * Vec3(std::sin(0.5236), 0, -std::cos(0.5236));
  for (int i = 0; i < count; ++i) {
    scene.bodies.push_back(rod(i, i * along, (i + 1) * along));
    scene.joints.push_back({.a = i == 0 ? kWorld : i - 1, .b = i, .type = BallJoint{i * along}});
  }
  return scene;
}

// A square net of rods with a ball joint wherever they meet, hung aslant by its first row of knots and let go.
Scene rod_net(const SceneRow&, int count) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  const int side =
      static_cast<int>(std::lround((3 + std::sqrt(1.0 + 8 * count)) / 4));  // knots; (side - 1) (2 side - 1) rods
  const Vec3 down = kLink * Vec3(0, std::sin(0.3), -std::cos(0.3)), aside = kLink * Vec3::UnitX();
  std::vector<int> first(static_cast<std::size_t>(side * side), kWorld);  // the first rod at each knot
  const auto tie_to = [&](int knot, const Vec3& place, int index) {
    int& other = first[static_cast<std::size_t>(knot)];
    if (other != kWorld || knot < side) scene.joints.push_back({.a = other, .b = index, .type = BallJoint{place}});
    if (other == kWorld && knot >= side) other = index;
  };
  const auto add = [&](int from, int to) {
    const auto place = [&](int knot) { return Vec3((knot % side) * aside + (knot / side) * down); };
    const int index = static_cast<int>(scene.bodies.size());
    scene.bodies.push_back(rod(index, place(from), place(to)));
    tie_to(from, place(from), index), tie_to(to, place(to), index);
  };
  for (int knot = 0; knot < side * side; ++knot) {
    if (knot + side < side * side) add(knot, knot + side);
    if (knot >= side && (knot + 1) % side) add(knot, knot + 1);
  }
  return scene;
}

// Four-bar linkages side by side (IFToMM benchmark A02); each shares a crank with the next. They swing about hanging
// cranks and never come to lie in one line.
Scene four_bars(const SceneRow&, int count) {
  Scene scene;
  scene.gravity = {0, -9.81, 0};
  const int windows = (count - 1) / 2;
  const Vec3 crank(std::sin(0.5236), -std::cos(0.5236), 0), aside = Vec3::UnitX();
  const auto hinge = [&](int a, int b, const Vec3& at) {
    scene.joints.push_back({.a = a, .b = b, .type = HingeJoint{at, Vec3::UnitZ()}});
  };
  for (int i = 0; i <= windows; ++i) {
    scene.bodies.push_back(rod(i, i * aside, i * aside + crank));
    hinge(kWorld, i, i * aside);
  }
  for (int i = 0; i < windows; ++i) {
    const int bar = static_cast<int>(scene.bodies.size());
    scene.bodies.push_back(rod(bar, i * aside + crank, (i + 1) * aside + crank));
    hinge(i, bar, i * aside + crank), hinge(bar, i + 1, (i + 1) * aside + crank);
  }
  return scene;
}

// Arms of five links, each on a hinge with a servo, that hold out their rods and swing to other angles.
Scene servo_arms(const SceneRow&, int count) {
  constexpr int kLinks = 5;
  constexpr double kApart = 1;  // m
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  for (int i = 0; i < count; ++i) {
    const int link = i % kLinks;
    const Vec3 from = Vec3(0, kApart * (i / kLinks), 0) + link * kLink * Vec3::UnitX();
    scene.bodies.push_back(rod(i, from, from + kLink * Vec3::UnitX()));
    scene.joints.push_back({.a = link == 0 ? kWorld : i - 1, .b = i, .type = HingeJoint{from, Vec3::UnitY()}});
    Motor motor{.joint = i};
    motor.servo = Servo{.target = TimeTable::constant(0.1 + 0.05 * link), .kp = 60.0 - 10 * link, .kd = 1 - 0.1 * link};
    scene.motors.push_back(motor);
  }
  return scene;
}

// Copies of a case of the suite with `count` bodies in all, but those that are fixed. They stand apart, wider than one
// is tall.
Scene many_of(const std::string& id, int count) {
  const Scene one = suite_scene(id);
  const auto moving = std::count_if(one.bodies.begin(), one.bodies.end(), [](const Body& body) { return !body.fixed; });
  constexpr double kApart = 4;  // m
  return copied(one, static_cast<std::size_t>(count / moving), {0, kApart, 0}).scene;
}
// Each hangs by a hand.
Scene ragdolls(const SceneRow&, int count) { return many_of("mechanisms/ragdoll", count); }
// The same without springs and dampers, for engines that have none of their own.
Scene bare_ragdolls(const SceneRow& row, int count) {
  Scene scene = ragdolls(row, count);
  scene.springs.clear();
  return scene;
}
Scene humanoids(const SceneRow&, int count) { return many_of("robots/humanoid-falls", count); }
Scene quadrupeds(const SceneRow&, int count) { return many_of("robots/quadruped-stands", count); }

}  // namespace

const std::vector<SceneRow>& scenes() {
  constexpr double kFine = 1.0 / 240, kCourse = 1.0 / 30, kPile = 1.0 / 120;
  static const std::vector<SceneRow> table = {
      {"balls-on-hills", {216}, kPile, Reached::penetration, false, balls_on_hills},
      {"ballistic/projectile", {1}, kCourse, Reached::trajectory, false, of_the_suite},
      {"bare-ragdolls", {10, 1000}, kFine, Reached::joint_gap, false, bare_ragdolls},
      {"bouncing-spheres", {1, 100, 1000, 10000}, kFine, Reached::energy, false, bouncing_spheres},
      {"chain", {1, 10, 95, 100, 1000}, kFine, Reached::joint_gap, false, joint_chain},
      {"contact/collision", {1}, kCourse, Reached::energy, false, of_the_suite},
      {"cube-hulls", {216, 1000}, kPile, Reached::penetration, false, cube_hulls},
      {"cylinders", {216}, kPile, Reached::penetration, false, cylinders},
      {"four-bars", {21, 81}, kFine, Reached::joint_gap, false, four_bars},
      {"free-bodies", {1, 10, 100, 1000, 10000, 100000, 1000000}, kFine, Reached::trajectory, true, free_bodies},
      {"hulls", {216, 1000}, kPile, Reached::penetration, false, hulls},
      {"humanoids", {12, 1200}, kFine, Reached::gap_and_overlap, false, humanoids},
      {"pile", {216, 1000, 8000}, kPile, Reached::penetration, false, pile},
      {"pyramid", {1240}, kPile, Reached::penetration, false, pyramid},
      {"quadrupeds", {9, 900}, kFine, Reached::gap_and_overlap, false, quadrupeds},
      {"ragdolls", {10, 1000}, kFine, Reached::joint_gap, false, ragdolls},
      {"rod-net", {55, 171}, kFine, Reached::joint_gap, false, rod_net},
      {"servo-arms", {1000}, kFine, Reached::joint_gap, false, servo_arms},
      {"spring-chain", {1, 10, 100, 1000, 10000, 100000}, kFine, Reached::trajectory, false, spring_chain},
      {"spring-net", {100, 1024, 10000}, kFine, Reached::trajectory, false, spring_net},
      {"springs/body-springs", {2}, kCourse, Reached::trajectory, false, of_the_suite},
      {"springs/fixed-spring", {1}, kCourse, Reached::trajectory, false, of_the_suite},
  };
  return table;
}

const SceneRow& scene_row(const std::string& name) {
  return *std::find_if(scenes().begin(), scenes().end(), [&](const SceneRow& row) { return row.name == name; });
}

// So many that reading the clock does not count, so few that an interval of a slow engine lasts tens of milliseconds.
int steps_of_interval(const SceneRow& row, int count) {
  // A pile falls and comes to rest; a pyramid, whose steps are long, stands from the start.
  if (row.reached == Reached::penetration) return row.name == "pyramid" ? 60 : 240;
  // A robot falls and lands within 1.5 s.
  if (row.reached == Reached::gap_and_overlap) return 360;
  if (row.reached == Reached::joint_gap) return std::clamp(5000 / count, 12, 240);
  // Bouncing bodies need time to bounce: one second.
  const int fewest = row.reached == Reached::energy ? static_cast<int>(std::lround(1 / row.dt)) : 5;
  return std::clamp(50000 / count, fewest, 2000);
}

const Scene& scene_of(const SceneRow& row, int bodies) {
  static std::map<std::pair<std::string, int>, Scene> made;
  const auto [at, is_new] = made.try_emplace({row.name, bodies});
  if (is_new) at->second = row.make(row, bodies);
  return at->second;
}

}  // namespace rigor::bench
