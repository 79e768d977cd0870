#include "cases/import/model_elements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/import/assembly/mass_moments.h"
#include "core/base/unit_vector.h"
#include "core/scene/validate.h"

namespace rigor::inline imports {

Quat turn_of(double roll, double pitch, double yaw) {
  const auto about = [](double angle, const Vec3& axis) { return Quat(Eigen::AngleAxisd(angle, axis)); };
  return (about(yaw, Vec3::UnitZ()) * about(pitch, Vec3::UnitY()) * about(roll, Vec3::UnitX())).normalized();
}

Mat3 symmetric(double xx, double yy, double zz, double xy, double xz, double yz) {
  Mat3 m;
  m << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return m;
}

void check_mass(double mass, const XmlElement& element) {
  if (!(mass > 0)) element.refuse(fmt::format("the mass is {}; allowed: a number greater than 0", mass));
}

Mat3 checked_inertia(const Mat3& inertia, const XmlElement& element, bool repair, LeftOut& left_out) {
  if (inertia.isZero(0)) return inertia;
  const std::string why = why_no_inertia(inertia);
  if (why.empty()) return inertia;
  if (!repair)
    element.refuse(
        fmt::format("no body has this inertia: {}; --repair-inertia takes the nearest that one can have", why));
  const auto repaired = inertia.allFinite() ? nearest_inertia(inertia) : std::nullopt;
  if (!repaired) element.refuse(fmt::format("no body has this inertia, and none is near: {}", why));
  left_out.add(element.place(), "an inertia that no body has",
               assumed(fmt::format("--repair-inertia changed it by {:.2g} %", 100 * repaired->change)));
  return repaired->inertia;
}

double positive(double value, const char* what, const XmlElement& element) {
  if (!(value > 0)) element.refuse(fmt::format("{} is {}; allowed: a number greater than 0", what, value));
  return value;
}

double not_negative(double value, const char* what, const XmlElement& element) {
  if (!(value >= 0)) element.refuse(fmt::format("{} is {}; allowed: a number of at least 0", what, value));
  return value;
}

Vec3 vector_of(const std::vector<double>& numbers) {
  return numbers.empty() ? Vec3::Zero().eval() : Vec3(numbers[0], numbers[1], numbers[2]);
}

Vec3 direction_of(const Vec3& axis, const XmlElement& element) {
  const auto unit = unit_vector<3>(axis);
  if (!unit) element.refuse("the axis has no length; allowed: a direction");
  return *unit;
}

double least_of(double a, double b) { return std::min(a, b); }

}  // namespace rigor::inline imports
