#include "tests/relations/random.h"
#include "tests/relations/scenes.h"

#include <numbers>

#include "tests/cases/truth/closed_form/contact/contact_scenes.h"

namespace rigor::test {
namespace {

Shape any_shape(Random& random) {
  const double kind = 3 * random.share();
  Shape shape = Sphere{random.between(0.1, 0.2)};
  if (kind > 1) shape = Box{{random.between(0.2, 0.4), random.between(0.2, 0.4), random.between(0.2, 0.4)}};
  if (kind > 2) shape = Capsule{random.between(0.08, 0.15), random.between(0.1, 0.3)};
  return shape;
}

Body thrown(Random& random, int i, const Shape& shape) {
  const Vec3 place = random.vector(0.7);
  Body body = on_its_own("b" + std::to_string(i), shape, random.between(0.5, 4), place);
  body.position.z() = 0.5 + 0.75 * i + random.between(0, 0.2);
  body.orientation = random.turn();
  body.velocity = random.vector(1.5), body.angular_velocity = random.vector(2.5);
  return body;
}

void add_plane(Scene& scene, Random& random) {
  const double y = random.between(-0.2, 0.2), x = random.between(-0.2, 0.2);
  scene.bodies.push_back(plane(Vec3(x, y, 1)));
}

ContactLaw any_law(Random& random) {
  const double restitution = random.one_of<double>({0, 0, 0.3, 0.6, 0.9, 1});
  return {restitution, random.one_of<double>({0, 0.2, 0.5, 0.9})};
}

template <typename ShapeOf>
Scene above_plane(Random& random, int count, const ShapeOf& shape_of) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  for (int i = 0; i < count; ++i) scene.bodies.push_back(thrown(random, i, shape_of(i)));
  add_plane(scene, random);
  scene.contact_default = any_law(random);
  return scene;
}

}  // namespace

Scene bodies_on_plane(unsigned seed) {
  Random random(seed);
  const int count = 1 + random.below(4);
  return above_plane(random, count, [&](int) { return any_shape(random); });
}

Scene cylinder_on_plane(unsigned seed) {
  Random random(seed);
  const int count = 1 + random.below(3), cylinder = random.below(count);
  return above_plane(random, count, [&](int i) {
    Shape shape = Sphere{random.between(0.1, 0.2)};
    if (i == cylinder) shape = Cylinder{random.between(0.1, 0.2), random.between(0.1, 0.4)};
    return shape;
  });
}

Scene bodies_in_flight(unsigned seed) {
  Random random(seed);
  Scene scene;
  scene.gravity = random.chance(0.5) ? Vec3::Zero() : random.vector(5);
  const int count = 2 + random.below(3);
  const Vec3 along = random.direction(), together = random.vector(1);
  for (int i = 0; i < count; ++i) {
    Body body = thrown(random, i, any_shape(random));
    body.position = 0.8 * i * along + random.vector(0.1);
    body.velocity = together - 1.5 * i * along + random.vector(0.3);
    scene.bodies.push_back(body);
  }
  scene.contact_default = random.chance(0.5) ? ContactLaw{1, 0} : any_law(random);
  return scene;
}

Scene line_contact(unsigned seed) {
  Random random(seed);
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  const int kind = random.below(3);
  const Quat along_y = Quat::FromTwoVectors(Vec3::UnitZ(), Vec3::UnitY());
  const Quat on_edge = rotation_by({0, 0.25 * std::numbers::pi + random.between(-0.3, 0.3), 0});
  const Box box{{0.5, random.between(0.5, 1.5), 0.5}};
  Body support = kind == 0 ? on_its_own("support", Capsule{0.2, random.between(0.4, 1)}, 1, {0, 0, 0})
                           : on_its_own("support", box, 1, {0, 0, 0});
  support.orientation = kind == 0 ? along_y : kind == 1 ? on_edge : rotation_by({0, random.between(-0.3, 0.3), 0});
  support.fixed = true;
  const Vec3 above(random.between(-0.05, 0.05), random.between(-0.1, 0.1), random.between(0.55, 0.65));
  Body capsule = on_its_own("capsule", Capsule{random.between(0.08, 0.15), random.between(0.2, 0.6)},
                            random.between(0.5, 2), above);
  capsule.orientation = rotation_by({0, 0, random.one_of<double>({0, 0, 1e-7, 1e-4, 5e-3})}) * along_y;
  capsule.velocity = {random.between(-0.2, 0.2), 0, random.between(-1, 0)};
  capsule.angular_velocity = {0, random.between(-2, 2), 0};
  if (random.chance(0.5)) capsule.velocity.y() = random.between(-0.5, 0.5);
  scene.bodies = {capsule, support};
  if (random.chance(0.5))
    scene.bodies.push_back(plane({random.between(-0.1, 0.1), random.between(-0.1, 0.1), 1}, -0.5));
  const double restitution = random.one_of<double>({0, 0, 0.3, 0.8});
  scene.contact_default = {restitution, random.one_of<double>({0, 0.2, 0.6})};
  return scene;
}

Scene level_box(unsigned seed) {
  Random random(seed);
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  const Box box{{random.between(0.2, 0.5), random.between(0.2, 0.5), 0.2}};
  scene.bodies = {on_its_own("box", box, random.between(0.5, 2), {0.05, -0.02, 0.3}), plane()};
  scene.contact_default = {0.3, 0.9};
  return scene;
}

const std::vector<SceneRow>& scene_rows() {
  static const std::vector<SceneRow> rows = {
      {"smooth", smooth_scene},
      {"mechanisms", mechanism},
      {"on a plane", bodies_on_plane},
      {"in flight", bodies_in_flight},
      {"cylinders", cylinder_on_plane},
      {"line contacts", line_contact},
      {"level box", level_box},
      {"once contradicted", once_contradicted},
      {"compound joints", compound_mechanism},
  };
  return rows;
}

Scene generated_scene(const std::string& row, unsigned seed) {
  for (const SceneRow& one : scene_rows())
    if (one.name == row) return one.make(seed);
  throw std::invalid_argument("no generator is called " + row);
}

}  // namespace rigor::test
