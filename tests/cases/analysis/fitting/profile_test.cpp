// The profile likelihood against intervals that are known: those of linear models, by Gauss and Student.
#include "cases/analysis/fitting/profile.h"

#include <Eigen/Dense>
#include <boost/math/distributions/students_t.hpp>
#include <boost/test/unit_test.hpp>

#include "tests/cases/recorded_case.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_analysis_fitting_profile)

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double kTrue = 0.4, kSlope = 50;

// y_i = slope * value * t_i + offset + noise, at 90 instants from 0 to 1, in standard deviations of the noise.
struct Line {
  Vector times = Vector::LinSpaced(90, 0, 1), data;
  explicit Line(unsigned long seed, double noise = 1) : data(kSlope * kTrue * times) {
    test::SeededNoise random(seed);
    for (double& one : data) one += 3 + noise * random.draw();
  }
  ProfileInput input(bool is_noise_estimated = false) const {
    ProfileInput input;
    input.residuals = [this](const std::vector<Vector>& points) {
      std::vector<Vector> all;
      for (const Vector& point : points) all.push_back(kSlope * point[0] * times - data);
      return all;
    };
    input.starts = {Vector::Constant(1, 0.7)};
    input.others = Matrix::Ones(90, 1), input.others_error = Matrix::Zero(90, 1);
    input.kinds.assign(90, 0);
    input.is_noise_estimated = is_noise_estimated;
    return input;
  }
  // By the formulas of a straight line with an unknown offset.
  double best() const {
    const Vector t = times.array() - times.mean();
    return t.dot(data) / t.squaredNorm() / kSlope;
  }
  double standard_error() const { return 1 / (times.array() - times.mean()).matrix().norm() / kSlope; }
  double left() const {  // standard deviation of the residuals
    const Vector rest = data - kSlope * best() * times;
    return std::sqrt((rest.array() - rest.mean()).square().sum() / 88);
  }
};

double half_width(const ProfileAxis& axis) { return 0.5 * (axis.high - axis.low); }

ProfileInput input_of(const std::function<Vector(const Vector&)>& residuals, std::vector<Vector> starts) {
  ProfileInput input;
  input.residuals = [residuals](const std::vector<Vector>& points) {
    std::vector<Vector> all;
    for (const Vector& point : points) all.push_back(residuals(point));
    return all;
  };
  input.starts = std::move(starts);
  const long rows = residuals(input.starts.front()).size();
  input.others = input.others_error = Matrix::Zero(rows, 0);
  input.kinds.assign(static_cast<std::size_t>(rows), 0);
  return input;
}

Vector at(double a) { return Vector::Constant(1, a); }
Vector at(double a, double b) { return Eigen::Vector2d(a, b); }

}  // namespace

// An end is searched to 1 % of the half width.
BOOST_AUTO_TEST_CASE(of_a_line_with_known_noise_the_interval_is_that_of_gauss) {
  const Line line(1);
  const Profile found = profile_of(line.input());
  BOOST_TEST_REQUIRE(found.is_told);
  BOOST_TEST(std::abs(found.best[0] - line.best()) < 0.01 * line.standard_error());
  BOOST_TEST(std::abs(half_width(found.axes[0]) / (1.96 * line.standard_error()) - 1) < 0.02);
  BOOST_TEST(std::abs(found.axes[0].low - (line.best() - 1.96 * line.standard_error())) < 0.04 * line.standard_error());
  BOOST_TEST(found.excess[0] == 1);
  BOOST_TEST(found.wait == 1);
}

BOOST_AUTO_TEST_CASE(of_a_line_with_unknown_noise_the_interval_is_students) {
  const Line line(2, 0.9);
  const Profile found = profile_of(line.input(true));
  const double factor = quantile(boost::math::students_t(88), 0.975) * line.left();
  BOOST_TEST(std::abs(half_width(found.axes[0]) / (factor * line.standard_error()) - 1) < 0.02);
}

// The offset is unknown, too: without it the interval would be half as wide.
BOOST_AUTO_TEST_CASE(intervals_of_a_line_cover_the_true_value) {
  int covered = 0, caveats = 0;
  constexpr int kRepeats = 400;
  for (int i = 0; i < kRepeats; ++i) {
    const Line line(static_cast<unsigned long>(100 + i));
    const Profile found = profile_of(line.input());
    covered += found.axes[0].low <= kTrue && kTrue <= found.axes[0].high;
    caveats += found.excess[0] > 1 || found.wait > 1;
  }
  BOOST_TEST(covered >= 0.92 * kRepeats);  // 95 %, three standard errors of 1.1 %
  BOOST_TEST(covered <= 0.98 * kRepeats);
  BOOST_TEST(caveats <= 4);  // two tests with an error of 0.1 % each
}

BOOST_AUTO_TEST_CASE(noise_beyond_the_stated_one_widens_the_interval) {
  const Line line(3, 4);
  const Profile found = profile_of(line.input());
  BOOST_TEST(std::abs(found.excess[0] / line.left() - 1) < 0.01);
  const double factor = quantile(boost::math::students_t(88), 0.975) * line.left();
  BOOST_TEST(std::abs(half_width(found.axes[0]) / (factor * line.standard_error()) - 1) < 0.02);
}

// Each noise value lasts five rows of three: a fifth of the rows know as much.
BOOST_AUTO_TEST_CASE(noise_that_lasts_widens_the_interval) {
  Line line(4);
  test::SeededNoise random(5);
  line.times = Vector::LinSpaced(900, 0, 1), line.data = kSlope * kTrue * line.times;
  for (long row = 0; row < 900; row += 15)
    for (int k = 0; k < 3; ++k) {
      const double noise = random.draw();
      for (long n = 0; n < 5; ++n) line.data[row + 3 * n + k] += noise;
    }
  ProfileInput input = line.input();
  input.others = Matrix::Ones(900, 1), input.others_error = Matrix::Zero(900, 1), input.kinds.assign(900, 0);
  const Profile found = profile_of(input);
  // The correlation of neighbours is 0.8, of which (1 + 0.8)/(1 - 0.8) = 9 follows. The exact number is 5.
  BOOST_TEST(found.wait > 5);
  BOOST_TEST(found.wait < 14);
}

BOOST_AUTO_TEST_CASE(an_interval_is_one_sided_at_a_bound) {
  // The best value would be -0.02, with a standard error of 0.05.
  const Profile found = profile_of(
      input_of([](const Vector& p) -> Vector { return Vector::Constant(9, (p[0] + 0.02) / 0.15); }, {at(0.5)}));
  BOOST_TEST(found.best[0] == 0);
  BOOST_TEST(found.axes[0].low == 0);
  BOOST_TEST(found.axes[0].is_low_open);
  BOOST_TEST(!found.axes[0].is_high_open);
  // From the bound on: (x + 0.02)² - 0.02² = 1.96² 0.05².
  BOOST_TEST(std::abs(found.axes[0].high - (std::sqrt(1.96 * 1.96 * 0.05 * 0.05 + 0.0004) - 0.02)) < 0.002);
}

BOOST_AUTO_TEST_CASE(a_value_that_is_nowhere_unlikely_has_two_open_ends) {
  const auto weak = [](const Vector& p) -> Vector { return Vector::Constant(9, 0.5 * (p[0] - 0.5)); };
  const Profile found = profile_of(input_of(weak, {at(0.3)}));
  BOOST_TEST(found.axes[0].is_low_open);
  BOOST_TEST(found.axes[0].is_high_open);
  const auto nothing = [](const Vector&) -> Vector { return Vector::Constant(9, 0.5); };
  const Profile none = profile_of(input_of(nothing, {at(0.3)}));
  BOOST_TEST(none.axes[0].is_low_open);
  BOOST_TEST(none.axes[0].is_high_open);
}

// Only the sum of two values is known, to 0.01. Each alone can be anything.
BOOST_AUTO_TEST_CASE(values_that_only_matter_together_are_not_told) {
  const auto sum = [](const Vector& p) -> Vector { return Vector::Constant(9, (p[0] + p[1] - 1) / 0.03); };
  const Profile found = profile_of(input_of(sum, {at(0.4, 0.5)}));
  for (const ProfileAxis& axis : found.axes) {
    BOOST_TEST(axis.is_low_open);
    BOOST_TEST(axis.is_high_open);
  }
  BOOST_TEST(found.correlations[0][1] < -0.99);
}

// (x² - 0.36)² in the coordinate x = 2 p - 1 has two valleys, and the data do not tell which one it is.
BOOST_AUTO_TEST_CASE(a_second_valley_belongs_to_the_interval) {
  const auto valleys = [](const Vector& p) -> Vector {
    const double x = 2 * p[0] - 1;
    return Vector::Constant(9, 10 * (x * x - 0.36) + 0.1);
  };
  const Profile found = profile_of(input_of(valleys, {at(0.9), at(0.1)}));
  BOOST_TEST(found.axes[0].low < 0.2);
  BOOST_TEST(found.axes[0].high > 0.8);
}

BOOST_AUTO_TEST_CASE(hardly_more_numbers_than_unknowns_tell_nothing) {
  const auto few = [](const Vector& p) -> Vector { return Vector::Constant(3, p[0] - 0.5); };
  BOOST_TEST(!profile_of(input_of(few, {at(0.4)})).is_told);
}

BOOST_AUTO_TEST_SUITE_END()
