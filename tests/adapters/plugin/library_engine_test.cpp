// Shared libraries as engines: the example compared with the same steps as a process, and a library that misbehaves.
// Crashes, exceptions and exits happen in a child process here, like those of a grid's cell.
#include <stdlib.h>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <cstdlib>
#include <regex>

#include "adapters/plugin/library_engine.h"
#include "adapters/plugin/plugins.h"
#include "cases/runner/process_pool.h"
#include "core/base/error.h"
#include "core/base/sanitizers.h"
#include "core/engine/engine_failure.h"
#include "generated/tests/places.h"
#include "tests/folder.h"
#include "tests/saved_runs.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_plugin_library_engine)

namespace {

constexpr double kLimit = 3;  // s
const std::string kToy = RIGOR_BUILD_DIR "/plugins/toy.so", kMisbehaving = RIGOR_BUILD_DIR "/plugins/misbehaving.so";

struct Misbehaviour {
  explicit Misbehaviour(const std::string& mode) { ::setenv("RIGOR_MISBEHAVES", mode.c_str(), 1); }
  ~Misbehaviour() { ::unsetenv("RIGOR_MISBEHAVES"); }
};

Settings settings_of(const Engine& engine) {
  Settings settings;
  settings.method = engine.info().methods.front().name;
  return settings;
}

std::string why_refused(const std::string& path) {
  try {
    LibraryEngine(path, kLimit);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

void check_sentence(const std::string& sentence, const std::string& pattern) {
  BOOST_TEST(std::regex_search(sentence, std::regex(pattern)), sentence);
}

void five_steps(const Channel& channel) {
  const LibraryEngine engine(kMisbehaving, kLimit);
  try {
    const auto world = engine.load(test::tumbling_body(), settings_of(engine));
    Snapshot now;
    for (int n = 0; n < 5; ++n) world->step(0.1), world->read(now);
    channel.send(std::isfinite(now.bodies().position(0).x()) ? "none" : "not finite: " + world->solver_warning());
  } catch (const EngineFailure& failure) {
    const char* words[] = {"unsupported", "diverged", "crashed", "timed-out", "invalid"};
    channel.send(std::string(words[static_cast<int>(failure.kind())]) + ": " + failure.what());
  }
}

// The result of five steps of it, in a child.
std::string end_of(const std::string& mode) {
  const Misbehaviour misbehaviour(mode);
  std::string said;
  run_jobs(
      {{five_steps, 10}}, 1, [&](std::size_t, const std::string& message) { said = message; },
      [&](std::size_t, const JobEnd& end) {
        if (end.how != Ending::finished) said = sentence_of(end, 10);
      });
  return said;
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_example_steps_as_the_process_does) {
  EngineTable table;
  add_plugin(table, kToy, 30);
  add_plugin(table, "python3 " RIGOR_SOURCE_DIR "/adapters/plugin/examples/toy.py", 30);
  const Engine &library = table.find("toy-c"), &process = table.find("toy-py");
  for (const Scene& scene : {test::tumbling_body(), test::coupled_bodies(0.5)}) {
    const auto a = library.load(scene, settings_of(library)), b = process.load(scene, settings_of(process));
    for (int n = 0; n < 100; ++n) a->step(0.01), b->step(0.01);
    Snapshot one, other;
    a->read(one), b->read(other);
    BOOST_TEST(one.time == other.time);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      // The same formulas, summed up in another order: a hundred roundings of numbers below ten.
      BOOST_TEST((one.bodies().position(i) - other.bodies().position(i)).norm() < 1e-12);
      BOOST_TEST((one.bodies().angular_velocity(i) - other.bodies().angular_velocity(i)).norm() < 1e-12);
      BOOST_TEST((one.bodies().position(i) - scene.bodies[i].position).norm() > 0.01);  // it has been somewhere
    }
  }
}

// As an author finds it: C11 without extensions, from where cmake --install has put it.
BOOST_AUTO_TEST_CASE(the_header_is_installed_and_is_plain_c) {
  const Folder folder;
  const std::string in = folder.path.string();
  const auto does = [&](const std::string& command) {
    return std::system((command + " >/dev/null 2>&1").c_str()) == 0;
  };
  BOOST_TEST(does("cmake --install " RIGOR_BUILD_DIR " --component plugin --prefix " + in));
  for (const char* file : {"include/rigor_engine.h", "share/rigor/scene.schema.json", "share/rigor/examples/toy.py"})
    BOOST_TEST(std::filesystem::exists(folder.path / file), file);
  folder.write("engine.c", "#include <rigor_engine.h>\nint size(void) { return (int)sizeof(rigor_engine_v1); }\n");
  const std::string compile = "cc -std=c11 -pedantic -Wall -Wextra -Werror -c -I " + in + "/include -o " + in;
  BOOST_TEST(does(compile + "/engine.o " + in + "/engine.c"));
}

BOOST_AUTO_TEST_CASE(one_that_does_not_say_what_it_is_is_bad_input) {
  const std::vector<std::pair<std::string, std::string>> rows = {
      {"load-crashes", "was killed by SIGSEGV when it was loaded"},
      {"load-exits", "called exit\\(5\\) when it was loaded"},
      {"load-hangs", "within the limit of 3 s"},
      {"info-throws", "threw an exception"},
      {"info-garbage", "'hello' is not JSON"},
      {"info-fails", "does not say what it is: 'no licence'"},
      {"other-abi", "does not speak version 1"},
      {"small-struct", "a struct of 16 bytes; version 1 of rigor_engine.h has 48"},
      {"no-step", "leaves out one of info, load, step, read and unload"},
  };
  for (const auto& [mode, sentence] : rows) {
    const Misbehaviour misbehaviour(mode);
    BOOST_TEST_CONTEXT(mode) check_sentence(why_refused(kMisbehaving), sentence);
  }
  check_sentence(why_refused("/there/is/no/engine.so"), "cannot be loaded: .*No such file");
  check_sentence(why_refused(Folder().write("text.so", "no library")), "cannot be loaded: ");
  check_sentence(why_refused("/lib/x86_64-linux-gnu/libm.so.6"), "has no function rigor_engine_entry");
}

// The number of its contacts after a step, or why there is none.
std::string contacts_of(const std::string& mode) {
  const Misbehaviour misbehaviour(mode);
  std::string said;
  const auto work = [](const Channel& channel) {
    const LibraryEngine engine(kMisbehaving, kLimit);
    try {
      const auto world = engine.load(test::tumbling_body(), settings_of(engine));
      if (!ask_for_contacts(*world)) return channel.send("reports none");
      world->step(0.1);
      const std::vector<ReportedContact> contacts = reported_contacts(*world);
      channel.send(std::to_string(contacts.size()) + ", the last at " + std::to_string(contacts.back().point.x()));
    } catch (const EngineFailure& failure) {
      channel.send(failure.what());
    }
  };
  run_jobs(
      {{work, 10}}, 1, [&](std::size_t, const std::string& message) { said = message; },
      [&](std::size_t, const JobEnd& end) {
        if (end.how != Ending::finished) said = sentence_of(end, 10);
      });
  return said;
}

BOOST_AUTO_TEST_CASE(contacts_are_read_with_as_much_room_as_they_need) {
  check_sentence(contacts_of("contacts"), "^300, the last at 299");
  check_sentence(contacts_of(""), "^reports none$");
  check_sentence(contacts_of("contacts-old-struct"), "^reports none$");
  check_sentence(contacts_of("contacts-fail"), "'contacts' failed: 'no memory for them'");
  check_sentence(contacts_of("contacts-crowd"), "it counts 5000000 contacts of one step");
  check_sentence(contacts_of("contacts-overrun"), "it wrote past its room of 256 contacts");
}

BOOST_AUTO_TEST_CASE(the_example_goes_on_from_a_saved_state) {
  const LibraryEngine engine(kToy, kLimit);
  const auto world = engine.load(test::tumbling_body(), settings_of(engine)),
             fresh = engine.load(test::tumbling_body(), settings_of(engine));
  const test::SavedRun saved = test::saved_run(*world, 0.01, 30, 10);
  BOOST_TEST(test::restored_apart(*fresh, saved) == "");
  BOOST_TEST(test::restored_apart(*world, saved) == "");
  Scene heavier = test::tumbling_body();
  heavier.bodies[0].mass *= 2;
  const auto other = engine.load(heavier, settings_of(engine));
  BOOST_CHECK_THROW(other->capabilities().state->restore(*saved.saved[0]), InputError);
}

// Saves after two steps, restores after two more, and says which time the world then has.
std::string restored_time(const std::string& mode) {
  const Misbehaviour misbehaviour(mode);
  std::string said;
  const auto work = [](const Channel& channel) {
    const LibraryEngine engine(kMisbehaving, kLimit);
    try {
      const auto world = engine.load(test::tumbling_body(), settings_of(engine));
      SavesState* state = world->capabilities().state;
      if (!state) return channel.send("saves none");
      world->step(0.25), world->step(0.25);
      const auto saved = state->save();
      world->step(0.25), world->step(0.25);
      state->restore(*saved);
      Snapshot now;
      world->read(now);
      channel.send(std::to_string(now.time));
    } catch (const EngineFailure& failure) {
      channel.send(failure.what());
    }
  };
  run_jobs(
      {{work, 10}}, 1, [&](std::size_t, const std::string& message) { said = message; },
      [&](std::size_t, const JobEnd& end) {
        if (end.how != Ending::finished) said = sentence_of(end, 10);
      });
  return said;
}

BOOST_AUTO_TEST_CASE(states_are_saved_with_as_much_room_as_they_need) {
  check_sentence(restored_time("save"), "^0.5");
  check_sentence(restored_time(""), "^saves none$");
  check_sentence(restored_time("save-alone"), "^saves none$");
  check_sentence(restored_time("save-old-struct"), "^saves none$");
  check_sentence(restored_time("save-fails"), "'save' failed: 'no room for it'");
  check_sentence(restored_time("save-crowds"), "it saves 2000000000 bytes");
  check_sentence(restored_time("save-grows"), "it first counted 8192 bytes and then 16384");
  check_sentence(restored_time("save-overruns"), "it wrote past its room of 4096 bytes");
  check_sentence(restored_time("save-unread"), "'restore' failed: 'that is none of mine'");
}

BOOST_AUTO_TEST_CASE(whatever_it_does_costs_the_cell_in_one_sentence) {
  const std::vector<std::pair<std::string, std::string>> rows = {
      {"", "^none$"},
      {"unsupported", "^unsupported: .*no such thing"},
      {"no-world", "^invalid: .*it set no world"},
      {"throws", "exception: out of cheese"},
      {"memory", "exception: std::bad_alloc"},
      {"exits", "called exit\\(0\\) before"},
      {"segfaults", "killed by SIGSEGV"},
      {"fails", "^crashed: .*'step' failed: 'lost it'"},
      {"diverges", "^not finite: .*diverged: 'too fast'"},
      {"status", "^invalid: .*its status is 17"},
      {"long-text", "^invalid: .*wrote past its room"},
      {"late", "^invalid: .*its time is 0"},
      {"leaves-out", "^invalid: .*qy of a body is not finite, or was not written"},
      {"overruns", "^invalid: .*outside its column vx"},
      {"underruns", "^invalid: .*outside its column v|^invalid: .*outside its column qz"},
      {"nan", "^invalid: .*pz of a body is not finite"},
  };
  for (const auto& [mode, sentence] : rows) {
    if (mode == "memory" && kHasAddressSanitizer) continue;  // its memory has no limit there
    BOOST_TEST_CONTEXT(mode) check_sentence(end_of(mode), sentence);
  }
}

BOOST_AUTO_TEST_SUITE_END()
