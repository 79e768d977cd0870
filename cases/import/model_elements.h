// Shared by URDF and SDF: turns by roll, pitch and yaw, inertias of six numbers, checks and reasons.
#pragma once

#include "cases/import/xml.h"

namespace rigor::inline imports {

// Turns about the fixed axes x, y and z, in this order [rad].
Quat turn_of(double roll, double pitch, double yaw);

Mat3 symmetric(double xx, double yy, double zz, double xy, double xz, double yz);

// Each refuses a value that no body can have, and names its element.
void check_mass(double mass, const XmlElement& element);
// A tensor that is zero belongs to a point, which may be part of a body. `repair`: returns the nearest that a body can
// have, and names the change.
Mat3 checked_inertia(const Mat3& inertia, const XmlElement& element, bool repair, LeftOut& left_out);
double positive(double value, const char* what, const XmlElement& element);
double not_negative(double value, const char* what, const XmlElement& element);
Vec3 vector_of(const std::vector<double>& numbers);  // three; zero if there are none
Vec3 direction_of(const Vec3& axis, const XmlElement& element);

double least_of(double a, double b);  // combines two surfaces into the friction and restitution of a pair

// Reasons why elements of nearly every file are not in a scene.
inline const Reason kSensor = no_motion("is a sensor");
inline const Reason kController = no_motion("is for a controller, and none runs");
inline const Reason kSaysNothing = no_motion("says nothing about the motion");
inline const Reason kOfASolver = assumed("is a setting of one solver");
inline const Reason kIsSeen = no_motion("is only drawn");
// These formats have no drives. A joint moves freely within its stops, whatever a drive could give or reach.
inline const Reason kBoundsADrive = no_motion("bounds a drive, and the joint has none");

}  // namespace rigor::inline imports
