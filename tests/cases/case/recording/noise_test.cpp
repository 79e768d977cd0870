#include "cases/case/recording/noise.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>

#include "core/base/rotation_vector.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_case_recording_noise)

namespace {

constexpr double kPlace = 3e-4, kTurn = 2e-3;  // m, rad

// A ball that bounces every 0.3 s and turns evenly, seen 100 times a second.
std::vector<RecordedTrial> bouncing(double place, double turn, std::size_t samples, unsigned long seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto scatter = [&](double size) {
    return Vec3(size * normal(random), size * normal(random), size * normal(random));
  };
  RecordedBody body;
  for (std::size_t i = 0; i < samples; ++i) {
    const double t = 0.01 * static_cast<double>(i), since = std::fmod(t, 0.3);
    body.times.push_back(t);
    body.positions.push_back(Vec3(t, 0, 1.5 * since - 5 * since * since) + scatter(place));
    body.orientations.push_back(rotation_by(scatter(turn)) * rotation_by(Vec3(3, -4, 5) * t));
  }
  return {{"", {body}, body.times.back()}};
}

}  // namespace

// 500 samples hold some 55 independent windows of 18 degrees of freedom, of which a third meet an impact. That raises
// the median by a quarter of its spread of a third: some 10 % in the square, 5 % in the deviation. Chance adds 3 %.
BOOST_AUTO_TEST_CASE(it_is_found_in_flight_between_impacts) {
  for (const unsigned long seed : {1, 2, 3, 4}) {
    const EstimatedNoise found = estimated_noise(bouncing(kPlace, kTurn, 500, seed));
    BOOST_TEST(*found.position == kPlace, boost::test_tools::tolerance(0.15));
    BOOST_TEST(*found.orientation == kTurn, boost::test_tools::tolerance(0.1));  // no impact turns it
  }
}

BOOST_AUTO_TEST_CASE(what_has_no_scatter_or_too_few_samples_has_no_estimate) {
  const EstimatedNoise exact = estimated_noise(bouncing(0, kTurn, 20, 1));
  BOOST_TEST(!exact.position.has_value());
  BOOST_TEST(exact.orientation.has_value());
  BOOST_TEST(!estimated_noise(bouncing(kPlace, kTurn, 8, 1)).position.has_value());
  std::vector<RecordedTrial> places = bouncing(kPlace, kTurn, 50, 1);
  places[0].bodies[0].orientations.clear();
  BOOST_TEST(!estimated_noise(places).orientation.has_value());
}

BOOST_AUTO_TEST_SUITE_END()
