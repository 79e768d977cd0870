// The program with engines from outside: each has its column and its status, and no gate holds for an engine that did
// not run.
#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "tests/cases/cli/program.h"

using namespace rigor;

namespace cases_cli_plugin_program {

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

}  // namespace cases_cli_plugin_program

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

BOOST_AUTO_TEST_CASE(one_that_says_things_otherwise_but_rightly_is_understood) {
  for (const std::string mode : {"sparse", "rich"}) {
    BOOST_TEST_CONTEXT(mode) {
      const std::string plugin =
          " --engine " + mode + " --plugin 'python3 " RIGOR_SOURCE_DIR "/tests/adapters/plugin/legal.py " + mode + "'";
      const Answer answer = on_suite("gate --jobs 1" + plugin);
      BOOST_TEST(answer.code == 0, answer.out << answer.err);
      BOOST_TEST_REQUIRE(cells().size() == 1u);
      BOOST_TEST(cells()[0].at("status") == "pass", answer.out);
      // A step of 1 s, after which every number is whole.
      const Answer traced = run("trace " + folder.path.string() + "/suite/air/stone.toml --dt 1" + plugin);
      BOOST_TEST(traced.code == 0, traced.err);
      BOOST_TEST(traced.out.find("\n1,stone,1,-10,0,1,0,0,0,1,-10,0,0,0,0\n") != std::string::npos, traced.out);
    }
  }
}

// Every command that runs engines takes them.
BOOST_AUTO_TEST_CASE(sweep_and_tune_take_it_too) {
  const std::string toy = " --engine toy-py --plugin '" + kToy + "'",
                    stone = folder.path.string() + "/suite/air/stone.toml";
  const Answer swept = run("sweep " + stone + " --vary dt=1/10,1/20 --jobs 1 --out " + out + toy);
  BOOST_TEST(swept.code == 0, swept.err);
  BOOST_TEST(content("out/sweep.csv").find("toy-py") != std::string::npos);
  const Answer tuned =
      run("tune " + stone + " --within 1m --jobs 1 --engine toy-c --plugin " RIGOR_BUILD_DIR "/plugins/toy.so");
  BOOST_TEST(tuned.code == 0, tuned.out << tuned.err);
}

// The toy with its angular velocity told in the body's frame, as engines that keep it there are wont to.
BOOST_AUTO_TEST_CASE(what_its_mistake_looks_like_is_said) {
  std::ifstream file(RIGOR_SOURCE_DIR "/adapters/plugin/examples/toy.py");
  std::string toy((std::istreambuf_iterator<char>(file)), {});
  const std::string right = "body.x + body.q + body.v + body.w for",
                    wrong = "body.x + body.q + body.v + turn([body.q[0]] + [-a for a in body.q[1:]], body.w) for";
  BOOST_TEST_REQUIRE(toy.find(right) != std::string::npos);
  toy.replace(toy.find(right), right.size(), wrong);
  const std::string plugin = " --plugin 'python3 " + folder.write("broken.py", toy) + "'";
  const std::string mistake = "angular velocity read in the body frame";

  const Answer all = run("diagnose --json --jobs 2" + plugin);
  BOOST_TEST(all.code == 0, all.err);
  const auto told = nlohmann::json::parse(all.out);
  BOOST_TEST(told.at("verdict") == "named", all.out);
  BOOST_TEST(told.at("suspects").at(0).at("mistakes").at(0) == mistake);
  BOOST_TEST(told.at("suspects").at(0).at("explains").get<double>() > 0.99);

  const Answer one = run("diagnose ballistic/projectile --jobs 2" + plugin);
  BOOST_TEST(one.code == 0, one.err);
  BOOST_TEST(one.out.find("looks like: " + mistake) != std::string::npos, one.out);
  const Answer conform = run("conform --jobs 2" + plugin);
  BOOST_TEST(conform.code == 1);
  BOOST_TEST(conform.out.find("looks like: " + mistake) != std::string::npos, conform.out);
}

BOOST_AUTO_TEST_CASE(a_diagnosis_of_what_is_right_or_is_not_there) {
  const Answer right = run("diagnose springs/fixed-spring --engine ode --jobs 2");
  BOOST_TEST(right.code == 0, right.err);
  BOOST_TEST(right.out.find("no error beyond what its scheme makes") != std::string::npos, right.out);
  BOOST_TEST(run("diagnose no/such/case --engine ode").code == 2);
  BOOST_TEST(run("diagnose springs/fixed-spring").code == 2);
  BOOST_TEST(run("diagnose springs/fixed-spring --engine odd").code == 2);
  // One that dies of everything has no motion: that is said, and no mistake is named.
  const Answer dead = run("diagnose --plugin '" + misbehaving("dies") + "'");
  BOOST_TEST(dead.code == 0, dead.err);
  BOOST_TEST(dead.out.find("looks like:") == std::string::npos, dead.out);
  BOOST_TEST(dead.out.find("exit code 7") != std::string::npos, dead.out);
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
