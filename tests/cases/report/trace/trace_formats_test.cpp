// A run in the formats of other programs, read back by the readers of others: Foxglove's reader of MCAP and three.js's
// of glTF.
#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "tests/cases/cli/program.h"

using namespace rigor;

namespace cases_report_trace_trace_formats {

using Json = nlohmann::json;

// A stone that turns while it flies, of each shape one, and a floor that it does not come to. Up is +z.
constexpr const char* kShapes = R"(title = "shapes"
[scene]
gravity = [0, 0, -10]
[[scene.body]]
name = "box"
mass = 2
shape = { type = "box", size = [1, 2, 3] }
collides = false
velocity = [1, 0, 0]
angular_velocity = [0, 0, 1]
[[scene.body]]
name = "ball"
mass = 1
shape = { type = "sphere", radius = 0.5 }
collides = false
position = [5, 0, 0]
[[scene.body]]
name = "pill"
mass = 1
shape = { type = "capsule", radius = 0.25, length = 1 }
collides = false
position = [8, 0, 0]
[[scene.body]]
name = "floor"
shape = { type = "plane", normal = [0, 0, 1], offset = -30 }
[run]
duration = 1
dt = ["1/10"]
)";

struct Traced : Program {
  Traced() { folder.write("shapes.toml", kShapes); }
  std::string trace(const std::string& format) {
    const Answer answer = run({"trace", "shapes.toml", "--engine", "core:rk4", "--dt", "1/10", "--format", format});
    BOOST_TEST_REQUIRE(answer.code == 0, answer.err);
    folder.write("trace." + format, answer.out);
    return answer.out;
  }
  Json node(const std::string& script, const std::string& words) {
    const std::string command = "node '" RIGOR_SOURCE_DIR "/tests/cases/report/trace/" + script + "' " + words + " >'" +
                                path("found") + "' 2>'" + path("why") + "'";
    const int status = std::system(command.c_str());
    BOOST_TEST_REQUIRE(status == 0, content("why"));
    return Json::parse(content("found"));
  }
};

double off(const Json& found, const std::vector<double>& expected) {
  double worst = found.size() == expected.size() ? 0 : 1e9;
  for (std::size_t i = 0; i < std::min(found.size(), expected.size()); ++i)
    worst = std::max(worst, std::abs(found[i].get<double>() - expected[i]));
  return worst;
}

constexpr double kSingle = 1e-5;  // of some metres in single precision, which is what glTF has

}  // namespace cases_report_trace_trace_formats

BOOST_FIXTURE_TEST_SUITE(cases_report_trace_trace_formats, Traced)

BOOST_AUTO_TEST_CASE(without_a_format_it_is_csv_and_others_are_named) {
  const Answer plain = run({"trace", "shapes.toml", "--engine", "core:rk4", "--dt", "1/10"});
  BOOST_TEST(plain.code == 0);
  BOOST_TEST(plain.out == trace("csv"));
  const Answer wrong = run({"trace", "shapes.toml", "--engine", "core:rk4", "--dt", "1/10", "--format", "mcp"});
  BOOST_TEST(wrong.code == 2);
  BOOST_TEST(wrong.err.find("did you mean 'mcap'?") != std::string::npos, wrong.err);
  BOOST_TEST(wrong.out == "");
}

BOOST_AUTO_TEST_CASE(json_lines_have_the_numbers_of_the_csv) {
  std::istringstream csv(trace("csv")), lines(trace("jsonl"));
  std::string row, line;
  std::getline(csv, row);
  int count = 0;
  while (std::getline(lines, line)) {
    const Json instant = Json::parse(line);
    for (const Json& body : instant.at("bodies")) {
      BOOST_TEST_REQUIRE(static_cast<bool>(std::getline(csv, row)));
      std::istringstream cells(row);
      std::string cell;
      std::getline(cells, cell, ',');
      BOOST_TEST(std::stod(cell) == instant.at("time").get<double>());
      std::getline(cells, cell, ',');
      BOOST_TEST(cell == body.at("name").get<std::string>());
      for (const char* key : {"position", "orientation_wxyz", "velocity", "angular_velocity"}) {
        for (const Json& number : body.at(key)) {
          std::getline(cells, cell, ',');
          BOOST_TEST(std::stod(cell) == number.get<double>());
        }
      }
      ++count;
    }
  }
  BOOST_TEST(count == 44);
  BOOST_TEST(!std::getline(csv, row));
}

#if RIGOR_HTML_REPORT

BOOST_AUTO_TEST_CASE(foxgloves_reader_finds_every_frame_and_shape) {
  trace("mcap");
  const Json found = node("mcap_check.mjs", "'" RIGOR_BUILD_DIR "/trace-npm' '" + path("trace.mcap") + "'");
  BOOST_TEST(found.at("schemas").at("foxglove.SceneUpdate") == "foxglove.SceneUpdate");
  BOOST_TEST(found.at("schemas").at("foxglove.FrameTransforms") == "foxglove.FrameTransforms");
  BOOST_TEST(found.at("messages").at("/scene") == 1);
  BOOST_TEST(found.at("messages").at("/tf") == 11);
  BOOST_TEST(found.at("times").back() == 1.0);
  const Json& entities = found.at("first").at("/scene").at("entities");
  BOOST_TEST_REQUIRE(entities.size() == 4u);
  BOOST_TEST(entities[0].at("cubes")[0].at("size") == (Json{{"x", 1.0}, {"y", 2.0}, {"z", 3.0}}));
  BOOST_TEST(entities[1].at("spheres").size() == 1u);
  BOOST_TEST((entities[2].at("spheres").size() == 2u && entities[2].at("cylinders").size() == 1u));
  const Json& box = found.at("last").at("/tf").at("transforms")[0];
  BOOST_TEST(box.at("child_frame_id") == "box");
  BOOST_TEST(off({box.at("translation").at("x"), box.at("translation").at("z")}, {1, -5}) < 1e-12);
  BOOST_TEST(off({box.at("rotation").at("z"), box.at("rotation").at("w")}, {std::sin(0.5), std::cos(0.5)}) < 1e-6);
}

// Many chunks: the index has to find each.
BOOST_AUTO_TEST_CASE(long_runs_have_many_chunks) {
  const Answer answer = run({"trace", "shapes.toml", "--engine", "core:rk4", "--dt", "1/5000", "--format", "mcap"});
  BOOST_TEST_REQUIRE(answer.code == 0, answer.err);
  folder.write("trace.mcap", answer.out);
  const Json found = node("mcap_check.mjs", "'" RIGOR_BUILD_DIR "/trace-npm' '" + path("trace.mcap") + "'");
  BOOST_TEST(found.at("messages").at("/tf") == 5001);
  BOOST_TEST(found.at("chunks").get<int>() > 2);
}

BOOST_AUTO_TEST_CASE(three_js_moves_the_bodies_as_the_run_did) {
  trace("gltf");
  const Json found = node("gltf_check.mjs", "'" RIGOR_BUILD_DIR "/page' '" + path("trace.gltf") + "' 1");
  BOOST_TEST(std::abs(found.at("duration").get<double>() - 1) < kSingle);
  const Json& bodies = found.at("bodies");
  // Up is +y there: the scene's z.
  BOOST_TEST(off(bodies.at("box").at("position"), {1, -5, 0}) < kSingle);
  BOOST_TEST(off(bodies.at("ball").at("position"), {5, -5, 0}) < kSingle);
  BOOST_TEST(off(bodies.at("ball").at("size"), {1, 1, 1}) < 0.01);  // of a polyhedron of 24 points round
  BOOST_TEST(off(bodies.at("pill").at("size"), {0.5, 1.5, 0.5}) < 0.01);
  BOOST_TEST(off(bodies.at("floor").at("size"), {20, 0, 20}) < kSingle);
  const Json middle = node("gltf_check.mjs", "'" RIGOR_BUILD_DIR "/page' '" + path("trace.gltf") + "' 0.5");
  BOOST_TEST(off(middle.at("bodies").at("box").at("position"), {0.5, -1.25, 0}) < kSingle);
}

#endif

// A box of 1 kg at rest: the forces of the last step add up to its weight in each format.
struct TracedContacts : Program {
  TracedContacts() {
    folder.write("box.toml", R"(title = "box"
[scene]
gravity = [0, 0, -10]
[[scene.body]]
name = "box"
mass = 1
shape = { type = "box", size = [1, 1, 1] }
position = [0, 0, 0.5]
[[scene.body]]
name = "floor"
shape = { type = "plane", normal = [0, 0, 1], offset = 0 }
[scene.contact_default]
friction = 0.5
[run]
duration = 1
dt = ["1/100"]
)");
  }
  std::string trace(const std::string& format) {
    const Answer answer = run({"trace", "box.toml", "--engine", "core:velocity-verlet,contact=impulse", "--dt", "1/100",
                               "--contacts", "--format", format});
    BOOST_TEST_REQUIRE(answer.code == 0, answer.err);
    folder.write("trace." + format, answer.out);
    return answer.out;
  }
};

BOOST_FIXTURE_TEST_CASE(json_lines_have_the_contact_forces, TracedContacts) {
  std::istringstream lines(trace("jsonl"));
  std::string line, last;
  while (std::getline(lines, line)) last = line;
  const Json contacts = Json::parse(last).at("contacts");
  BOOST_TEST_REQUIRE(contacts.size() == 4u);
  double weight = 0;
  for (const Json& contact : contacts) {
    const double sign = contact.at("b") == "box" ? 1 : -1;
    weight += sign * contact.at("force")[2].get<double>();
    BOOST_TEST(std::abs(contact.at("normal")[2].get<double>() - sign) < 1e-12);
  }
  BOOST_TEST(std::abs(weight - 10) < 1e-5);
}

// A bar along each force; that of the weight of 10 N would be as long as the box's bounding radius.
BOOST_FIXTURE_TEST_CASE(gltf_has_a_bar_for_each_contact, TracedContacts) {
  const Json file = Json::parse(trace("gltf"));
  int bars = 0, moved = 0;
  for (const Json& one : file.at("nodes")) bars += one.value("name", "").starts_with("contact force");
  for (const Json& channel : file.at("animations")[0].at("channels")) {
    const Json& target = file.at("nodes")[channel.at("target").at("node").get<std::size_t>()];
    moved += target.value("name", "").starts_with("contact force");
  }
  BOOST_TEST(bars == 4);
  BOOST_TEST(moved == 12);  // translation, rotation and scale of each
}

#if RIGOR_HTML_REPORT

BOOST_FIXTURE_TEST_CASE(foxgloves_reader_finds_the_arrows, TracedContacts) {
  trace("mcap");
  const std::string command = "node '" RIGOR_SOURCE_DIR "/tests/cases/report/trace/mcap_check.mjs' '" RIGOR_BUILD_DIR
                              "/trace-npm' '" +
                              path("trace.mcap") + "' >'" + path("found") + "'";
  BOOST_TEST_REQUIRE(std::system(command.c_str()) == 0);
  const Json found = Json::parse(content("found"));
  BOOST_TEST(found.at("messages").at("/contacts") == 101);
  BOOST_TEST(found.at("messages").at("/contact_forces") == 101);
  const Json& arrows = found.at("last").at("/contacts").at("entities")[0].at("arrows");
  const Json& contacts = found.at("last").at("/contact_forces").at("contacts");
  BOOST_TEST_REQUIRE(arrows.size() == 4u);
  double length = 0;
  for (const Json& arrow : arrows)
    length += arrow.at("shaft_length").get<double>() + arrow.at("head_length").get<double>();
  double weight = 0, forces = 0;  // N; the corners also press against each other by friction
  for (const Json& contact : contacts) {
    const Json& force = contact.at("force");
    const Vec3 vector(force.at("x").get<double>(), force.at("y").get<double>(), force.at("z").get<double>());
    weight += std::abs(vector.z()), forces += vector.norm();
  }
  BOOST_TEST(std::abs(weight - 10) < 1e-5);
  BOOST_TEST(std::abs(length - forces / 10 * std::sqrt(0.75)) < 1e-5);
}

#endif

BOOST_AUTO_TEST_SUITE_END()
