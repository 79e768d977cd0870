// rigor conform: every engine of the table conforms, and each of these mistakes is found by the check that is about it.
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <map>

#include "adapters/engines.h"
#include "adapters/faults/broken_engine.h"
#include "adapters/faults/faults.h"
#include "cases/analysis/conformance/conformance.h"
#include "core/engine/run_name.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_analysis_conformance)

namespace {

Trial trial_of(const Engine& engine, const std::string& run) {
  const RunName name = parse_run_name(run, engines().infos());
  return {engine, engine.info(), name.settings};
}

// The checks that this engine breaks, with what they say.
std::map<std::string, CheckResult> broken_by(const Trial& trial) {
  std::map<std::string, CheckResult> found;
  for (const ConformanceCheck& check : conformance_checks()) {
    const CheckResult result = check_result(check, trial);
    if (result.answer == CheckResult::Answer::broken) found[check.name] = result;
  }
  return found;
}

struct Mistake {
  Fault fault;
  std::string found_by;
};

Fault on_load(std::function<void(Scene&)> change) {
  Fault fault;
  fault.scene = std::move(change);
  return fault;
}
Fault on_step(std::function<void(Moment&)> change) {
  Fault fault;
  fault.step = std::move(change);
  return fault;
}
Fault on_read_of_all(std::function<void(MutableBodyColumns, const Scene&)> change) {
  Fault fault;
  fault.read = std::move(change);
  return fault;
}
Fault on_read(std::function<void(MutableBodyColumns, std::size_t)> change) {
  return on_read_of_all([change](MutableBodyColumns bodies, const Scene&) {
    for (std::size_t i = 0; i < bodies.size(); ++i) change(bodies, i);
  });
}

std::map<std::string, Mistake> mistakes() {
  std::map<std::string, Mistake> all;
  all["no gravity"] = {on_load([](Scene& s) { s.gravity.setZero(); }), "free-fall"};
  all["gravity upside down"] = {on_load([](Scene& s) { s.gravity *= -1; }), "free-fall"};
  all["bodies in another order"] = {on_read_of_all([](MutableBodyColumns bodies, const Scene&) {
                                      if (bodies.size() < 3) return;
                                      const BodyState first = bodies.body(0);
                                      bodies.set_body(0, bodies.body(2)), bodies.set_body(2, first);
                                    }),
                                    "load-then-read"};
  all["angular velocity in the body's frame"] = {on_read([](MutableBodyColumns b, std::size_t i) {
                                                   b.set_angular_velocity(
                                                       i, b.orientation(i).conjugate() * b.angular_velocity(i));
                                                 }),
                                                 "load-then-read"};
  all["quaternion with w last"] = {on_read([](MutableBodyColumns b, std::size_t i) {
                                     const Quat q = b.orientation(i);
                                     b.set_orientation(i, {q.z(), q.w(), q.x(), q.y()});
                                   }),
                                   "load-then-read"};
  all["quaternion from W to B"] = {
      on_read([](MutableBodyColumns b, std::size_t i) { b.set_orientation(i, b.orientation(i).conjugate()); }),
      "load-then-read"};
  all["double that is single"] = {on_read([](MutableBodyColumns b, std::size_t i) {
                                    for (int c = 0; c < 13; ++c) b.column(c)[i] = static_cast<float>(b.column(c)[i]);
                                  }),
                                  "load-then-read"};
  all["half the step"] = {on_step([](Moment& m) { m.dt *= 0.5; }), "straight-line"};
  all["damping"] = {on_step([](Moment& m) {
                      for (Body& body : m.scene.bodies)
                        body.velocity *= 1 - 1e-3 * m.dt, body.angular_velocity *= 1 - 1e-3 * m.dt;
                    }),
                    "straight-line"};
  all["sleep"] = {on_step([](Moment& m) {
                    for (Body& body : m.scene.bodies) {
                      if (body.velocity.norm() < 0.01) body.velocity.setZero();
                    }
                  }),
                  "no-sleep"};
  all["inertia without its products"] = {on_load([](Scene& s) {
                                           for (Body& body : s.bodies)
                                             body.inertia = Mat3(body.inertia.diagonal().asDiagonal());
                                         }),
                                         "spin"};
  all["torque in the body's frame"] = {on_load([](Scene& s) {
                                         for (TimedForce& force : s.forces)
                                           force.torque = s.bodies[force.body].orientation * force.torque;
                                       }),
                                       "wrench"};
  all["a force that stays"] = {on_load([](Scene& s) {
                                 for (TimedForce& force : s.forces) force.until += 0.05;
                               }),
                               "wrench"};
  all["springs pull on one end"] = {on_load([](Scene& s) {
                                      for (Spring& spring : s.springs) {
                                        if (spring.a != kWorld) spring.a = kWorld, spring.point_a = {1, -2, 3};
                                      }
                                    }),
                                    "momentum"};
  all["a pair of springs that drifts"] = {on_step([](Moment& m) {
                                            for (const Spring& spring : m.scene.springs) {
                                              if (spring.a == kWorld || spring.b == kWorld) continue;
                                              m.scene.bodies[spring.a].velocity.x() += 1e-9 * m.dt;
                                            }
                                          }),
                                          "momentum"};
  all["a hinge's axis askew"] = {on_load([](Scene& s) {
                                   for (Joint& joint : s.joints) {
                                     if (auto* hinge = std::get_if<HingeJoint>(&joint.type))
                                       hinge->axis = rotation_by(Vec3(0.1, 0, 0)) * hinge->axis;
                                   }
                                 }),
                                 "joints"};
  all["a hinge taken for a ball"] = {on_load([](Scene& s) {
                                       for (Joint& joint : s.joints) {
                                         if (const auto* hinge = std::get_if<HingeJoint>(&joint.type))
                                           joint.type = BallJoint{hinge->anchor};
                                       }
                                     }),
                                     "joints"};
  all["a universal joint taken for a ball"] = {on_load([](Scene& s) {
                                                 for (Joint& joint : s.joints) {
                                                   if (const auto* cross = std::get_if<UniversalJoint>(&joint.type))
                                                     joint.type = BallJoint{cross->anchor};
                                                 }
                                               }),
                                               "joints"};
  all["a slider that turns"] = {on_load([](Scene& s) {
                                  for (Joint& joint : s.joints) {
                                    if (const auto* slider = std::get_if<SliderJoint>(&joint.type))
                                      joint.type = CylindricalJoint{s.bodies[joint.b].position, slider->axis};
                                  }
                                }),
                                "joints"};
  all["gravity off by a few roundings"] = {on_load([](Scene& s) { s.gravity *= 1 + 3e-14; }), "free-fall"};
  all["springs at the centre"] = {on_load([](Scene& s) {
                                    for (Spring& spring : s.springs) spring.point_b.setZero();
                                  }),
                                  "spring"};
  all["boxes of half size"] = {on_load([](Scene& s) {
                                 for (Body& body : s.bodies) {
                                   if (auto* box = body.shape ? std::get_if<Box>(&*body.shape) : nullptr)
                                     box->size *= 0.5;
                                 }
                               }),
                               "contacts"};
  all["a prefered direction"] = {on_step([](Moment& m) {
                                   for (Body& body : m.scene.bodies)
                                     body.velocity.x() += 1e-6 * m.dt * body.velocity.z();
                                 }),
                                 "turned-frame"};
  return all;
}

// ODE, which is of double precision, and says that it is of single.
class Modest : public Engine {
 public:
  EngineInfo info() const override {
    EngineInfo info = ode().info();
    info.precision = "single";
    return info;
  }
  std::unique_ptr<World> load(const Scene& scene, const Settings& settings) const override {
    return ode().load(scene, settings);
  }
  std::string twin(const Settings&) const override { return ""; }

 private:
  static const Engine& ode() { return engines().find("ode"); }
};

}  // namespace

BOOST_AUTO_TEST_CASE(every_engine_of_the_table_conforms) {
  for (const EngineInfo& info : engines().infos()) {
    for (const auto& [check, result] : broken_by(trial_of(engines().find(info.name), info.name)))
      BOOST_ERROR(info.name << ": " << check << ": came " << result.came << ", due " << result.due);
  }
}

BOOST_AUTO_TEST_CASE(every_adaptive_method_divides_a_long_step) {
  for (const EngineInfo& info : engines().infos()) {
    for (const MethodInfo& method : info.methods) {
      if (!method.adaptive) continue;
      for (const std::string track : {"", "@stock"}) {
        const std::string run = info.name + ":" + method.name + track;
        const auto broken = broken_by(trial_of(engines().find(info.name), run));
        BOOST_TEST(!broken.contains("spin"), run);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(each_mistake_is_found_and_told_with_what_was_sent_what_came_and_what_was_due) {
  for (const auto& [name, mistake] : mistakes()) {
    BOOST_TEST_CONTEXT(name) {
      const BrokenEngine engine(engines().find("ode"), mistake.fault);
      const auto found = broken_by(trial_of(engine, "ode"));
      BOOST_TEST_REQUIRE(found.contains(mistake.found_by));
      const CheckResult& result = found.at(mistake.found_by);
      BOOST_TEST((!result.sent.empty() && !result.came.empty() && !result.due.empty()));
    }
  }
}

// With every engine that reports contacts, for the reports of each have a form of their own.
BOOST_AUTO_TEST_CASE(each_wrong_report_of_contacts_is_found) {
  for (const char* name : {"ode", "bullet", "mujoco", "core:velocity-verlet,contact=impulse"}) {
    const std::string run = name, engine = run.substr(0, run.find(':'));
    const auto infos = engines().infos();
    if (std::none_of(infos.begin(), infos.end(), [&](const EngineInfo& info) { return info.name == engine; })) continue;
    for (const Fault& fault : contact_report_faults()) {
      const BrokenEngine broken(engines().find(engine), fault);
      BOOST_TEST(broken_by(trial_of(broken, run)).contains("contact-forces"), run << ": " << fault.name);
    }
  }
}

// The core, with a restore that does less than it should.
class Forgetful : public Engine {
 public:
  enum class Forgets { nothing, all, fresh_worlds };
  explicit Forgetful(Forgets what) : what_(what) {}
  EngineInfo info() const override { return core().info(); }
  std::unique_ptr<World> load(const Scene& scene, const Settings& settings) const override {
    return std::make_unique<Saving>(core().load(scene, settings), what_);
  }
  std::string twin(const Settings&) const override { return ""; }

 private:
  class Saving : public World, public SavesState {
   public:
    Saving(std::unique_ptr<World> world, Forgets what) : world_(std::move(world)), what_(what) {}
    void step(double dt) override { world_->step(dt), is_fresh_ = false; }
    void read(Snapshot& out) const override { world_->read(out); }
    SettingsInForce settings_in_force() const override { return world_->settings_in_force(); }
    std::string solver_warning() const override { return world_->solver_warning(); }
    Capabilities capabilities() override { return {.state = this}; }
    std::unique_ptr<SavedState> save() const override { return world_->capabilities().state->save(); }
    void restore(const SavedState& state) override {
      if (what_ == Forgets::all || (what_ == Forgets::fresh_worlds && is_fresh_)) return;
      world_->capabilities().state->restore(state);
    }

   private:
    std::unique_ptr<World> world_;
    Forgets what_;
    bool is_fresh_ = true;
  };
  static const Engine& core() { return engines().find("core"); }
  Forgets what_;
};

BOOST_AUTO_TEST_CASE(a_restore_that_forgets_is_found) {
  using Forgets = Forgetful::Forgets;
  const auto finds = [](Forgets what) {
    return broken_by(trial_of(Forgetful(what), "core:rk4")).contains("saved-state");
  };
  BOOST_TEST(!finds(Forgets::nothing));
  BOOST_TEST(finds(Forgets::all));
  BOOST_TEST(finds(Forgets::fresh_worlds));
}

// Explicit Euler falls g dt t / 2 too short. With a thirtieth of gravity missing it falls short by twice as much.
BOOST_AUTO_TEST_CASE(a_first_order_fall_that_is_twice_as_wrong_as_its_step_is_found) {
  const Engine& core = engines().find("core");
  BOOST_TEST(!broken_by(trial_of(core, "core:explicit-euler")).contains("free-fall"));
  const BrokenEngine weak(core, on_load([](Scene& s) { s.gravity *= 1 - 1.0 / 30; }));
  BOOST_TEST(broken_by(trial_of(weak, "core:explicit-euler")).contains("free-fall"));
}

// To say single precision widens the limits by which it is judged.
BOOST_AUTO_TEST_CASE(an_engine_of_double_precision_that_says_single_is_found) {
  const Modest single;
  BOOST_TEST(broken_by(trial_of(single, "ode")).contains("precision"));
  const BrokenEngine rounds(single, on_read([](MutableBodyColumns b, std::size_t i) {
                              for (int c = 0; c < 13; ++c) b.column(c)[i] = static_cast<float>(b.column(c)[i]);
                            }));
  BOOST_TEST(!broken_by(trial_of(rounds, "ode")).contains("precision"));
}

// What an engine says of its method is held against what the method does.
BOOST_AUTO_TEST_CASE(a_method_that_says_too_much_of_itself_is_found) {
  class Boaster : public Engine {
   public:
    Boaster(const std::string& method, const std::function<void(MethodInfo&)>& boast)
        : method_(method), boast_(boast) {}
    EngineInfo info() const override {
      EngineInfo info = core().info();
      for (MethodInfo& method : info.methods) {
        if (method.name == method_) boast_(method);
      }
      return info;
    }
    std::unique_ptr<World> load(const Scene& scene, const Settings& settings) const override {
      return core().load(scene, settings);
    }
    std::string twin(const Settings&) const override { return ""; }

   private:
    static const Engine& core() { return engines().find("core"); }
    std::string method_;
    std::function<void(MethodInfo&)> boast_;
  };
  for (const MethodInfo& method : engines().info_of("core").methods) {
    // One step of exact rotations composed to order 4 and up is as good as many of a loose adaptive method.
    const bool is_composed = method.name.starts_with("symplectic");
    if (method.adaptive || is_composed || method.order > 4 || !method.twin_of.empty()) continue;
    const Boaster adaptive(method.name, [](MethodInfo& m) { m.adaptive = true; });
    BOOST_TEST(broken_by(trial_of(adaptive, "core:" + method.name)).contains("spin"), method.name);
  }
  const Boaster order("semi-implicit-euler", [](MethodInfo& m) { m.order = 4, m.leapfrog_stagger = 0; });
  const auto of_order = broken_by(trial_of(order, "core:semi-implicit-euler"));
  BOOST_TEST((of_order.contains("free-fall") && of_order.contains("spin")));
  const Boaster stagger("rk4", [](MethodInfo& m) { m.leapfrog_stagger = 0.5; });
  BOOST_TEST(broken_by(trial_of(stagger, "core:rk4")).contains("free-fall"));
  for (const char* method : {"explicit-euler", "rk4"}) {
    const Boaster symplectic(method, [](MethodInfo& m) { m.symplectic = true; });
    BOOST_TEST(broken_by(trial_of(symplectic, std::string("core:") + method)).contains("symplectic"), method);
  }
  BOOST_TEST(!broken_by(trial_of(engines().find("core"), "core:velocity-verlet")).contains("symplectic"));
}

BOOST_AUTO_TEST_SUITE_END()
