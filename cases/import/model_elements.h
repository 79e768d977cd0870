// Shared by URDF and SDF: turns by roll, pitch and yaw, inertias of six numbers, checks and reasons.
#pragma once

#include "cases/import/xml.h"

namespace rigor {

// Turns about the fixed axes x, y and z, in this order [rad].
Quat turn_of(double roll, double pitch, double yaw);

Mat3 symmetric(double xx, double yy, double zz, double xy, double xz, double yz);

// Each refuses a value that no body can have, and names its element.
void check_mass(double mass, const XmlElement& element);
void check_inertia(const Mat3& inertia, const XmlElement& element);
double positive(double value, const char* what, const XmlElement& element);
double not_negative(double value, const char* what, const XmlElement& element);
Vec3 vector_of(const std::vector<double>& numbers);  // three; zero if there are none
Vec3 direction_of(const Vec3& axis, const XmlElement& element);

double least_of(double a, double b);  // combines two surfaces into the friction and restitution of a pair

// Reasons why elements of nearly every file are not in a scene.
inline constexpr const char* kSensor = "changes no motion: is a sensor";
inline constexpr const char* kController = "changes no motion: is for a controller";
inline constexpr const char* kSaysNothing = "changes no motion";
inline constexpr const char* kOfASolver = "changes no motion: is a setting of one solver";
inline constexpr const char* kIsSeen = "changes no motion: is only drawn";
inline constexpr const char* kBoundsADrive = "changes no motion: bounds a drive, and the joint has none";
inline constexpr const char* kDryFriction = "is dry friction, which no joint of a scene has";
inline constexpr const char* kMesh = "is a mesh, which no scene has: nothing touches it";
inline constexpr const char* kCylinder = "is a cylinder, which no scene has: nothing touches it";

}  // namespace rigor
