// rigor settle: prints the file with the nearest initial state that its joints allow. Poses are always allowed, because
// anchors and axes are given at t = 0. Velocities may break a joint; the nearest differ least in the metric of the
// masses.
#include <fmt/format.h>

#include <algorithm>

#include "cases/case/case_reader.h"
#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "core/base/error.h"
#include "core/dynamics/joints/joints.h"
#include "core/scene/joint_rates.h"
#include "core/scene/toml/scene_reader.h"
#include "core/scene/toml/table_reader.h"
#include "core/scene/toml/writing/velocity_writer.h"

namespace rigor {
namespace {

// Changes only bodies with joints, and nothing if no joint is broken.
void settle(Scene& scene) {
  const auto breaks = [&](const auto& row) { return !why_rates_break(scene, row).empty(); };
  if (std::none_of(scene.joints.begin(), scene.joints.end(), breaks) &&
      std::none_of(scene.couplings.begin(), scene.couplings.end(), breaks))
    return;
  BodyTable state(scene.bodies.size());
  set_initial_state(scene, state.columns());
  Scene at_rest = scene;  // velocities that break joints would only disturb
  for (Body& body : at_rest.bodies) body.velocity = body.angular_velocity = Vec3::Zero();
  const System system(at_rest);
  Joints joints(at_rest, system);
  joints.project(state.columns());
  if (const std::string why = joints.warning(); !why.empty()) throw InputError(why);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].fixed) continue;
    scene.bodies[i].velocity = state.columns().velocity(i);
    scene.bodies[i].angular_velocity = state.columns().angular_velocity(i);
  }
}

class SettleCommand : public Command {
 public:
  void declare(Options& options) override { options.add_words(words_); }

  int run(const Invocation&) override {
    if (words_.size() != 1) throw InputError(fmt::format("rigor settle: takes one file, and found {}", words_.size()));
    const TomlFile file = TomlFile::read(words_.front());
    const TomlValue value = file.root(case_keys()).at("scene");
    Scene scene = read_scene(value, InitialVelocities::as_given);
    settle(scene);
    const std::string text = with_velocities(file, value, scene);
    // Velocities of the copies of an array cannot be written. Reading the text again finds that.
    try {
      const TomlFile settled = TomlFile::parse(text, words_.front());
      read_scene(settled.root(case_keys()).at("scene"));
    } catch (const InputError& error) {
      throw InputError(
          fmt::format("{}: no initial velocities that can be written settle it: {}", words_.front(), error.what()));
    }
    print(text);
    return kGood;
  }

 private:
  std::vector<std::string> words_;
};

}  // namespace

CommandRow settle_row() {
  return {"settle",
          "print a case file with the nearest initial velocities that its joints allow",
          "FILE",
          "a case file",
          {{"rigor settle my-case.toml > settled.toml", "correct velocities that break a joint"}},
          make_command<SettleCommand>};
}

}  // namespace rigor
