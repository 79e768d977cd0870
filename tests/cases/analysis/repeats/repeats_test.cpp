// rigor repeat: each change is found by an engine that it disturbs, and the core repeats under all of them.
#include "cases/analysis/repeats/repeats.h"

#include <boost/test/unit_test.hpp>
#include <fstream>

#include "cases/analysis/repeats/hash_record.h"
#include "cases/analysis/repeats/reordered_scene.h"
#include "core/base/error.h"
#include "tests/core/dynamics/joints/jointed_run.h"
#include "tests/folder.h"
#include "tests/scenes.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(cases_analysis_repeats_repeats)

namespace {

int worlds_alive = 0, worlds_loaded = 0;

// How a world's number of roundings follows from what should not matter.
using Disturbance = int (*)(const Scene& scene);

// The core, with a little more gravity where it is disturbed.
class DisturbedEngine : public Engine {
 public:
  DisturbedEngine(Disturbance disturbance, bool sees_others) : disturbance_(disturbance), sees_others_(sees_others) {}
  EngineInfo info() const override {
    EngineInfo info = engines().info_of("core");
    info.name = "disturbed", info.is_in_house = false;
    return info;
  }
  std::string twin(const Settings&) const override { return ""; }
  std::unique_ptr<World> load(const Scene& scene, const Settings& settings) const override {
    Scene changed = scene;
    changed.gravity *= 1 + 1e-12 * disturbance_(scene);
    return std::make_unique<Counted>(engines().find("core").load(changed, settings), sees_others_);
  }

 private:
  class Counted : public World {
   public:
    Counted(std::unique_ptr<World> world, bool sees_others) : world_(std::move(world)), sees_others_(sees_others) {
      ++worlds_alive, ++worlds_loaded;
    }
    ~Counted() override { --worlds_alive; }
    void step(double dt) override { world_->step(dt + (sees_others_ && worlds_alive > 1 ? 1e-15 : 0)); }
    void read(Snapshot& out) const override { world_->read(out); }
    SettingsInForce settings_in_force() const override { return world_->settings_in_force(); }
    std::string solver_warning() const override { return world_->solver_warning(); }

   private:
    std::unique_ptr<World> world_;
    bool sees_others_;
  };
  Disturbance disturbance_;
  bool sees_others_;
};

Case case_of(Scene scene) {
  Case definition;
  definition.id = "test", definition.scene = std::move(scene), definition.duration = 1;
  return definition;
}

RepeatReport report_of(const EngineTable& table, const Scene& scene, const std::string& run) {
  return repeat(table, case_of(scene), parse_run_name(run, table.infos()), {0.01, "0.01"}, {1, 60, {}});
}

RepeatReport disturbed(Disturbance disturbance, bool sees_others = false) {
  EngineTable table = built_in_engines();
  table.add(std::make_unique<DisturbedEngine>(disturbance, sees_others));
  return report_of(table, coupled_bodies(0), "disturbed:rk4");
}

// The changes under which bits differ.
std::string differing(const RepeatReport& report) {
  std::string text;
  for (const RepeatOutcome& one : report.outcomes) {
    BOOST_TEST(!one.has_failed, one.change << ": " << one.why);
    if (one.difference && !text.ends_with(one.change + " ")) text += one.change + " ";
  }
  return text;
}

}  // namespace

BOOST_AUTO_TEST_CASE(an_engine_that_nothing_disturbs_repeats) {
  const RepeatReport report = disturbed([](const Scene&) { return 0; });
  BOOST_TEST(differing(report) == "");
  BOOST_TEST(report.repeats());
}

BOOST_AUTO_TEST_CASE(a_count_of_loaded_worlds_shows) {
  const RepeatReport report = disturbed([](const Scene&) { return worlds_loaded; });
  BOOST_TEST(!report.repeats());
  BOOST_TEST(differing(report).starts_with("again after-another "), differing(report));
}

BOOST_AUTO_TEST_CASE(a_second_world_in_the_process_shows) {
  const RepeatReport report = disturbed([](const Scene&) { return 0; }, true);
  BOOST_TEST(!report.repeats());
  BOOST_TEST(differing(report) == "beside-another ");
}

BOOST_AUTO_TEST_CASE(an_engine_that_looks_at_the_order_is_not_broken) {
  const RepeatReport report = disturbed([](const Scene& scene) { return scene.bodies[0].name == "upper" ? 0 : 1; });
  BOOST_TEST(differing(report) == "order ");
  BOOST_TEST(report.repeats());
  for (const RepeatOutcome& one : report.outcomes) {
    if (!one.difference) continue;
    BOOST_TEST(one.difference->step >= 1);
    BOOST_TEST(one.difference->position > 1e-13);
    BOOST_TEST(one.difference->position < 1e-9);
  }
}

BOOST_AUTO_TEST_CASE(an_engine_that_counts_its_bodies_shows_in_copies) {
  const RepeatReport report = disturbed([](const Scene& scene) { return scene.bodies.size() > 2 ? 1 : 0; });
  BOOST_TEST(differing(report) == "copies ");
  BOOST_TEST(report.repeats());
}

// The core, but it saves nothing of what it adds to each step, and has no room for many bodies.
class ForgetfulEngine : public Engine {
 public:
  EngineInfo info() const override {
    EngineInfo info = engines().info_of("core");
    info.name = "forgetful", info.is_in_house = false;
    return info;
  }
  std::string twin(const Settings&) const override { return ""; }
  std::unique_ptr<World> load(const Scene& scene, const Settings& settings) const override {
    if (scene.bodies.size() > 50) throw std::runtime_error("no memory for so many bodies");
    return std::make_unique<Aging>(engines().find("core").load(scene, settings));
  }

 private:
  class Aging : public World, public SavesState {
   public:
    explicit Aging(std::unique_ptr<World> world) : world_(std::move(world)) {}
    void step(double dt) override { world_->step(dt * (1 + 1e-15 * static_cast<double>(steps_++ % 100))); }
    void read(Snapshot& out) const override { world_->read(out); }
    SettingsInForce settings_in_force() const override { return world_->settings_in_force(); }
    std::string solver_warning() const override { return world_->solver_warning(); }
    Capabilities capabilities() override { return {.state = this}; }
    std::unique_ptr<SavedState> save() const override { return world_->capabilities().state->save(); }
    void restore(const SavedState& state) override { world_->capabilities().state->restore(state); }

   private:
    std::unique_ptr<World> world_;
    long steps_ = 0;
  };
};

BOOST_AUTO_TEST_CASE(a_save_that_leaves_something_out_shows) {
  EngineTable table = built_in_engines();
  table.add(std::make_unique<ForgetfulEngine>());
  const RepeatReport report = report_of(table, coupled_bodies(0), "forgetful:rk4");
  BOOST_TEST(!report.repeats());
  BOOST_TEST(differing(report) == "restored ");
}

// Four links at steps far too long: after the blow-up the kernels' NaNs have other signs.
BOOST_AUTO_TEST_CASE(a_blow_up_is_the_same_on_all_lanes) {
  Case definition;
  definition.id = "test", definition.scene = suite_scene("joints/mass-ratio-chain"), definition.duration = 1;
  const StepSize dt{1.0 / 30, "1/30"};
  const RepeatReport report =
      repeat(engines(), definition, parse_run_name("core:rk4", engines().infos()), dt, {1, 60, {}, {}, {"lanes"}});
  const RecordedStates states = base_states(engines(), definition, report.run, dt, 60);
  BOOST_TEST(std::isnan(states.values.back()));
  BOOST_TEST(report.repeats());
}

BOOST_AUTO_TEST_CASE(an_engine_without_memory_for_copies_is_not_broken) {
  EngineTable table = built_in_engines();
  table.add(std::make_unique<ForgetfulEngine>());
  const RepeatReport report = report_of(table, coupled_bodies(0), "forgetful:rk4");
  const auto copies = std::find_if(report.outcomes.begin(), report.outcomes.end(),
                                   [](const RepeatOutcome& one) { return one.change == "copies"; });
  BOOST_TEST_REQUIRE((copies != report.outcomes.end()));
  BOOST_TEST(!copies->is_run);
  BOOST_TEST(!copies->has_failed);
  BOOST_TEST(copies->why.starts_with("the engine cannot run so large a scene: "), copies->why);
  BOOST_TEST(copies->why.find("no memory for so many bodies") != std::string::npos, copies->why);
}

// Sums of loads depend on the order of rows and on the lanes that a body shares. Such differences are roundings.
BOOST_AUTO_TEST_CASE(the_core_repeats_but_for_roundings_of_its_order) {
  for (const Scene& scene : {coupled_bodies(0.2), dropped_sphere(0.5), tumbling_body()}) {
    const RepeatReport report = report_of(engines(), scene, "core:rk4,contact=event");
    BOOST_TEST(report.repeats());
    for (const RepeatOutcome& one : report.outcomes) {
      BOOST_TEST((!one.must_hold || !one.difference), one.change << " " << one.label);
      BOOST_TEST((!one.difference || one.is_like_rounding), one.change << " " << one.label);
    }
  }
}

BOOST_AUTO_TEST_CASE(another_order_is_the_same_scene) {
  Scene scene = coupled_bodies(0);
  const ReorderedScene other = reordered(scene, 3);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    BOOST_TEST(other.scene.bodies[other.places[i]].name == scene.bodies[i].name);
  for (const Spring& spring : scene.springs) {
    const bool is_there = std::any_of(other.scene.springs.begin(), other.scene.springs.end(), [&](const Spring& own) {
      return other.scene.body_name(own.a) == scene.body_name(spring.a) &&
             other.scene.body_name(own.b) == scene.body_name(spring.b) && own.stiffness == spring.stiffness;
    });
    BOOST_TEST(is_there);
  }
}

BOOST_AUTO_TEST_CASE(a_hash_sees_each_bit) {
  RecordedStates states;
  states.bodies = 2;
  for (int k = 0; k < 2 * 26; ++k) states.values.push_back(0.1 * k);
  const auto due = hashes_of(states);
  BOOST_TEST(due.size() == 2u);
  for (std::size_t k = 0; k < states.values.size(); ++k) {
    RecordedStates other = states;
    other.values[k] = std::nextafter(other.values[k], 100);
    const auto found = hashes_of(other);
    BOOST_TEST(found[k / 26] != due[k / 26], k);
    BOOST_TEST(found[1 - k / 26] == due[1 - k / 26], k);
  }
  RecordedStates zero = states;
  zero.values[0] = -0.0;
  BOOST_TEST(hashes_of(zero)[0] != due[0]);
}

BOOST_AUTO_TEST_CASE(hashes_go_through_a_file_and_others_are_refused) {
  const Folder folder;
  const Case definition = case_of(tumbling_body());
  const RunName run = parse_run_name("core:rk4", engines().infos());
  const HashRecord own =
      hash_record(definition, run, engines().info_of("core"), {0.01, "0.01"}, {1, 0xfedcba9876543210, 3});
  const auto written = [&](const std::string& text) {
    folder.write("hashes.jsonl", text);
    return (folder.path / "hashes.jsonl").string();
  };
  const std::string path = written(line_of(own));
  BOOST_TEST(matching_record(read_hash_records(path), own, path).hashes == own.hashes,
             boost::test_tools::per_element());
  const auto refuses = [&](const HashRecord& other, const std::string& expected) {
    BOOST_CHECK_EXCEPTION(
        matching_record(read_hash_records(written(line_of(other))), own, path), InputError,
        [&](const InputError& error) { return std::string(error.what()).find(expected) != std::string::npos; });
  };
  HashRecord other = own;
  other.case_id = "another", refuses(other, "has no hashes of test");
  other = own, other.version = "0.1", refuses(other, "version '0.1'");
  other = own, other.dt = "1/3", refuses(other, "dt '1/3'");
  other = own, other.scene = "0", refuses(other, "case file");
  other = own, other.hashes.pop_back(), refuses(other, "1 steps");
  for (const char* text : {"", "no JSON\n", "{}\n", "{\"rigor_hashes\":3}\n", "{\"rigor_hashes\":2}\n"})
    BOOST_CHECK_THROW(read_hash_records(written(text)), InputError);
}

// An arm with a gear, and a body on a compound joint beside a hinge. A lost or misplaced row would move them by metres.
BOOST_AUTO_TEST_CASE(couplings_and_compound_joints_keep_their_joints_in_another_order_and_in_copies) {
  Scene rooted = suite_scene("joints/compound-root");
  Body rod = body("rod", 1, 0.1 * Vec3::Ones(), {5, 0, 0});
  rooted.joints.insert(rooted.joints.begin(), {.a = kWorld, .b = 1, .type = HingeJoint{{5, 0, 1}, Vec3::UnitY()}});
  for (Motor& motor : rooted.motors) ++motor.joint;
  rooted.bodies.push_back(rod);
  for (const Scene& scene : {suite_scene("transmissions/geared-arm"), rooted}) {
    const auto apart = [&](const Scene& other, const std::vector<std::size_t>& places, const Vec3& offset) {
      const BodyTable own = state_after(scene, "dormand-prince", 0.01, 1),
                      moved = state_after(other, "dormand-prince", 0.01, 1);
      double most = 0;
      for (std::size_t i = 0; i < places.size(); ++i)
        most = std::max(most, (moved.columns().position(static_cast<int>(places[i])) - offset -
                               own.columns().position(static_cast<int>(i)))
                                  .norm());
      return most;
    };
    bool is_moved = false;
    for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
      const ReorderedScene other = reordered(scene, seed);
      is_moved |= other.scene.joints[0].type.index() != scene.joints[0].type.index() ||
                  other.scene.joints[0].name != scene.joints[0].name;
      BOOST_TEST(apart(other.scene, other.places, Vec3::Zero()) < 1e-9);  // the method's tolerance is 1e-12
    }
    BOOST_TEST(is_moved);
    const Vec3 offset(0, 64, 0);
    const CopiedScene copies = copied(scene, 3, offset);
    BOOST_TEST(copies.scene.couplings.size() == 3 * scene.couplings.size());
    for (std::size_t k = 0; k < 3; ++k)
      BOOST_TEST(apart(copies.scene, copies.places[k], static_cast<double>(k) * offset) < 1e-9);
  }
}

BOOST_AUTO_TEST_SUITE_END()
