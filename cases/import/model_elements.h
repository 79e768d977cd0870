// What URDF and SDF have in common: turns by roll, pitch and yaw, moments of inertia as six attributes' worth of
// numbers.
#pragma once

#include "cases/import/xml.h"

namespace rigor {

// Turns about the fixed axes x, y and z, in this order [rad].
Quat turn_of(double roll, double pitch, double yaw);

Mat3 symmetric(double xx, double yy, double zz, double xy, double xz, double yz);

// Refuses, at its element, what no body can have.
void check_mass(double mass, const XmlElement& element);
void check_inertia(const Mat3& inertia, const XmlElement& element);
double positive(double value, const char* what, const XmlElement& element);
double not_negative(double value, const char* what, const XmlElement& element);
Vec3 vector_of(const std::vector<double>& numbers);  // three; zero if there are none
Vec3 direction_of(const Vec3& axis, const XmlElement& element);

double least_of(double a, double b);  // how two surfaces make a pair's friction and restitution

// Why what stands beside a link or joint in nearly every file is not in a scene.
inline constexpr const char* kIsSeen = "is there to be seen; a scene shows the shapes that collide";
inline constexpr const char* kBoundsADrive = "bounds a drive, and the joint has none";
inline constexpr const char* kDryFriction = "is dry friction in a joint, which a scene does not have";
inline constexpr const char* kMesh = "is a mesh, which a scene does not have: nothing touches it";
inline constexpr const char* kCylinder = "is a cylinder, which a scene does not have: nothing touches it";

}  // namespace rigor
