// Code shared by closed forms of bodies on a plane: the one plane of the scene, gravity along and across it, and the
// gap of a body.
#pragma once

#include <string>
#include <vector>

#include "cases/truth/closed_form/closed_form.h"

namespace rigor::inline truth {

// A larger gap counts as no contact: far above the digits of a case file, far below the judged errors.
inline constexpr double kTouching = 1e-9;  // m

class Ground {
 public:
  // Throws InputError unless the scene's only fixed body that collides is a plane which gravity presses bodies on.
  // `truth` and `is_for` as in check_needs.
  Ground(const Scene& scene, const std::string& truth, const std::string& is_for);

  int body() const { return body_; }
  const ExtendedVec3& normal() const { return normal_; }
  Extended pressing() const { return pressing_; }       // m/s², gravity into the plane
  const ExtendedVec3& along() const { return along_; }  // m/s², gravity along the plane
  ExtendedVec3 part_along(const ExtendedVec3& v) const { return v - normal_.dot(v) * normal_; }
  // m over the plane, of a body's lowest point: spheres and boxes.
  double gap_under(const Body& body) const;
  [[noreturn]] void refuse(const Body& body, const std::string& why) const;

 private:
  std::string truth_, is_for_;
  int body_ = kWorld;
  ExtendedVec3 normal_, along_;
  Extended offset_ = 0, pressing_ = 0;
};

// Whether two vectors lie along one line, to the digits of a case file.
bool are_along(const ExtendedVec3& a, const ExtendedVec3& b);

// A body's way over the plane: straight from one point to the next, inside a disk of `radius` [m].
struct SweptDisk {
  const Body* body;
  std::vector<ExtendedVec3> way;  // m
  Extended radius;                // m
};
// Throws InputError if two bodies' sweeps meet, whenever they pass.
void check_apart(const std::vector<SweptDisk>& sweeps, const Ground& ground);

}  // namespace rigor::inline truth
