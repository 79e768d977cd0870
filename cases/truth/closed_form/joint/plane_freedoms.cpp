#include "cases/truth/closed_form/joint/plane_freedoms.h"

#include <Eigen/LU>

#include "cases/truth/closed_form/joint/swinging_body.h"

namespace rigor::inline truth {
namespace {

using Plane2 = Eigen::Matrix<Extended, 2, 1>;
using Rows = Eigen::Matrix<Extended, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr Extended kIndependent = 1e-9L;  // of the largest pivot: far above roundings, far below any mechanism's arms

// Velocities in the plane: of each body that moves its centre's two [m/s] and the rate of its turning [rad/s].
class PlaneRows {
 public:
  PlaneRows(const Scene& scene, const ExtendedVec3& axis, const std::vector<PlanePose>& poses)
      : scene_(scene), axis_(axis), poses_(poses), column_(scene.bodies.size(), -1) {
    const ExtendedVec3 e = axis.unitOrthogonal();
    basis_ << e.transpose(), axis.cross(e).transpose();
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      if (!scene.bodies[i].fixed) column_[i] = columns_, columns_ += 3;
    }
    rows_ = Rows::Zero(static_cast<Eigen::Index>(2 * scene.joints.size()), columns_);
    for (const Joint& joint : scene.joints) add(joint);
  }

  int freedoms() const {
    if (used_ == 0) return columns_;
    Eigen::FullPivLU<Rows> factors(rows_.topRows(used_));
    factors.setThreshold(kIndependent);
    return columns_ - static_cast<int>(factors.rank());
  }

 private:
  bool moves(int body) const { return body != kWorld && column_[body] >= 0; }
  Extended angle(int body) const { return moves(body) ? poses_[body].angle : 0; }

  // The vector from a body's centre, moving with it, to the point that was at `point` at t = 0.
  Plane2 arm(int body, const ExtendedVec3& point) const {
    return basis_ * (turn(angle(body) * axis_) * (point - extended(scene_.bodies[body].position)).eval());
  }

  void add(const Joint& joint) {
    if (const auto* hinge = std::get_if<HingeJoint>(&joint.type)) {
      for (const auto& [body, sign] : {std::pair{joint.a, 1}, {joint.b, -1}}) {
        if (!moves(body)) continue;
        const Plane2 r = arm(body, extended(hinge->anchor));
        rows_(used_, column_[body]) = rows_(used_ + 1, column_[body] + 1) = sign;
        rows_(used_, column_[body] + 2) = -sign * r.y(), rows_(used_ + 1, column_[body] + 2) = sign * r.x();
      }
      used_ += 2;
    } else if (const auto* slider = std::get_if<SliderJoint>(&joint.type)) {
      const Plane2 rail = basis_ * (turn(angle(joint.a) * axis_) * extended(slider->axis)).eval(),
                   across(-rail.y(), rail.x());
      const Plane2 apart = place(joint.b) - place(joint.a);
      for (const auto& [body, sign] : {std::pair{joint.a, -1}, {joint.b, 1}}) {
        if (!moves(body)) continue;
        rows_.row(used_).segment(column_[body], 2) = sign * across.transpose();
        rows_(used_ + 1, column_[body] + 2) = sign;
      }
      if (moves(joint.a)) rows_(used_, column_[joint.a] + 2) = -across.dot(Plane2(-apart.y(), apart.x()));
      used_ += 2;
    }
  }

  Plane2 place(int body) const {
    if (body == kWorld) return Plane2::Zero();
    return basis_ * (moves(body) ? poses_[body].position : extended(scene_.bodies[body].position));
  }

  const Scene& scene_;
  ExtendedVec3 axis_;
  const std::vector<PlanePose>& poses_;
  Eigen::Matrix<Extended, 2, 3> basis_;
  std::vector<int> column_;  // of each body's three; -1 of one that is fixed
  Rows rows_;
  int columns_ = 0;
  Eigen::Index used_ = 0;
};

}  // namespace

int plane_freedoms(const Scene& scene, const ExtendedVec3& axis, const std::vector<PlanePose>& poses) {
  return PlaneRows(scene, axis, poses).freedoms();
}

}  // namespace rigor::inline truth
