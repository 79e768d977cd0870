#include <boost/test/unit_test.hpp>

#include "tests/cases/judged.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_metrics_metrics)

BOOST_AUTO_TEST_CASE(the_table_is_alphabetical_and_each_row_has_a_unit_and_a_summary) {
  for (std::size_t i = 0; i < metrics().size(); ++i) {
    BOOST_TEST(!metrics()[i].unit.empty());
    BOOST_TEST(!metrics()[i].summary.empty());
    if (i > 0) BOOST_TEST((metrics()[i - 1].name < metrics()[i].name));
  }
}

// A gate's better_than, and which bound of it a run that blew up cannot hold, hang on this.
BOOST_AUTO_TEST_CASE(which_metrics_are_better_when_higher_and_which_are_costly) {
  std::vector<std::string> higher, costly;
  for (const MetricRow& row : metrics()) {
    if (row.higher_is_better) higher.push_back(row.name);
    if (row.is_costly) costly.push_back(row.name);
  }
  BOOST_TEST((higher == std::vector<std::string>{"collapse_time", "ensemble_p_value", "repeats", "survival", "tube"}));
  BOOST_TEST((costly == std::vector<std::string>{"phase_error", "repeats", "tube"}));
}

BOOST_AUTO_TEST_CASE(each_row_states_what_its_metric_needs) {
  const auto need = [](bool MetricNeeds::*which) { return metrics_that_need(which); };
  BOOST_TEST(need(&MetricNeeds::twin) == (std::vector<std::string>{"unexplained_error", "unexplained_rotation",
                                                                   "unexplained_spin", "unexplained_velocity"}));
  BOOST_TEST(need(&MetricNeeds::ensemble) == (std::vector<std::string>{"ensemble_distance", "ensemble_p_value"}));
  for (const MetricRow& row : metrics()) {
    const std::vector<std::string> others = {"centre_of_pressure_error", "coulomb_residual", "dissipation_residual",
                                             "hover", "signorini_residual"};
    BOOST_TEST(row.needs.contacts == (row.name.starts_with("contact_") || row.name.starts_with("force_") ||
                                      std::find(others.begin(), others.end(), row.name) != others.end()),
               row.name);
    BOOST_TEST(row.is_compared == (row.name != "cost" && row.name != "ensemble_p_value"), row.name);
  }
  BOOST_TEST(headline_metrics() == (std::vector<std::string>{"position_error", "orientation_error"}));
  BOOST_TEST(find_metric("position_error")->unit == "m");
  BOOST_TEST(find_metric("observed_order") == nullptr);
}

BOOST_AUTO_TEST_CASE(the_metrics_across_cells_are_alphabetical_and_have_names_of_their_own) {
  for (std::size_t i = 0; i < cross_metrics().size(); ++i) {
    BOOST_TEST(!cross_metrics()[i].unit.empty());
    BOOST_TEST(!cross_metrics()[i].summary.empty());
    if (i > 0) BOOST_TEST((cross_metrics()[i - 1].name < cross_metrics()[i].name));
    for (const MetricRow& row : metrics()) BOOST_TEST(row.name != cross_metrics()[i].name);
  }
}

// What a scene must have for some metrics; without it they say so.
bool is_of_contact_or_joints(const std::string& metric) {
  const std::vector<std::string> names = {"collapse_time",
                                          "creep",
                                          "contact_balance",
                                          "centre_of_pressure_error",
                                          "contact_force_error",
                                          "contact_gap_error",
                                          "contact_moment_error",
                                          "dissipation_residual",
                                          "hover",
                                          "signorini_residual",
                                          "coulomb_residual",
                                          "force_peak",
                                          "force_ripple",
                                          "energy_gain",
                                          "friction_anisotropy",
                                          "ensemble_distance",
                                          "ensemble_p_value",
                                          "impact_time_error",
                                          "internal_energy_drift",
                                          "penetration",
                                          "restitution_error",
                                          "stop_distance_error",
                                          "joint_gap",
                                          "joint_gap_rate",
                                          "joint_twist",
                                          "joint_twist_rate",
                                          "mean_position_error",  // of recordings
                                          "mean_rotation_error",
                                          "reaction_error",
                                          "reaction_torque_error",
                                          "repeats",  // of a run that was repeated
                                          "reported_reaction_error",
                                          "reported_reaction_torque_error"};
  return std::find(names.begin(), names.end(), metric) != names.end();
}

BOOST_AUTO_TEST_CASE(the_truth_itself_has_no_error) {
  struct Row {
    const char* truth;
    Scene scene;
  };
  for (const Row& row : {Row{"reference", test::fixed_spring()},
                         {"reference", test::coupled_bodies(0)},
                         {"reference", test::coupled_bodies(3)},
                         {"reference", test::tumbling_body()},
                         {"projectile", test::thrown_cube()},
                         {"bounce", test::dropped_sphere(1)},
                         {"bounce", test::dropped_sphere(0.5)}}) {
    const auto truth = make_truth(row.truth, row.scene, 2);
    const Trajectory played = test::played(*truth, row.scene, 0.02, 100);
    const TruthSamples samples = test::sampled(*truth, played, row.scene, 100);
    const std::vector<double> no_rounding(played.samples.size());
    const TwinRun itself{played, no_rounding, no_rounding};
    const JudgedRun run{row.scene, played, &samples, 0, &itself, 0, 2, 2};
    for (const MetricRow& metric : metrics()) {
      BOOST_TEST_CONTEXT(row.truth << " of " << row.scene.bodies[0].name << ": " << metric.name) {
        const MetricResult result = metric.measure(run);
        BOOST_TEST(result.measurement.has_value() == result.not_applicable.empty());
        if (is_of_contact_or_joints(metric.name) && !result.measurement) continue;
        BOOST_REQUIRE(result.measurement.has_value());
        BOOST_TEST(result.not_applicable == "");
        const double perfect = metric.name == "survival" ? 2 : metric.higher_is_better ? 1 : 0;
        // Roundings, of momenta up to 1e3 kg m/s.
        BOOST_TEST(std::abs(result.measurement->value - perfect) < 1e-12 * 1e3);
        const std::vector<std::string> one_number = {
            "cost", "impact_time_error", "phase_error", "restitution_error", "survival", "stop_distance_error", "tube"};
        const bool is_one_number = std::find(one_number.begin(), one_number.end(), metric.name) != one_number.end();
        BOOST_TEST(result.measurement->series.size() == (is_one_number ? 0 : 101));
        BOOST_TEST(result.measurement->compared_until == 2);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_run_without_a_sample_is_judged_by_none) {
  const Scene scene = test::fixed_spring();
  const Trajectory empty{0.1, {}};
  const TruthSamples nothing{{}, {}, 1};
  for (const TruthSamples* truth : {static_cast<const TruthSamples*>(nullptr), &nothing}) {
    for (const MetricRow& metric : metrics()) {
      const MetricResult result = metric.measure({scene, empty, truth, 0});
      BOOST_TEST_CONTEXT(metric.name) {
        BOOST_TEST(!result.measurement.has_value());
        BOOST_TEST(result.not_applicable != "");
      }
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
