// The search for the largest stable step, with an engine that is stable exactly at prescribed steps.
#include <boost/test/unit_test.hpp>

#include "cases/runner/stable_step.h"
#include "tests/cases/scripted_engine.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_runner_stable_step_search)

namespace {

struct Tried {
  double dt;
  long steps;
};

class FussyWorld : public World {
 public:
  FussyWorld(const std::function<bool(double)>& holds, std::vector<Tried>& tried, std::size_t bodies)
      : holds_(holds), tried_(tried), bodies_(bodies) {
    for (std::size_t i = 0; i < bodies; ++i) bodies_.columns().set_orientation(i, Quat::Identity());
  }
  void step(double dt) override {
    if (clock_.time() == 0) tried_.push_back({dt, 0});
    ++tried_.back().steps;
    dt_ = dt, clock_.advance(dt);
  }
  void read(Snapshot& out) const override {
    out.time = clock_.time();
    out.borrow(bodies_.columns());
  }
  SettingsInForce settings_in_force() const override { return {}; }
  std::string solver_warning() const override { return dt_ > 0 && !holds_(dt_) ? "fails" : ""; }

 private:
  const std::function<bool(double)>& holds_;
  std::vector<Tried>& tried_;
  BodyTable bodies_;
  Clock clock_;
  double dt_ = 0;
};

class FussyEngine : public Engine {
 public:
  explicit FussyEngine(std::function<bool(double)> holds, bool is_adaptive = false)
      : holds_(std::move(holds)), is_adaptive_(is_adaptive) {}
  EngineInfo info() const override {
    EngineInfo info;
    info.name = "fussy";
    info.methods.emplace_back().adaptive = is_adaptive_;
    return info;
  }
  std::string twin(const Settings&) const override { return ""; }
  std::unique_ptr<World> load(const Scene& scene, const Settings&) const override {
    return std::make_unique<FussyWorld>(holds_, tried, scene.bodies.size());
  }
  mutable std::vector<Tried> tried;

 private:
  std::function<bool(double)> holds_;
  bool is_adaptive_;
};

Scene one_body() {
  Scene scene;
  scene.bodies = {test::body("b", 1, {1, 1, 1})};
  return scene;
}

Scene sprung() {
  Scene scene = one_body();
  scene.springs = {test::spring(kWorld, {0, 0, 0}, 0, {0, 0, 0}, 1, 0)};
  return scene;
}

Scene jointed(double stiffness) {
  Scene scene = one_body();
  scene.joints = {{.a = kWorld, .b = 0, .type = HingeJoint{Vec3::Zero(), Vec3::UnitZ()}, .stiffness = stiffness}};
  return scene;
}

Scene touching() {
  Scene scene = test::dropped_sphere(1);
  scene.gravity.setZero();
  return scene;
}

StableStep found_by(const FussyEngine& engine, const Scene& scene, double horizon = 5) {
  return largest_stable_dt(engine, {}, scene, horizon, 1);
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_limit_is_found_from_below_to_a_hundredth_and_to_five_where_steps_are_tried_far_apart) {
  struct Row {
    const char* what;
    Scene scene;
    double precision;
  };
  for (const Row& row : {Row{"free", one_body(), 1.01},
                         {"sprung", sprung(), 1.01},
                         {"a joint with a spring", jointed(1), 1.01},
                         {"a joint", jointed(0), 1.05},
                         {"touching", touching(), 1.05}}) {
    for (const double limit : {0.45, 0.0371, 0.0021, 2.1e-4}) {
      if (limit < 0.01 && !row.scene.joints.empty()) continue;  // their searches end by the work that they take
      const FussyEngine engine([=](double dt) { return dt <= limit; });
      const StableStep found = found_by(engine, row.scene);
      BOOST_TEST_CONTEXT(row.what << ", " << limit << " s: " << found.dt) {
        BOOST_TEST(found.dt <= limit);
        BOOST_TEST(found.dt * row.precision >= limit);
        BOOST_TEST((!found.is_cap && !found.is_floor && found.cut.empty()));
      }
    }
  }
}

// Over the factor of two below 0.1 s, the result of the bisection. A band 4 % wide is not skipped if springs may
// resonate with a step.
BOOST_AUTO_TEST_CASE(a_narrow_band_of_instability_ends_the_rise) {
  for (const double from : {0.0515, 0.0555, 0.0712, 0.0912}) {
    const FussyEngine engine([=](double dt) { return dt < 0.1 && (dt < from || dt > 1.04 * from); });
    const StableStep found = found_by(engine, sprung());
    BOOST_TEST(found.dt < from);
    BOOST_TEST(found.dt * 1.01 >= from);
  }
}

BOOST_AUTO_TEST_CASE(it_goes_down_by_halves_until_a_step_and_its_double_hold) {
  // 1/8 s holds, half of it does not: that is luck.
  const FussyEngine engine([](double dt) { return dt == 0.125 || dt <= 0.04; });
  const StableStep found = found_by(engine, one_body());
  const double expected[] = {0.5, 0.25, 0.125, 0.0625, 0.03125, 0.015625};
  BOOST_TEST_REQUIRE(engine.tried.size() > 6);
  for (std::size_t n = 0; n < 6; ++n) BOOST_TEST(engine.tried[n].dt == expected[n]);
  BOOST_TEST(engine.tried[6].dt == std::sqrt(0.03125 * 0.0625), boost::test_tools::tolerance(1e-12));
  BOOST_TEST((found.dt <= 0.04 && found.dt * 1.01 >= 0.04), found.dt);
}

BOOST_AUTO_TEST_CASE(its_ends_are_half_a_second_and_ten_microseconds) {
  const FussyEngine never([](double) { return false; });
  const StableStep none = found_by(never, one_body());
  BOOST_TEST(none.is_floor);
  BOOST_TEST(!none.is_cap);
  BOOST_TEST(none.dt == 1e-5);
  BOOST_TEST(never.tried.size() == 16);  // 0.5/2^15 s is the last above 1e-5
  for (const Tried& tried : never.tried) BOOST_TEST(tried.steps == 1);
  const FussyEngine always([](double) { return true; });
  for (const Scene& scene : {one_body(), touching()}) {
    const StableStep all = found_by(always, scene);
    BOOST_TEST(all.is_cap);
    BOOST_TEST(!all.is_floor);
    BOOST_TEST(all.dt == 0.5);
    BOOST_TEST(all.cut == "");
  }
}

// Among joints a method that divides its steps is tried at the largest one and its halves alone: no run is made twice.
BOOST_AUTO_TEST_CASE(an_adaptive_method_among_joints_is_tried_once_at_the_largest_step) {
  const FussyEngine always([](double) { return true; }, true), fine([](double dt) { return dt < 0.2; }, true);
  BOOST_TEST(found_by(always, jointed(0)).dt == 0.5);
  BOOST_TEST(always.tried.size() == 1);
  const StableStep found = found_by(fine, jointed(0));
  BOOST_TEST(found.dt == 0.125);
  BOOST_TEST((!found.is_cap && !found.is_floor));
  BOOST_TEST(found.cut == "its method divides each step: halves of 0.5 s alone were tried");
  const double expected[] = {0.5, 0.25, 0.125, 0.0625};
  BOOST_TEST_REQUIRE(fine.tried.size() == 4);
  for (std::size_t n = 0; n < 4; ++n) BOOST_TEST(fine.tried[n].dt == expected[n]);
}

// The last step goes beyond a horizon that is no multiple of it, unless roundings alone make it so.
BOOST_AUTO_TEST_CASE(a_step_has_to_hold_over_the_whole_horizon) {
  for (const auto& [horizon, steps] : {std::pair{1.0, 2L}, {1.2, 3L}, {1.0 + 1e-10, 2L}, {1.0 + 1e-8, 3L}}) {
    const FussyEngine engine([](double) { return true; });
    found_by(engine, one_body(), horizon);
    BOOST_TEST(engine.tried.front().dt == 0.5);
    BOOST_TEST(engine.tried.front().steps == steps, horizon);
  }
}

BOOST_AUTO_TEST_CASE(a_sweep_goes_up_by_three_per_cent_and_where_nothing_resonates_by_twenty) {
  for (const auto& [scene, factor] : {std::pair{one_body(), 1.03}, {sprung(), 1.03}, {touching(), 1.2}}) {
    const FussyEngine engine([](double) { return true; });
    found_by(engine, scene);
    BOOST_TEST_REQUIRE(engine.tried.size() > 4);  // 0.5 s and 0.25 s, and then up
    for (std::size_t n = 3; n < engine.tried.size(); ++n)
      BOOST_TEST(engine.tried[n].dt == factor * engine.tried[n - 1].dt, boost::test_tools::tolerance(1e-12));
  }
}

// Half of 10 million steps of a body may be a sweep's: at 1.03 from 0.25 s on it takes some 690 of 10 s.
BOOST_AUTO_TEST_CASE(a_sweep_that_takes_more_than_half_of_what_is_left_is_not_begun) {
  const FussyEngine alone([](double) { return true; });
  BOOST_TEST(found_by(alone, one_body(), 10).cut == "");
  double sweep = 0;  // s of it are not multiples of its steps: to 6 %
  for (std::size_t n = 2; n < alone.tried.size(); ++n) sweep += static_cast<double>(alone.tried[n].steps);
  BOOST_TEST((sweep > 650 && sweep < 730), sweep);
  const auto cut_of = [&](double share) {
    Scene scene;  // 40 steps of 0.25 s are taken before, and those of 0.5 s do not count
    scene.bodies.assign(static_cast<std::size_t>(10e6 / (share * 2 * sweep + 40)), test::body("b", 1, {1, 1, 1}));
    return found_by(FussyEngine([](double) { return true; }), scene, 10).cut;
  };
  BOOST_TEST(cut_of(1.06) == "");
  BOOST_TEST(cut_of(0.94) == "by bisection from 0.5 s up: a sweep would take too many steps");
}

// The budget is 0.4 million steps × bodies: the rest after the first run at 0.25 s, which does not count.
BOOST_AUTO_TEST_CASE(a_step_takes_what_its_bodies_springs_joints_limits_and_loops_take) {
  const auto steps_left = [](int springs, int joints, bool has_limits) {
    Scene scene;
    scene.bodies.assign(10, test::body("b", 1, {1, 1, 1}));
    scene.springs.assign(springs, test::spring(kWorld, {0, 0, 0}, 0, {0, 0, 0}, 1, 0));
    for (int k = 0; k < joints; ++k) {
      scene.joints.push_back({.a = kWorld, .b = k % 10, .type = HingeJoint{Vec3::Zero(), Vec3::UnitZ()}});
      if (has_limits) scene.joints.back().upper = 1;
    }
    const FussyEngine engine([](double) { return true; });
    found_by(engine, scene, 2000);
    BOOST_TEST(engine.tried.at(0).steps == 4000);
    return engine.tried.at(1).steps;
  };
  BOOST_TEST(steps_left(0, 10, false) == 400000 / (10 + 10 * 30));
  BOOST_TEST(steps_left(90, 10, false) == 400000 / (10 + 90 + 10 * 30));
  BOOST_TEST(steps_left(0, 10, true) == 400000 / (10 + 10 * 300));
  // More joints than bodies close loops, 0.06 a joint cubed.
  BOOST_TEST(steps_left(0, 11, false) == static_cast<long>(400000 / (10 + 11 * 30 + 0.06 * 11 * 11 * 11)));
}

// One that divides its steps counts as taking a millisecond each: 250 in each of 0.25 s.
BOOST_AUTO_TEST_CASE(an_adaptive_methods_inner_steps_count) {
  const FussyEngine engine([](double) { return true; }, true);
  const StableStep found = found_by(engine, one_body(), 20000);
  BOOST_TEST(engine.tried.at(0).steps == 40000);
  BOOST_TEST(engine.tried.at(1).steps == 10'000'000 / 250);
  BOOST_TEST(found.dt == 0.5);
  const FussyEngine among_joints([](double) { return true; }, true);
  const StableStep once = found_by(among_joints, jointed(0));
  BOOST_TEST((once.is_cap && !once.is_floor));
  BOOST_TEST(once.cut == "its method divides each step: 0.5 s alone was tried");
}

BOOST_AUTO_TEST_SUITE_END()
