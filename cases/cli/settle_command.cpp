// rigor settle: prints the file with the nearest initial state that its joints allow. Poses are always allowed, because
// anchors and axes are given at t = 0. Velocities may break a joint; the nearest differ least in the metric of the
// masses.
#include <fmt/format.h>

#include "cases/case/case_reader.h"
#include "cases/case/settled_velocities.h"
#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "core/base/error.h"
#include "core/scene/toml/scene_reader.h"
#include "core/scene/toml/table_reader.h"
#include "core/scene/toml/writing/velocity_writer.h"

namespace rigor::inline cli {
namespace {

class SettleCommand : public Command {
 public:
  void declare(Options& options) override { options.add_words(words_); }

  int run(const Invocation&) override {
    if (words_.size() != 1) throw InputError(fmt::format("rigor settle: takes one file, and found {}", words_.size()));
    const TomlFile file = TomlFile::read(words_.front());
    const TomlValue value = file.root(case_keys()).at("scene");
    Scene scene = read_scene(value, InitialVelocities::as_given);
    settle_velocities(scene);
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

}  // namespace rigor::inline cli
