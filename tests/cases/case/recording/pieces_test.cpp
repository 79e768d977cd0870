#include "cases/case/recording/pieces.h"

#include <boost/test/unit_test.hpp>

#include "tests/core/scene/toml/refusal.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_case_recording_pieces)

namespace {

RecordedBody along_x(const std::vector<double>& times) {
  RecordedBody body;
  body.times = times;
  for (const double time : times) body.positions.push_back({time, 0, 0}), body.velocities.push_back({1, 0, 0});
  return body;
}

RecordedTrial trial(const std::string& name, const std::vector<RecordedBody>& bodies) {
  return {name, bodies, bodies.front().times.back()};
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_begins_where_the_last_ended_and_the_rest_is_dropped) {
  const std::vector<double> times = {0, 0.1, 0.2, 0.3, 0.4, 0.5};
  const auto pieces = pieces_of({trial("a", {along_x(times)}), trial("b", {along_x({0, 0.1})})}, 0.2);
  BOOST_TEST_REQUIRE(pieces.size() == 2u);
  BOOST_TEST(pieces[0].name == "a from 0 s");
  BOOST_TEST(pieces[1].name == "a from 0.2 s");
  const RecordedBody& second = pieces[1].bodies.at(0);
  BOOST_TEST_REQUIRE(second.times.size() == 3u);
  BOOST_TEST(second.times[0] == 0.0);
  BOOST_TEST(second.times[2] == 0.4 - 0.2);
  BOOST_TEST(pieces[1].duration == 0.4 - 0.2);
  BOOST_TEST((second.positions[0] == Vec3(0.2, 0, 0)));
  BOOST_TEST((second.velocities[2] == Vec3(1, 0, 0)));
  BOOST_TEST(second.orientations.empty());
}

// Nobody measured what happened in between.
BOOST_AUTO_TEST_CASE(no_piece_spans_a_longer_interval) {
  const auto pieces = pieces_of({trial("a", {along_x({0, 0.1, 0.9, 1.0, 1.1})})}, 0.2);
  BOOST_TEST_REQUIRE(pieces.size() == 2u);
  BOOST_TEST(pieces[0].duration == 0.1);
  BOOST_TEST(pieces[1].name == "a from 0.9 s");
  BOOST_TEST(pieces[1].duration == 1.1 - 0.9);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_cut_is_refused) {
  const auto of = [](const std::vector<RecordedTrial>& trials) { return refusal_of([&] { pieces_of(trials, 0.2); }); };
  const RecordedBody slow = along_x({0, 0.2, 0.4}), quick = along_x({0, 0.1, 0.4});
  BOOST_TEST(of({trial("a", {slow, quick})}).find("'a' were measured at different instants") != std::string::npos);
  BOOST_TEST(of({trial("a", {along_x({0, 0.1})})}).find("longest trial lasts 0.1 s") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
