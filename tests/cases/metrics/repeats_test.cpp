#include <boost/test/unit_test.hpp>
#include <cmath>

#include "tests/cases/judged.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_repeats)

namespace {

// Two bodies, three samples.
Trajectory trajectory() {
  Trajectory run{0.1, {}};
  for (int n = 0; n < 3; ++n) {
    KeptBodies bodies(2);
    for (int c = 0; c < 13; ++c) {
      for (std::size_t i = 0; i < 2; ++i)
        bodies.columns().column(c)[i] = 1 + n + 0.1 * c + 0.01 * static_cast<double>(i);
    }
    run.samples.push_back({0.1 * n, bodies});
  }
  return run;
}

MetricResult result_of(const Trajectory& run, const Trajectory* again) {
  const Scene scene = test::coupled_bodies(0);
  JudgedRun judged{scene, run, nullptr, 0};
  judged.again = again;
  return find_metric("repeats")->measure(judged);
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_same_bits_are_one) {
  const Trajectory run = trajectory(), again = trajectory();
  const MetricResult result = result_of(run, &again);
  BOOST_TEST_REQUIRE(result.measurement.has_value());
  BOOST_TEST(result.measurement->value == 1);
  BOOST_TEST(result.measurement->compared_until == 0.2);
}

BOOST_AUTO_TEST_CASE(each_single_bit_is_found_with_its_place) {
  const Trajectory run = trajectory();
  for (std::size_t n = 0; n < 3; ++n) {
    for (std::size_t i = 0; i < 2; ++i) {
      for (int c = 0; c < 13; ++c) {
        Trajectory again = trajectory();
        double& number = again.samples[n].bodies.columns().column(c)[i];
        const double due = number;
        number = std::nextafter(number, 100);
        const MetricResult result = result_of(run, &again);
        BOOST_TEST_REQUIRE(result.measurement.has_value());
        BOOST_TEST(result.measurement->value == 0);
        const Instant& worst = result.measurement->worst;
        BOOST_TEST(worst.time == run.samples[n].time);
        BOOST_TEST(worst.body == static_cast<int>(i));
        BOOST_TEST(worst.component == kColumnNames[static_cast<std::size_t>(c)]);
        BOOST_TEST((worst.found == number && worst.expected == due));
      }
    }
  }
}

// A zero of the other sign is another number of bits.
BOOST_AUTO_TEST_CASE(the_sign_of_zero_counts) {
  Trajectory run = trajectory(), again = trajectory();
  run.samples[1].bodies.columns().column(2)[0] = 0.0, again.samples[1].bodies.columns().column(2)[0] = -0.0;
  BOOST_TEST(result_of(run, &again).measurement->value == 0);
}

BOOST_AUTO_TEST_CASE(another_length_is_another_run) {
  const Trajectory run = trajectory();
  Trajectory shorter = trajectory();
  shorter.samples.pop_back();
  BOOST_TEST(result_of(run, &shorter).measurement->value == 0);
  BOOST_TEST(result_of(shorter, &run).measurement->value == 0);
}

BOOST_AUTO_TEST_CASE(a_run_that_was_not_repeated_has_no_value) {
  const MetricResult result = result_of(trajectory(), nullptr);
  BOOST_TEST(!result.measurement.has_value());
  BOOST_TEST(result.not_applicable == "not measured: the run is long, and no gate asks for it");
}

BOOST_AUTO_TEST_SUITE_END()
