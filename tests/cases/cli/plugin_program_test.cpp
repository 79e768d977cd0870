// The program with engines from outside: each has its column and its status, and no gate holds for one that did not
// run.
#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "tests/cases/cli/program.h"

using namespace rigor;

namespace {

constexpr const char* kGate = R"([[gate]]
metric = "position_error"
max = 1
because = "a first-order step misses 0.5 m"
)";

const std::string kToy = "python3 " RIGOR_SOURCE_DIR "/adapters/plugin/examples/toy.py";

std::string misbehaving(const std::string& mode) {
  return "python3 " RIGOR_SOURCE_DIR "/tests/adapters/plugin/misbehaving.py " + mode;
}

struct Fixture : Program {
  std::string suite = path("suite"), out = path("out");

  Fixture() { folder.write("suite/air/stone.toml", std::string(kThrown) + kGate); }

  Answer run(const std::string& words) const {
    const std::string in = folder.path.string();
    const std::string command =
        std::string(RIGOR_PROGRAM) + " " + words + " >" + in + "/stdout 2>" + in + "/stderr </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content("stdout"), content("stderr")};
  }
  Answer on_suite(const std::string& words) const { return run(words + " --suite " + suite + " --out " + out); }
  nlohmann::json cells() const { return nlohmann::json::parse(content("out/results.json")).at("cells"); }
};

}  // namespace

BOOST_FIXTURE_TEST_SUITE(cases_cli_plugin_program, Fixture)

BOOST_AUTO_TEST_CASE(it_has_a_column_and_meets_gates_like_any_other) {
  const Answer answer = on_suite("gate --jobs 1 --engine toy-py --engine toy-c --plugin '" + kToy +
                                 "' --plugin " RIGOR_BUILD_DIR "/plugins/toy.so");
  BOOST_TEST(answer.code == 0, answer.out << answer.err);
  BOOST_TEST(cells().size() == 2u);
  for (const auto& cell : cells()) BOOST_TEST(cell.at("status") == "pass");
  BOOST_TEST(answer.out.find("toy-py") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(both_its_tracks_take_part_by_default) {
  const Answer answer = on_suite("run --jobs 1 --plugin '" + kToy + "'");
  BOOST_TEST(answer.code == 0);
  for (const char* name : {"toy-py ", "toy-py@stock"}) BOOST_TEST(answer.out.find(name) != std::string::npos, name);
}

BOOST_AUTO_TEST_CASE(what_it_does_wrong_is_the_status_of_its_cell) {
  struct Row {
    std::string mode, status, reason;
    int run, gate;
  };
  const std::vector<Row> rows = {
      {"dies", "crashed", "exit code 7", 3, 3},    {"text", "invalid", "Warning: \\x1b[31mdt too large", 0, 1},
      {"diverges", "diverged", "too fast", 0, 1},  {"load-unsupported", "unsupported", "no such thing", 0, 1},
      {"load-failed", "crashed", "lost it", 3, 3}, {"hangs", "timed-out", "did not answer 'step'", 3, 3},
  };
  for (const Row& row : rows) {
    BOOST_TEST_CONTEXT(row.mode) {
      const std::string words = " --timeout 5 --jobs 1 --engine bad --plugin '" + misbehaving(row.mode) + "'";
      const Answer answer = on_suite("run" + words);
      BOOST_TEST(answer.code == row.run, answer.err);
      const auto cell = cells().at(0);
      BOOST_TEST(cell.at("status") == row.status);
      const std::string reason = cell.at("reason");
      BOOST_TEST(reason.find(row.reason) != std::string::npos, reason);
      BOOST_TEST(on_suite("gate" + words).code == row.gate);
    }
  }
}

BOOST_AUTO_TEST_CASE(the_environment_adds_engines_too) {
  ::setenv("RIGOR_PLUGINS", (kToy + ":" RIGOR_BUILD_DIR "/plugins/toy.so").c_str(), 1);
  const Answer answer = run("list engines");
  const Answer traced =
      run("trace " + folder.path.string() + "/suite/air/stone.toml --engine toy-c --dt 1/10 --every 10");
  ::unsetenv("RIGOR_PLUGINS");
  BOOST_TEST((answer.out.find("toy-py") != std::string::npos && answer.out.find("toy-c") != std::string::npos));
  BOOST_TEST(traced.code == 0, traced.err);
  // After ten steps: x = 1 m, y = -g dt² n (n + 1) / 2 = -5.5 m.
  const std::size_t last = traced.out.rfind("\n", traced.out.size() - 2);
  double time = 0, x = 0, y = 0;
  BOOST_TEST(std::sscanf(traced.out.c_str() + last + 1, "%lf,stone,%lf,%lf", &time, &x, &y) == 3);
  BOOST_TEST((std::abs(time - 1) < 1e-12 && std::abs(x - 1) < 1e-12 && std::abs(y + 5.5) < 1e-12));
}

BOOST_AUTO_TEST_CASE(one_that_cannot_be_had_is_bad_input_before_the_grid) {
  for (const std::string& plugin :
       {misbehaving("info-garbage"), misbehaving("info-clash"), std::string("/no/such/engine.so"),
        std::string("/no/such/engine"), std::string(" ")}) {
    const Answer answer = on_suite("run --plugin '" + plugin + "'");
    BOOST_TEST(answer.code == 2, plugin);
    BOOST_TEST(answer.err.find("rigor: plug-in '") + answer.err.find("rigor: a plug-in is") != 2 * std::string::npos);
    BOOST_TEST(!std::filesystem::exists(out));
  }
}

BOOST_AUTO_TEST_CASE(conform_answers_by_its_exit_code) {
  const Answer good = run("conform --plugin '" + kToy + "'");
  BOOST_TEST(good.code == 0, good.out);
  BOOST_TEST(good.out.find("toy-py conforms") != std::string::npos);
  const Answer bad = run("conform --json --plugin '" + misbehaving("still") + "'");  // its bodies stand still
  BOOST_TEST(bad.code == 1);
  const auto told = nlohmann::json::parse(bad.out);
  BOOST_TEST(told.at("conforms") == false);
  int broken = 0;
  for (const auto& check : told.at("checks")) {
    if (check.at("answer") != "broken") continue;
    ++broken;
    for (const char* key : {"sent", "came", "due"}) BOOST_TEST(!check.at(key).get<std::string>().empty());
  }
  BOOST_TEST(broken >= 3);
  BOOST_TEST(run("conform").code == 2);
  BOOST_TEST(run("conform --engine core").code == 0);
  // One that dies is found out check by check, and one that hangs once.
  BOOST_TEST(run("conform --plugin '" + misbehaving("dies") + "'").code == 1);
  BOOST_TEST(run("conform --timeout 3 --plugin '" + misbehaving("hangs") + "'").code == 1);
}

BOOST_AUTO_TEST_SUITE_END()
