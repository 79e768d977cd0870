// Processes as engines: the examples, and an engine that misbehaves in every known way. Each failure ends in one
// sentence and the right kind of failure, within the time limit and in bounded memory.
#include <signal.h>
#include <stdlib.h>

#include <boost/test/unit_test.hpp>
#include <chrono>
#include <cmath>
#include <regex>
#include <thread>

#include "adapters/plugin/plugins.h"
#include "adapters/plugin/process_engine.h"
#include "core/base/error.h"
#include "core/engine/engine.h"
#include "core/engine/engine_failure.h"
#include "generated/tests/places.h"
#include "tests/folder.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_plugin_process_engine)

namespace {

constexpr double kLimit = 2;  // s, of sleep or CPU time; Python takes a tenth of that to start

const std::string kExamples = RIGOR_SOURCE_DIR "/adapters/plugin/examples/";
const std::string kToy = "python3 " + kExamples + "toy.py";

std::string misbehaving(const std::string& mode) {
  return "python3 " RIGOR_SOURCE_DIR "/tests/adapters/plugin/misbehaving.py " + mode;
}

ProcessEngine engine_of(const std::string& command) { return ProcessEngine({command, kLimit, -1}); }

Scene drifting() {
  Scene scene = test::tumbling_body({1, 1, 1});
  return scene;
}

Settings settings_of(const Engine& engine) {
  Settings settings;
  settings.method = engine.info().methods.front().name;
  return settings;
}

struct Ending {
  std::string kind, sentence;
};

const char* word_of(FailureKind kind) {
  const char* words[] = {"unsupported", "diverged", "crashed", "timed-out", "invalid"};
  return words[static_cast<int>(kind)];
}

// Five steps and reads of a plug-in that misbehaves.
Ending end_of(const std::string& mode) {
  const ProcessEngine engine = engine_of(misbehaving(mode));
  try {
    const auto world = engine.load(drifting(), settings_of(engine));
    Snapshot now;
    for (int n = 0; n < 5; ++n) world->step(0.1), world->read(now);
    if (!std::isfinite(now.bodies().position(0).x())) return {"not finite", world->solver_warning()};
  } catch (const EngineFailure& failure) {
    return {word_of(failure.kind()), failure.what()};
  }
  return {"none", ""};
}

std::string why_refused(const std::string& command) {
  try {
    engine_of(command);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

void check_sentence(const std::string& sentence, const std::string& pattern) {
  BOOST_TEST(std::regex_search(sentence, std::regex(pattern)), sentence);
  const bool is_plain = sentence.find_first_of("\n\x1b\xff") == std::string::npos;
  BOOST_TEST(is_plain, "what a terminal would obey: " << sentence);
  BOOST_TEST(sentence.size() < 900u);
}

BodyTable state_after(World& world, double dt, int steps) {
  Snapshot now;
  for (int n = 0; n < steps; ++n) world.step(dt);
  world.read(now);
  return BodyTable(now.bodies());
}

}  // namespace

BOOST_AUTO_TEST_CASE(whatever_it_does_costs_the_cell_in_one_sentence) {
  struct Row {
    std::string mode, kind, sentence;
  };
  const std::vector<Row> rows = {
      {"load-unsupported", "unsupported", "no such thing"},
      {"load-failed", "crashed", "'load' failed: 'lost it'"},
      {"dies", "crashed", "exit code 7 before it had answered 'step'; its last words: 'fatal: out of cheese'"},
      {"segfaults", "crashed", "killed by SIGSEGV"},
      {"floods", "invalid", "a line of more than \\d+ bytes"},
      {"gigabyte", "invalid", "a line of more than \\d+ bytes"},
      {"not-utf8", "invalid", "not JSON"},
      {"text", "invalid", "the line 'Warning: \\\\x1b\\[31mdt too large' is not JSON"},
      {"twice", "invalid", "said something before it was asked|its time is not there"},
      {"empty", "invalid", "the line '' is not JSON"},
      {"list", "invalid", "not an object"},
      {"no-ok", "invalid", "no \"ok\""},
      {"other-world", "invalid", "its world is '77'"},
      {"other-call", "invalid", "its call is"},
      {"out-of-order", "invalid", "its call is '\"unload\"'"},
      {"diverges", "not finite", "diverged at 0.3 s: 'too fast'"},
      {"fails", "crashed", "'step' failed: 'lost it'"},
      {"sad", "invalid", "its status is 'sad'"},
      {"memory", "crashed", "MemoryError"},
      {"nan", "invalid", "not JSON"},
      {"null", "invalid", "px of body 0 is 'null'; a finite number is due"},
      {"string", "invalid", "px of body 0 is '\"0\"'"},
      {"few", "invalid", "its bodies are 0; a list of 1"},
      {"many", "invalid", "its bodies are 2; a list of 1"},
      {"short", "invalid", "thirteen numbers"},
      {"huge", "invalid", "not JSON|finite"},
      {"no-rows", "invalid", "a list of 1"},
      {"late", "invalid", "its time is 0.2"},
      {"nothing", "none", ""},
  };
  for (const Row& row : rows) {
    BOOST_TEST_CONTEXT(row.mode) {
      const Ending end = end_of(row.mode);
      BOOST_TEST(end.kind == row.kind, end.kind << ": " << end.sentence);
      check_sentence(end.sentence, row.sentence);
    }
  }
}

BOOST_AUTO_TEST_CASE(one_that_hangs_is_given_up_in_time) {
  for (const char* mode : {"hangs", "spins"}) {
    BOOST_TEST_CONTEXT(mode) {
      const auto begin = std::chrono::steady_clock::now();
      const Ending end = end_of(mode);
      BOOST_TEST(end.kind == "timed-out", end.sentence);
      check_sentence(end.sentence, "within the limit of 2 s|CPU time");
      // Two processes are started, and none may take more than ten limits by the clock, however busy the machine.
      BOOST_TEST(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() < 2 * 10 * kLimit);
    }
  }
  const Ending closed = end_of("closes");
  BOOST_TEST(closed.kind == "crashed");
  check_sentence(closed.sentence, "closed its stdout");
}

BOOST_AUTO_TEST_CASE(one_that_does_not_say_what_it_is_is_bad_input) {
  const std::vector<std::pair<std::string, std::string>> rows = {
      {misbehaving("info-ends"), "exit code 3 before it had answered 'info'"},
      {misbehaving("info-garbage"), "the line 'hello, \\\\x1b\\[31mworld' is not JSON"},
      {misbehaving("info-precision"), "precision: found '\"quad\"'; allowed: \"double\" or \"single\""},
      {misbehaving("info-methods"), "methods: found nothing; allowed: a list of at least one"},
      {misbehaving("info-version"), "rigor: found '2'; allowed: 1"},
      {misbehaving("info-name"), "name: found '\"a b:c\"'"},
      {misbehaving("info-order"), "methods\\[0\\].order: found '\"high\"'"},
      {misbehaving("info-refused"), "no licence"},
      {misbehaving("info-columns"), "columns: found '\"f32be\"'"},
      {"/there/is/no/such/engine", "exit code 127 .*not found"},
      {"true", "exit code 0"},
      {"cat", "no \"ok\""},
      {"echo '", "exit code 2 "},
  };
  for (const auto& [command, sentence] : rows)
    BOOST_TEST_CONTEXT(command) check_sentence(why_refused(command), sentence);
}

BOOST_AUTO_TEST_CASE(a_name_that_is_taken_is_refused) {
  EngineTable table = built_in_engines();
  BOOST_CHECK_EXCEPTION(add_plugin(table, misbehaving("info-clash"), kLimit), InputError, [](const InputError& error) {
    return std::string(error.what()).find("there are two engines called 'core'") != std::string::npos;
  });
  BOOST_CHECK_THROW(add_plugin(table, " ", kLimit), InputError);
}

BOOST_AUTO_TEST_CASE(the_environment_names_plug_ins_between_colons) {
  ::setenv("RIGOR_PLUGINS", ":a b::./c.so:", 1);
  BOOST_TEST(plugins_of_environment() == (std::vector<std::string>{"a b", "./c.so"}), boost::test_tools::per_element());
  ::unsetenv("RIGOR_PLUGINS");
  BOOST_TEST(plugins_of_environment().empty());
}

BOOST_AUTO_TEST_CASE(quoted_words_of_a_command_are_split_as_a_shell_does) {
  const Folder folder;
  const std::string file = folder.write("my engine.py", "import runpy\nrunpy.run_path('" + kExamples + "toy.py')\n");
  BOOST_TEST(engine_of("python3 '" + file + "'").info().name == "toy-py");
}

// Its options may state their defaults. One that no run could name is refused.
BOOST_AUTO_TEST_CASE(an_option_states_its_default) {
  const auto info_with = [](const std::string& option) {
    return read_plugin_info(R"({"ok":true,"name":"mine","version":"1","precision":"double","features":[],"methods":)"
                            R"([{"name":"euler","options":[)" +
                                option + "]}]}",
                            "mine");
  };
  const auto option_of = [&](const std::string& option) { return info_with(option).engine.methods[0].options[0]; };
  BOOST_TEST(default_text(option_of(R"({"name":"n","min":1,"max":9,"default":4,"stock_default":2})")) == "4; stock: 2");
  BOOST_TEST(default_text(option_of(R"({"name":"w","choices":["a","b"],"default":"b"})")) == "b");
  BOOST_TEST(default_text(option_of(R"({"name":"n","default":"as the scene asks"})")) == "as the scene asks");
  BOOST_TEST(default_text(option_of(R"({"name":"n"})")) == "");
  for (const char* bad : {R"({"name":"n","min":1,"max":9,"default":10})", R"({"name":"n","whole":true,"default":1.5})",
                          R"({"name":"w","choices":["a","b"],"default":"c"})", R"({"name":"n","default":true})"})
    BOOST_CHECK_THROW(info_with(bad), InputError);
}

BOOST_AUTO_TEST_CASE(wrenches_give_it_what_it_does_not_declare_itself) {
  const ProcessEngine toy = engine_of(kToy);
  const Features features = toy.info().features;
  for (const Feature feature : {Feature::wrench, Feature::spring, Feature::timed_force, Feature::fixed_body})
    BOOST_TEST(features.contains(feature));
  BOOST_TEST(!features.contains(Feature::joint_spring));  // it has no joints

  PluginInfo info = toy.plugin_info();
  const Scene scene = test::coupled_bodies(0.5);
  BOOST_TEST(
      (loads_left_to_rigor(scene, info).springs.size() == 2 && loads_left_to_rigor(scene, info).forces.size() == 1));
  info.declared.insert(Feature::spring);
  BOOST_TEST((loads_left_to_rigor(scene, info).springs.empty() && loads_left_to_rigor(scene, info).forces.size() == 1));
  info.declared = {Feature::timed_force};
  BOOST_TEST((loads_left_to_rigor(scene, info).springs.empty() && loads_left_to_rigor(scene, info).forces.empty()));
}

// An engine that computes springs itself may not know those whose stiffness grows: then no run is green by the rest.
BOOST_AUTO_TEST_CASE(wrenches_bring_quadratic_springs_only_where_rigor_computes_all_springs) {
  const auto has_them = [](const std::string& features) {
    const PluginInfo info =
        read_plugin_info(R"({"ok":true,"name":"mine","version":"1","precision":"double","features":[)" + features +
                             R"(],"methods":[{"name":"euler"}]})",
                         "mine");
    return info.engine.features.contains(Feature::quadratic_spring);
  };
  BOOST_TEST(has_them(R"("wrench","joint:hinge")"));
  BOOST_TEST(!has_them(R"("wrench","spring")"));
  BOOST_TEST(!has_them(R"("wrench","joint:hinge","joint-spring")"));
  BOOST_TEST(has_them(R"("wrench","spring","quadratic-spring")"));
  BOOST_TEST(!has_them(R"("spring")"));
}

// Steps of its own, one request each, and many in one: by a program that has raw columns, and one that has not.
BOOST_AUTO_TEST_CASE(a_run_of_many_steps_is_as_many_steps) {
  const Scene scene = test::tumbling_body();
  constexpr int kSteps = 2500;  // two and a half requests
  std::vector<std::string> commands = {kToy};
  if (RIGOR_HTML_REPORT) commands.push_back("node " + kExamples + "toy.mjs");  // a build without that has no Node
  for (const std::string& command : commands) {
    BOOST_TEST_CONTEXT(command) {
      const ProcessEngine engine = engine_of(command);
      const auto stepped = engine.load(scene, settings_of(engine)), run = engine.load(scene, settings_of(engine));
      for (const int every : {1, 33, kSteps}) {
        const auto bulk = engine.load(scene, settings_of(engine));
        bulk->capabilities().remote->expect(1e-3, kSteps, every);
        Snapshot now;
        for (int n = 1; n <= kSteps; ++n) {
          bulk->step(1e-3);
          if (n % every == 0 || n == kSteps) bulk->read(now);
        }
        const auto alone = engine.load(scene, settings_of(engine));
        const BodyTable due = state_after(*alone, 1e-3, kSteps);
        BOOST_TEST(now.time == kSteps * 1e-3);
        for (int c = 0; c < 13; ++c) BOOST_TEST(now.bodies().column(c)[0] == due.columns().column(c)[0]);
        bulk->step(0.25);  // and on, one by one
        bulk->read(now);
        BOOST_TEST(now.bodies().column(0)[0] == state_after(*alone, 0.25, 1).columns().column(0)[0]);
      }
    }
  }
}

// The toy diverges by itself where numbers overflow, in the middle of a run of many steps: what came before it is kept.
BOOST_AUTO_TEST_CASE(a_run_that_diverges_is_kept_to_its_last_finite_step) {
  const ProcessEngine engine = engine_of(kToy);
  Scene scene = test::tumbling_body({1, 1, 1});
  scene.gravity = {1e307, 0, 0};
  const auto world = engine.load(scene, settings_of(engine));
  world->capabilities().remote->expect(1, 100, 1);
  Snapshot now;
  int steps = 0;
  for (; steps < 100; ++steps) {
    world->step(1), world->read(now);
    if (!std::isfinite(now.bodies().position(0).x())) break;
  }
  // x after n steps of 1 s is n (n + 1) / 2 x 1e307 m; the largest number is 1.8e308, at n = 5 it is 1.5e308.
  BOOST_TEST(steps == 5);
  BOOST_TEST(world->solver_warning().find("diverged") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(it_ends_with_the_last_of_it_and_takes_what_it_started_along) {
  const Folder folder;
  const std::string note = (folder.path / "note").string();
  // A shell that starts another process and goes on to be the engine.
  const std::string script = folder.write("engine.sh", "sleep 1000 & echo $! > " + note + "\nexec " + kToy + "\n");
  const ProcessEngine engine = engine_of("sh " + script);
  const auto pid_in_note = [&] {
    std::ifstream file(note);
    pid_t pid = 0;
    file >> pid;
    return pid;
  };
  const pid_t of_info = pid_in_note();
  BOOST_REQUIRE(of_info > 1);
  engine.load(drifting(), settings_of(engine))->step(0.1);
  const pid_t of_world = pid_in_note();
  BOOST_TEST(of_world != of_info);
  engine.rest();
  for (const pid_t pid : {of_info, of_world}) {
    int waits = 0;  // whoever inherits a killed process has yet to bury it
    while (waits < 100 && ::kill(pid, 0) == 0) {
      std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
      std::string text((std::istreambuf_iterator<char>(stat)), {});
      if (text.find(") Z ") != std::string::npos) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(20)), ++waits;
    }
    BOOST_TEST(waits < 100);
  }
}

BOOST_AUTO_TEST_SUITE_END()
