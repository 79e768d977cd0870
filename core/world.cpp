#include "core/world.h"
#include "core/base/names_of.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/core_methods.h"
#include "core/dynamics/contact/contact_method.h"
#include "core/dynamics/integrators/joint_events.h"
#include "core/dynamics/joints/singular_passages.h"
#include "core/engine/clock.h"
#include "core/engine/option_values.h"
#include "core/engine/run_name.h"
#include "core/engine/saved_bytes.h"
#include "core/scene/contact_laws.h"
#include "core/scene/joint_loops.h"
#include "core/scene/toml/scene_reader.h"
#include "core/scene/toml/table_reader.h"

namespace rigor {
namespace {

constexpr const char* kDefault = "dormand-prince";  // correct at any step

const OptionInfo kThreadsOption{.name = "threads",
                                .meaning = "threads that share the bodies of a large scene; the result is the same",
                                .min = 1,
                                .max = 64,
                                .whole = true,
                                .by_default = 1.0};

OptionInfo orientation_option(const Integrator& integrator) {
  return {.name = "orientation",
          .meaning = "how a rotation is carried over a step",
          .choices = names_of(orientation_updates()),
          .by_default = integrator.default_orientation};
}

class CoreWorld : public World, public MayReduceOrder, public MayDivideSteps, public ArchivesState {
 public:
  CoreWorld(const Scene& scene, const Integrator& integrator, const Settings& settings)
      : ArchivesState("core", RIGOR_VERSION, scene, settings),
        system_(scene),
        integrator_(integrator),
        tolerance_(number_option(settings, kToleranceOption)),
        contact_method_(settings.options.contains("contact") ? contact_method(settings.options.at("contact"))
                                                             : contact_method_for(scene)) {
    if (!integrator_.default_orientation.empty()) {
      orientation_ = &orientation_update(word_option(settings, orientation_option(integrator_)));
    }
    system_.constants.use_threads(static_cast<int>(number_option(settings, kThreadsOption)));
    state_.resize(scene.bodies.size(), orientation_ != nullptr && orientation_->keeps_matrix);
    set_initial_state(scene, state_.columns());
    if (!scene.joints.empty()) joints_ = std::make_unique<Joints>(scene, system_), note_loops(scene);
    if (anything_can_touch(scene)) {
      has_servos_ = JointStops::has_servos(scene);
      if (JointStops::has_speed_motors(scene))
        motors_ = std::make_unique<JointStops>(scene, system_, system_.loads, *joints_, JointStops::Of::motors);
      auto stepper =
          contact_method_.make(scene, {system_, integrator_, orientation_, settings, joints_.get(), motors_.get()});
      contact_ = stepper.get();
      contact_name_ = name_of_contact(scene, settings);
      stepper_ = std::move(stepper);
    } else {
      stepper_ = integrator_.make({system_, nullptr, orientation_, settings, joints_.get(), &scene});
      if (JointStops::are_in(scene))
        stepper_ = std::make_unique<JointEvents>(scene, system_, *joints_, std::move(stepper_));
    }
  }

  Capabilities capabilities() override {
    return {.reduced_order = this,
            .divided_steps = this,
            .contacts = contact_ ? contact_->contact_reports() : nullptr,
            .state = this};
  }

  void step(double dt) override {
    if (joints_) joints_->begin_step();
    if (contact_ && has_servos_)
      step_between_samples(clock_.time(), dt);
    else
      stepper_->step(state_.columns(), clock_.time(), dt);
    if (joints_) joints_->end_step(state_.columns());
    clock_.advance(dt);
    if (contact_ && !contact_->was_smooth()) passages_.interrupt();
    if (joints_ && on_loop_[joints_->joint_of_smallest_pivot()])
      passages_.note(clock_.time(), joints_->smallest_pivot());
    else
      passages_.interrupt();
  }

  void read(Snapshot& out) const override {
    out.time = clock_.time();
    out.borrow(state_.columns());
  }

  SettingsInForce settings_in_force() const override {
    SettingsInForce settings = {{"integrator", integrator_.name}, {"gyroscopic term", "on"}};
    if (orientation_) settings.emplace_back("orientation", orientation_->name);
    if (integrator_.adaptive) settings.emplace_back("tolerance", fmt::format("{}", tolerance_));
    settings.emplace_back("contact", contact_name_);
    // Computed at each call, because some settings depend on the run.
    const SettingsInForce of_contact = contact_ ? contact_->settings_in_force() : SettingsInForce();
    settings.insert(settings.end(), of_contact.begin(), of_contact.end());
    if (joints_) settings.emplace_back("joints", fmt::format("{} rows, of rank {}", joints_->rows(), joints_->rank()));
    if (!passages_.times().empty()) settings.emplace_back("singular positions", passages_.text());
    return settings;
  }

  std::string solver_warning() const override {
    const std::string of_joints = joints_ ? joints_->warning() : "";
    return of_joints.empty() ? stepper_->solver_warning() : of_joints;
  }

  std::optional<ReducedOrder> reduced_order() const override {
    return contact_ ? contact_->reduced_order() : std::nullopt;
  }

  std::optional<double> sub_step() const override { return contact_ ? contact_->sub_step() : std::nullopt; }

 private:
  void archive_state(StateArchive& archive) override {
    archive(clock_, state_, system_.loads, passages_);
    if (joints_) archive(*joints_);
    if (motors_) archive(*motors_);
    stepper_->archive_state(archive);
  }

  // The rows of couplings stand behind those of joints. Each of them may repeat others.
  void note_loops(const Scene& scene) {
    on_loop_ = joints_on_loops(scene);
    on_loop_.resize(scene.joints.size() + scene.couplings.size(), true);
  }

  // Contact methods do not locate the events of servos.
  void step_between_samples(double t, double dt) {
    for (double from = t; from < t + dt;) {
      const double to = system_.loads.next_sample(from, t + dt);
      system_.loads.sample_servos(state_.columns(), from);
      stepper_->step(state_.columns(), from, from == t && to == t + dt ? dt : to - from);
      from = to;
    }
  }

  // With the rule by which it was taken where none was named.
  std::string name_of_contact(const Scene& scene, const Settings& settings) const {
    if (settings.options.contains("contact")) return contact_method_.name;
    const bool are_few = contact_method_for(scene).name == "event" && has_few_colliding_bodies(scene);
    if (!are_few) return fmt::format("{}, by default", contact_method_.name);
    return fmt::format("{}, by default: at most {} bodies that move collide", contact_method_.name,
                       kFewCollidingBodies);
  }

  System system_;
  const Integrator integrator_;
  double tolerance_;  // of an adaptive method
  const ContactMethod& contact_method_;
  const OrientationUpdate* orientation_ = nullptr;
  std::string contact_name_ = "none in this scene";
  ContactStepper* contact_ = nullptr;  // the stepper, where bodies can touch
  BodyTable state_;
  std::unique_ptr<Joints> joints_;      // null where there are none
  std::unique_ptr<JointStops> motors_;  // of given speed, where bodies can touch; null where there are none
  bool has_servos_ = false;
  std::vector<bool> on_loop_;  // by joint, then by coupling: no other joint can be in a singular position
  SingularPassages passages_;
  std::unique_ptr<Stepper> stepper_;
  Clock clock_;
};

// What joints ask for; a method takes all of it, or none, or all but dampers.
const Features kJointFeatures = joined(
    joints_of_all_types(),
    {Feature::joint_spring, Feature::quadratic_spring, Feature::joint_damper, Feature::joint_friction,
     Feature::motor_effort, Feature::motor_servo, Feature::motor_speed, Feature::motor_table,
     Feature::joints_with_dampers, Feature::joint_limit, Feature::joint_limit_beyond_half_turn, Feature::armature,
     Feature::coupling, Feature::coupling_of_several_joints, Feature::motor_servo_of_several_joints});

// What only a twin has that says so.
const Features kBeyondTwins = joined(joints_of_types<CompoundJoint, PlanarJoint, ScrewJoint>(),
                                     {Feature::armature, Feature::coupling, Feature::coupling_of_several_joints,
                                      Feature::motor_servo_of_several_joints});

OptionInfo contact_option() {
  OptionInfo option{.name = "contact",
                    .meaning = "how touching bodies are treated",
                    .choices = names_of(contact_methods()),
                    .by_default = DefaultRule{fmt::format("event for at most {} colliding moving bodies, else the "
                                                          "first that supports the scene",
                                                          kFewCollidingBodies)}};
  for (const ContactMethod& method : contact_methods()) option.features_of_choice[method.name] = method.features;
  return option;
}

MethodInfo method_info(const Integrator& integrator) {
  MethodInfo info{.name = integrator.name,
                  .summary = integrator.summary,
                  .order = integrator.order,
                  .symplectic = integrator.symplectic,
                  .symmetric = integrator.symmetric,
                  .leapfrog_stagger = integrator.leapfrog_stagger,
                  .adaptive = integrator.adaptive,
                  .options = {contact_option()}};
  info.options.push_back(kThreadsOption);
  if (!integrator.default_orientation.empty()) info.options.push_back(orientation_option(integrator));
  for (const ContactMethod& method : contact_methods()) {
    info.options.insert(info.options.end(), method.options.begin(), method.options.end());
  }
  info.options.insert(info.options.end(), integrator.options.begin(), integrator.options.end());
  info.twin_of = integrator.twin_of;
  if (!integrator.takes_contact) {
    for (const ContactMethod& method : contact_methods())
      info.lacks.insert(method.features.begin(), method.features.end());
  }
  if (!integrator.takes_joints) info.lacks = joined(info.lacks, kJointFeatures);
  if (!integrator.takes_dampers_with_joints) info.lacks.insert(Feature::joints_with_dampers);
  info.lacks = joined(info.lacks, integrator.lacks);
  if (!integrator.twin_of.empty()) {
    for (const Feature feature : kBeyondTwins)
      if (!integrator.twin_takes.contains(feature)) info.lacks.insert(feature);
  }
  return info;
}

}  // namespace

EngineInfo core_info_of(const std::vector<Integrator>& methods) {
  EngineInfo info{.name = "core", .version = RIGOR_VERSION, .precision = "double"};
  info.is_in_house = true;
  info.features = joined({Feature::spring, Feature::timed_force, Feature::fixed_body}, kJointFeatures);
  for (const ContactMethod& method : contact_methods()) {
    info.features.insert(method.features.begin(), method.features.end());
  }
  for (const Integrator& row : methods) info.methods.push_back(method_info(row));
  // The first is the default of "core". Twins come last.
  std::stable_partition(info.methods.begin(), info.methods.end(), [](const auto& m) { return m.twin_of.empty(); });
  std::stable_partition(info.methods.begin(), info.methods.end(), [](const auto& m) { return m.name == kDefault; });
  return info;
}

std::unique_ptr<World> make_core_world(const Scene& scene, const Integrator& method, const Settings& settings) {
  return std::make_unique<CoreWorld>(scene, method, settings);
}

Scene read_scene_file(const std::string& path) {
  const TomlFile file = TomlFile::read(path);
  return read_scene(file.root(case_keys()).at("scene"));
}

const EngineInfo& core_info() {
  static const EngineInfo info = core_info_of(integrators());
  return info;
}

std::unique_ptr<World> load_world(const Scene& scene, const std::string& run) {
  const RunName name = parse_run_name(run, {core_info()});
  const std::string reason = why_unsupported(core_info(), name.settings, scene, 0);
  if (!reason.empty()) throw InputError(reason);
  return make_core_world(scene, integrator(name.settings.method), name.settings);
}

}  // namespace rigor
