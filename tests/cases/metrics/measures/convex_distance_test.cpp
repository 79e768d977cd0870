// Signed distances by supports. Along the normal that is found the shapes are apart by the gap, and along no other
// direction by more.
#include "cases/metrics/measures/convex_distance.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "tests/core/dynamics/collision/any_shape.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_measures_convex_distance)

namespace {

// m: how far a lies beyond b along n, by supports alone.
double apart_along(const Vec3& n, const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  const Vec3 lowest = pose_a.p + pose_a.R * support(a, -(pose_a.R.transpose() * n)),
             highest = pose_b.p + pose_b.R * support(b, pose_b.R.transpose() * n);
  return n.dot(lowest - highest);
}

}  // namespace

// Apart, and overlapping by up to a hundredth of the smaller inradius.
BOOST_AUTO_TEST_CASE(the_gap_is_what_supports_leave_along_the_normal_and_no_direction_leaves_more) {
  constexpr int kPairs = 6000;
  test::RandomPoses random(1);
  test::AnyShape any_shape(random);
  int apart = 0;
  for (int k = 0; k < kPairs; ++k) {
    const Shape a = any_shape(), b = any_shape();
    Pose pose_a{random.vector(0.8), random.turn()};
    const Pose pose_b{random.vector(0.2), random.turn()};
    if (k % 4 != 0) {
      const ConvexGap first = convex_distance(a, pose_a, b, pose_b);
      pose_a.p -= (first.gap + 0.01 * std::min(inradius(a), inradius(b)) * random.between(0, 1)) * first.normal;
    }
    const ConvexGap found = convex_distance(a, pose_a, b, pose_b);
    apart += found.gap > 0;
    BOOST_TEST_CONTEXT(k << ": " << shape_name(a) << "-" << shape_name(b)) {
      BOOST_TEST(std::abs(found.normal.norm() - 1) < 1e-12);
      BOOST_TEST(std::abs(apart_along(found.normal, a, pose_a, b, pose_b) - found.gap) < 1e-9);
      for (const double aside : {0.001, 0.03, 1.0}) {
        const Vec3 n = (found.normal + random.vector(aside)).normalized();
        BOOST_TEST(apart_along(n, a, pose_a, b, pose_b) < found.gap + 1e-6);  // the search ends so near
      }
    }
  }
  BOOST_TEST(apart > kPairs / 10);
}

// Thin triangles of the polytope made this overlap of 0.03 mm a distance of 1.4 mm.
BOOST_AUTO_TEST_CASE(thin_triangles_do_not_decide) {
  const Shape a = Cylinder{0.040805742098348009, 0.54853659866702487},
              b = Cylinder{0.13142381364557446, 0.11154886414349413};
  Pose pose_a, pose_b;
  pose_a.p = {0.13672687918009144, 0.30133948435467928, -0.057304795396241892};
  pose_b.p = {-0.015834039536751027, 0.038187719485009014, 0.0024089625336951026};
  pose_a.R << -0.72903658194055865, -0.39102084259680525, 0.56179031928942247,  //
      0.65607930193324171, -0.16524868399549697, 0.73637817866402488,           //
      -0.19510410494712066, 0.90542563090109218, 0.37701301720251268;
  pose_b.R << 0.084191260522165079, -0.20394826285784751, -0.97535477531458037,  //
      -0.98919133166094819, 0.10082229195823778, -0.10646771722512055,           //
      0.12005140989813201, 0.97377614035339488, -0.19325549787759355;
  const ConvexGap found = convex_distance(a, pose_a, b, pose_b);
  BOOST_TEST(std::abs(found.gap - apart_along(found.normal, a, pose_a, b, pose_b)) < 1e-9);
  BOOST_TEST(std::abs(found.gap + 3.28867e-5) < 1e-9);
}

BOOST_AUTO_TEST_SUITE_END()
