// Scenes that several tests use, built in code.
#pragma once

#include "core/scene/scene.h"

namespace rigor::test {

inline Body body(const std::string& name, double mass, const Vec3& moments, const Vec3& position = Vec3::Zero()) {
  Body b;
  b.name = name;
  b.mass = mass;
  b.inertia = moments.asDiagonal();
  b.position = position;
  return b;
}

inline Spring spring(int a, const Vec3& point_a, int b, const Vec3& point_b, double stiffness, double rest_length,
                     double damping = 0) {
  Spring s;
  s.a = a, s.point_a = point_a, s.b = b, s.point_b = point_b;
  s.stiffness = stiffness, s.rest_length = rest_length, s.damping = damping;
  return s;
}

// One body without forces, turning about all its axes.
inline Scene tumbling_body(const Vec3& moments = {1, 2, 3}) {
  Scene scene;
  scene.bodies = {body("top", 2, moments, {1, 2, 3})};
  scene.bodies[0].velocity = {0.3, -0.2, 0.5};
  scene.bodies[0].angular_velocity = {1.1, 0.7, -0.9};
  scene.bodies[0].orientation = Quat(0.8, 0.2, -0.4, 0.4).normalized();
  return scene;
}

// A cube hung off-centre from the world by a spring (the course, assignment 5, exercise 2-1).
inline Scene fixed_spring() {
  Scene scene;
  scene.gravity = {0, -9.8, 0};
  scene.bodies = {body("cube", 100, {1, 1, 1}, {0, 0.5, 0})};
  scene.springs = {spring(kWorld, {0.12, 2, 0.12}, 0, {0.12, 0.12, 0.12}, 1e4, 1.38)};
  return scene;
}

// Two bodies of full inertia, coupled to each other and to the world, under gravity and a timed force.
inline Scene coupled_bodies(double damping) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  scene.bodies = {body("upper", 2, {0.1, 0.2, 0.25}, {0, 0, 1}), body("lower", 1, {0.05, 0.06, 0.08}, {0.3, 0.1, 0})};
  scene.bodies[0].inertia(0, 1) = scene.bodies[0].inertia(1, 0) = 0.03;
  scene.bodies[1].angular_velocity = {1, -2, 3};
  scene.bodies[1].orientation = Quat(0.5, 0.5, -0.1, 0.7).normalized();
  scene.springs = {spring(kWorld, {0.1, 0, 2}, 0, {0.1, 0.05, 0.2}, 60, 0.7, damping),
                   spring(0, {-0.1, 0.1, -0.2}, 1, {0.1, 0, 0.15}, 40, 0.5, damping)};
  TimedForce force;
  force.body = 1, force.force = {1, 2, 0}, force.torque = {0, 0.05, 0.02}, force.point = {0, 0.1, 0};
  scene.forces = {force};
  return scene;
}

// A sphere above the ground y = 0, with infinite friction (the course, assignment 5, exercise 3).
inline Scene dropped_sphere(double restitution) {
  Scene scene;
  scene.gravity = {0, -9.8, 0};
  Body ball = body("ball", 100, {0.4, 0.4, 0.4}, {0, 1.47, 0});
  ball.shape = Sphere{0.1};
  Body ground;
  ground.name = "ground";
  ground.shape = Plane{Vec3::UnitY(), 0};
  ground.fixed = true;
  ball.collides = ground.collides = true;
  scene.bodies = {ball, ground};
  scene.contact_default = {restitution, kInfiniteFriction};
  return scene;
}

}  // namespace rigor::test
