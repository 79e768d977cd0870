// The coordinates and rows of axes in series against a chain of transforms that is put together here, and against its
// differences in time.
#include "core/scene/joints/axis_series.h"

#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <vector>

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_scene_joints_axis_series)

namespace {

using Vec6d = Eigen::Matrix<double, 6, 1>;

// Smooth motions of a and of each coordinate; any will do.
Eigen::Isometry3d pose_of_a(double t) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Vec3(0.3 * t, 0.1 - 0.4 * t * t, 0.2 * std::sin(t)));
  pose.rotate(Eigen::AngleAxisd(0.8 * t + 0.3 * t * t, Vec3(1, 2, -2).normalized()));
  pose.rotate(Eigen::AngleAxisd(0.5 * std::sin(2 * t), Vec3::UnitX()));
  return pose;
}
double coordinate(std::size_t i, double t) {
  return (i % 2 == 0 ? 1 : -1) * (0.5 + 0.1 * double(i)) * std::sin(t + 0.3 * t * t);
}

struct Chain {
  std::vector<SeriesAxis> axes;
  Eigen::Isometry3d b_start;

  Chain(const std::vector<SeriesAxis>& of, const Vec3& centre) : axes(of), b_start(Eigen::Isometry3d::Identity()) {
    b_start.translate(centre), b_start.rotate(Eigen::AngleAxisd(0.9, Vec3(2, -1, 2).normalized()));
  }
  // a is at the origin at t = 0, so the axes are in its frame.
  Eigen::Isometry3d b(double t) const {
    Eigen::Isometry3d pose = pose_of_a(t) * pose_of_a(0).inverse();
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const double x = coordinate(i, t);
      if (axes[i].turns)
        pose = pose * Eigen::Translation3d(axes[i].anchor) * Eigen::AngleAxisd(x, axes[i].axis) *
               Eigen::Translation3d(-axes[i].anchor);
      else
        pose = pose * Eigen::Translation3d(x * axes[i].axis);
    }
    return pose * b_start;
  }
  Eigen::Isometry3d a(double t) const { return pose_of_a(t); }
};

constexpr double kStep = 1e-3;  // differences of fourth order over it err by 1e-11

template <typename Pose>
Vec6d velocity(const Pose& pose, double t) {
  const auto difference = [&](double h) {
    const Eigen::Isometry3d before = pose(t - h), after = pose(t + h);
    const Eigen::AngleAxisd turn(Mat3(after.linear() * before.linear().transpose()));
    Vec6d v;
    v << (after.translation() - before.translation()) / (2 * h), turn.angle() / (2 * h) * turn.axis();
    return v;
  };
  return (4 * difference(kStep) - difference(2 * kStep)) / 3;
}

template <typename Pose>
Vec6d acceleration(const Pose& pose, double t) {
  const auto at = [&](double s) { return velocity(pose, s); };
  return (8 * (at(t + kStep) - at(t - kStep)) - (at(t + 2 * kStep) - at(t - 2 * kStep))) / (12 * kStep);
}

SeriesEnd end_of(const Eigen::Isometry3d& pose, const Vec6d& v) {
  return {pose.translation(), v.head<3>(), v.tail<3>(), pose.linear()};
}

BodyPose body_pose(const Eigen::Isometry3d& pose) { return {pose.translation(), Quat(pose.linear())}; }

std::vector<std::vector<SeriesAxis>> chains() {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY();
  const SeriesAxis slide_x{false, Vec3::Zero(), x}, slide_z{false, Vec3::Zero(), Vec3(0.1, 0.2, 1).normalized()},
      slide_y{false, Vec3::Zero(), y}, hinge_x{true, {0.1, 0.2, 0}, x}, hinge_y{true, {0.3, -0.1, 0.2}, y},
      hinge_z{true, {-0.2, 0.1, 0.4}, Vec3(0.3, 0.2, 1).normalized()};
  return {{hinge_x},
          {slide_x},
          {slide_x, slide_z, hinge_y},
          {hinge_z, hinge_y},
          {hinge_x, hinge_y, hinge_z},
          {hinge_z, slide_x, hinge_y},
          {slide_x, hinge_z, slide_y, hinge_x},
          {slide_x, slide_y, slide_z},
          {slide_x, slide_y, slide_z, hinge_x, hinge_y, hinge_z},
          {hinge_x, slide_z, hinge_y, slide_x, hinge_z}};
}

Chain chain_of(const std::vector<SeriesAxis>& axes) { return {axes, {0.7, -0.4, 0.6}}; }

}  // namespace

BOOST_AUTO_TEST_CASE(coordinates_of_a_chain_are_those_that_made_it_and_nothing_is_open) {
  for (const auto& axes : chains()) {
    const Chain chain = chain_of(axes);
    const AxisSeries series(axes, body_pose(chain.a(0)), body_pose(chain.b(0)));
    for (const double t : {0.0, 0.4, 1.1}) {
      const AxisSeries::Rows rows = series.at(end_of(chain.a(t), Vec6d::Zero()), end_of(chain.b(t), Vec6d::Zero()));
      BOOST_TEST(rows.count == series.locked());
      for (int k = 0; k < rows.count; ++k) BOOST_TEST(std::abs(rows.locked[std::size_t(k)].gap) < 1e-14);
      for (std::size_t i = 0; i < axes.size(); ++i)
        BOOST_TEST(std::abs(rows.coordinates[i].gap - (coordinate(i, t) - coordinate(i, 0))) < 1e-13);
    }
  }
}

// On the chain's own motion J V is 0 or x', and J V' and the bias make 0 or x''.
BOOST_AUTO_TEST_CASE(rows_and_biases_follow_the_motion_of_the_chain) {
  for (const auto& axes : chains()) {
    const Chain chain = chain_of(axes);
    const AxisSeries series(axes, body_pose(chain.a(0)), body_pose(chain.b(0)));
    const double t = 0.6;
    const auto a = [&](double s) { return chain.a(s); };
    const auto b = [&](double s) { return chain.b(s); };
    const Vec6d v_a = velocity(a, t), v_b = velocity(b, t), a_a = acceleration(a, t), a_b = acceleration(b, t);
    const AxisSeries::Rows rows = series.at(end_of(chain.a(t), v_a), end_of(chain.b(t), v_b));
    const Vec3 line = chain.b(t).translation() - chain.a(t).translation();
    const auto times = [&](const AxisSeries::Row& row, const Vec6d& of_a, const Vec6d& of_b) {
      return row.force.dot(of_b.head<3>() - of_a.head<3>()) + row.torque.dot(of_b.tail<3>() - of_a.tail<3>()) -
             line.cross(row.force).dot(of_a.tail<3>());
    };
    for (int k = 0; k < rows.count; ++k) {
      const AxisSeries::Row& row = rows.locked[std::size_t(k)];
      BOOST_TEST(std::abs(times(row, v_a, v_b)) < 1e-9);
      BOOST_TEST(std::abs(row.rate - times(row, v_a, v_b)) < 1e-12);
      BOOST_TEST(std::abs(times(row, a_a, a_b) + row.bias) < 1e-7);
    }
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const AxisSeries::Row& row = rows.coordinates[i];
      const double h = 1e-4, rate = (coordinate(i, t + h) - coordinate(i, t - h)) / (2 * h),
                   second = (coordinate(i, t + h) - 2 * coordinate(i, t) + coordinate(i, t - h)) / (h * h);
      BOOST_TEST(std::abs(times(row, v_a, v_b) - rate) < 1e-8);
      BOOST_TEST(std::abs(times(row, a_a, a_b) + row.bias - second) < 1e-6);
    }
  }
}

BOOST_AUTO_TEST_CASE(locked_rows_are_the_derivatives_of_their_gaps) {
  for (const auto& axes : chains()) {
    const Chain chain = chain_of(axes);
    const AxisSeries series(axes, body_pose(chain.a(0)), body_pose(chain.b(0)));
    const Vec6d v_a = (Vec6d() << 0.4, -0.3, 0.2, 0.7, 0.5, -0.6).finished(),
                v_b = (Vec6d() << -0.2, 0.6, 0.1, -0.3, 0.8, 0.9).finished();
    const auto moved = [](Eigen::Isometry3d pose, const Vec6d& v, double h) {
      const Vec3 w = v.tail<3>();
      pose.linear() = Eigen::AngleAxisd(h * w.norm(), w.normalized()).toRotationMatrix() * pose.linear();
      pose.translation() += h * v.head<3>();
      return pose;
    };
    const double t = 0.6, h = 1e-5;
    const auto rows = [&](double s) {
      return series.at(end_of(moved(chain.a(t), v_a, s), v_a), end_of(moved(chain.b(t), v_b, s), v_b));
    };
    const AxisSeries::Rows now = rows(0), before = rows(-h), after = rows(h);
    for (std::size_t k = 0; k < std::size_t(now.count); ++k)
      BOOST_TEST(std::abs((after.locked[k].gap - before.locked[k].gap) / (2 * h) - now.locked[k].rate) < 1e-8);
  }
}

BOOST_AUTO_TEST_CASE(repeated_axes_are_named) {
  const SeriesAxis hinge{true, Vec3::Zero(), Vec3::UnitX()}, slider{false, Vec3::Zero(), Vec3::UnitX()};
  const SeriesAxis y{true, Vec3::Zero(), Vec3::UnitY()}, xy{true, Vec3::Zero(), Vec3(1, 1, 0).normalized()};
  BOOST_TEST(why_no_series({hinge, slider}).empty());
  BOOST_TEST(why_no_series({hinge, y, hinge}).find("hinges 1 and 3 have the same axis") != std::string::npos);
  BOOST_TEST(why_no_series({slider, hinge, slider}).find("sliders 1 and 2") != std::string::npos);
  BOOST_TEST(why_no_series({hinge, y, xy}).find("lie in one plane") != std::string::npos);
  BOOST_TEST(!why_no_series({}).empty());
}

// At the stages of a step the axes of both bodies lie slightly apart. The coordinates must not depend on how the whole
// scene is turned.
BOOST_AUTO_TEST_CASE(coordinates_of_an_open_chain_do_not_depend_on_the_axes_of_the_world) {
  const Eigen::AngleAxisd opened(0.05, Vec3(1, -3, 2).normalized());
  for (const auto& axes : chains()) {
    const Chain chain = chain_of(axes);
    const auto coordinates = [&](const Mat3& turn) {
      std::vector<SeriesAxis> turned = axes;
      for (SeriesAxis& axis : turned) axis.axis = turn * axis.axis, axis.anchor = turn * axis.anchor;
      const auto pose = [&](const Eigen::Isometry3d& from) { return Eigen::Isometry3d(turn * from); };
      const AxisSeries series(turned, body_pose(Eigen::Isometry3d::Identity()), body_pose(pose(chain.b_start)));
      const Eigen::Isometry3d now = pose(chain.a(0).inverse() * chain.b(0.6)) * opened;
      const AxisSeries::Rows rows =
          series.at(end_of(Eigen::Isometry3d::Identity(), Vec6d::Zero()), end_of(now, Vec6d::Zero()));
      std::vector<double> found;
      for (std::size_t i = 0; i < axes.size(); ++i) found.push_back(rows.coordinates[i].gap);
      return found;
    };
    const std::vector<double> plain = coordinates(Mat3::Identity());
    const std::vector<double> turned = coordinates(Eigen::AngleAxisd(1.9, Vec3(2, 1, 3).normalized()).matrix());
    for (std::size_t i = 0; i < axes.size(); ++i) BOOST_TEST(std::abs(turned[i] - plain[i]) < 1e-13, i);
  }
}

BOOST_AUTO_TEST_SUITE_END()
