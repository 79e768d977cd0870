#include "cases/results/result_json.h"

#include <boost/test/unit_test.hpp>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "tests/cases/report/sample_results.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_results_result_json)

namespace {

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

}  // namespace

BOOST_AUTO_TEST_CASE(every_number_comes_back_with_its_bits) {
  using Limits = std::numeric_limits<double>;
  const double infinity = Limits::infinity();
  CaseResult result = sample_results().cases.front();
  const Scene& scene = result.definition.scene;
  for (const double number : {0.0, -0.0, 0.1, Limits::denorm_min(), -5e-320, Limits::min(), Limits::max(),
                              Limits::lowest(), infinity, -infinity, Limits::quiet_NaN()}) {
    Cell cell = result.cells.front();
    MetricValue& metric = cell.metrics["position_error"];
    metric.value = metric.first_second = metric.compared_until = number;
    metric.worst.time = metric.worst.found = metric.worst.expected = number;
    cell.reduced_order = ReducedOrder{number, "by short steps"}, cell.sub_step = number;
    cell.cpu_seconds = cell.wall_seconds = cell.stability.time = number;
    apply_message(result, message_of_cell(1, cell, scene));
    const Cell& back = result.cells[1];
    const MetricValue& its = back.metrics.at("position_error");
    BOOST_TEST_REQUIRE((back.reduced_order.has_value() && back.sub_step.has_value()));
    BOOST_TEST(back.reduced_order->how == "by short steps");
    for (const double came :
         {back.reduced_order->from, *back.sub_step, its.value, its.first_second, its.compared_until, its.worst.time,
          its.worst.found, its.worst.expected, back.cpu_seconds, back.wall_seconds, back.stability.time})
      BOOST_TEST(same_bits(came, number), came << " for " << number);
    apply_message(result, message_of_truth({number, number, number, number}));
    BOOST_TEST(same_bits(result.truth->error_at_end, number));
    BOOST_TEST(same_bits(result.truth->largest_energy_change, number));
    apply_message(result, message_of_stable_step(0, {Status::pass, "", {number, false, false}}));
    BOOST_TEST(same_bits(result.stable_steps[0].step.dt, number));
    apply_message(result, message_of_spreads({{0, 1, {0.1, "1/10"}, {number, 1, 0}, {2, number, 0}, number, number}}));
    BOOST_TEST_REQUIRE(result.spreads.size() == 1u);
    const Spread& spread = result.spreads.front();
    for (const double came : {spread.distance.value, spread.angle.time, *spread.parted_at, spread.compared_until})
      BOOST_TEST(same_bits(came, number), came << " for " << number);
  }
}

BOOST_AUTO_TEST_CASE(every_word_comes_back) {
  CaseResult result = sample_results().cases.front();
  const Scene& scene = result.definition.scene;
  Cell cell = result.cells.front();
  cell.status = Status::invalid, cell.reason = "it is so", cell.trajectory = "";
  cell.stability = {Verdict::gaining, 0.5, kWorld, "it rose", 0.13};
  cell.settings = {{"solver", "exact"}, {"steps", "7"}};
  cell.recordings = {{"scene", {"one", "two"}}};
  cell.metrics["position_error"].is_held_to_itself = true;
  cell.scheme.without_gyroscopic_term["energy_drift"] = cell.metrics["energy_drift"];
  apply_message(result, message_of_cell(1, cell, scene));
  const Cell& back = result.cells[1];
  BOOST_TEST((back.status == Status::invalid && back.reason == "it is so" && back.trajectory.empty()));
  BOOST_TEST((back.stability.verdict == Verdict::gaining && back.stability.body == kWorld));
  BOOST_TEST((back.stability.why == "it rose" && back.stability.amount == 0.13));
  BOOST_TEST((back.settings == cell.settings));
  BOOST_TEST((back.recordings == cell.recordings));
  BOOST_TEST(back.metrics.at("position_error").is_held_to_itself);
  BOOST_TEST(!back.metrics.at("energy_drift").is_held_to_itself);
  BOOST_TEST(
      (back.metrics.at("position_error").worst.body == 0 && back.metrics.at("energy_drift").worst.body == kWorld));
  BOOST_TEST(back.metrics.at("orientation_error").not_applicable == "nothing turns");
  BOOST_TEST(back.scheme.twin == "core:its-twin");
  BOOST_TEST(back.scheme.metrics.at("position_error").value == 0.24);
  BOOST_TEST(back.scheme.without_gyroscopic_term.at("energy_drift").value == 0.5);
  for (const bool is_cap : {true, false}) {
    apply_message(result, message_of_stable_step(1, {Status::pass, "cut", {0.25, is_cap, !is_cap}}));
    const StableStep& step = result.stable_steps[1].step;
    BOOST_TEST((step.dt == 0.25 && step.is_cap == is_cap && step.is_floor == !is_cap && step.cut == "cut"));
  }
  apply_message(result, message_of_stable_step(1, {Status::timed_out, "no result", {}}));
  BOOST_TEST((result.stable_steps[1].status == Status::timed_out && result.stable_steps[1].reason == "no result"));
  apply_message(result, message_of_truth({1, 2, 3, 4, {{"scene", {"one"}}}}));
  BOOST_TEST((result.truth->horizon == 2 && result.truth->largest_kinetic_energy == 3));
  BOOST_TEST((result.truth->recordings == Recordings{{"scene", {"one"}}}));
}

// A pair that never parted has no time of it; a body that there is not has no place.
BOOST_AUTO_TEST_CASE(a_spread_comes_back_with_its_pair_and_its_bodies) {
  CaseResult result = sample_results().cases.front();
  apply_message(result, message_of_spreads({{0, 1, {0.1, "1/10"}, {0.5, 0.25, 0}, {0.75, 1, 0}, {}, 1}}));
  const Spread& spread = result.spreads.front();
  BOOST_TEST((spread.first == 0 && spread.second == 1 && spread.dt.seconds == 0.1 && spread.dt.text == "1/10"));
  BOOST_TEST((spread.distance.value == 0.5 && spread.distance.time == 0.25 && spread.angle.value == 0.75));
  BOOST_TEST(!spread.parted_at.has_value());
  const int beyond = static_cast<int>(result.definition.scene.bodies.size());
  BOOST_CHECK_THROW(apply_message(result, message_of_spreads({{0, 1, {0.1, "1/10"}, {1, 1, beyond}, {}, {}, 1}})),
                    std::exception);
  for (const auto& [first, second] : {std::pair(2, 1), std::pair(0, 2)}) {
    Spread of_others = spread;
    of_others.first = first, of_others.second = second;
    BOOST_CHECK_THROW(apply_message(result, message_of_spreads({of_others})), std::runtime_error);
  }
}

BOOST_AUTO_TEST_CASE(a_garbled_message_is_refused_and_changes_nothing) {
  CaseResult result = sample_results().cases.front();
  const Scene& scene = result.definition.scene;
  const auto state = [&] {
    std::string text = result.truth ? "truth " : "";
    for (const Cell& cell : result.cells) text += text_of(json_of(cell, scene), -1);
    for (const StableStepResult& stable : result.stable_steps) text += text_of(json_of(stable), -1);
    return text + std::to_string(result.spreads.size());
  };
  const std::string before = state(), good = message_of_cell(1, result.cells.front(), scene);
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    BOOST_TEST_REQUIRE(text.find(from) != std::string::npos, from);
    return text.replace(text.find(from), from.size(), to);
  };
  std::vector<std::string> garbled = {
      "",
      "{}",
      "null",
      "[]",
      "\xff\xfe",
      "{\"truth\":[1,2,3]}",
      "{\"truth\":[1,2,3,null,[]]}",
      "{\"spreads\":[{\"first\":0}]}",
      "{\"stable_step\":7,\"result\":{}}",
      "{\"stable_step\":0,\"result\":{\"status\":\"pass\",\"reason\":\"\",\"dt\":\"huge\"}}",
      message_of_spreads({{0, 9, {0.1, "1/10"}, {}, {}, {}, 0}}),
      message_of_spreads({{0, 1, {0.1, "1/10"}, {1, 1, 99}, {}, {}, 0}}),
      message_of_cell(99, result.cells.front(), scene),
      changed("\"pass\"", "\"psas\""),
      changed("\"stable\"", "\"sable\""),
      changed("\"value\":0.25", "\"value\":null"),
      changed("\"value\":0.25", "\"value\":\"0.25\""),
      changed("\"body\":\"st|one", "\"body\":\"st|two"),
      changed("\"cell\":1", "\"cell\":-1"),
      changed("\"solver\":\"exact\"", "\"solver\":1"),
  };
  for (std::size_t size = 0; size < good.size(); size += 7) garbled.push_back(good.substr(0, size));
  for (const std::string& message : garbled) {
    BOOST_CHECK_THROW(apply_message(result, message), std::exception);
    BOOST_TEST((state() == before), "changed by " << message);
  }
}

BOOST_AUTO_TEST_CASE(a_word_that_is_no_status_is_refused) {
  BOOST_TEST((status_of("timed-out") == Status::timed_out));
  for (const char* word : {"", "Pass", "passed"}) BOOST_CHECK_THROW(status_of(word), std::runtime_error);
}

BOOST_AUTO_TEST_SUITE_END()
