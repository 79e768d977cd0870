// rigor import: prints a robot's file as a case file. stderr lists what a scene cannot say.
#include <fmt/format.h>

#include "cases/cli/chosen_cases.h"
#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "cases/cli/shared_options.h"
#include "cases/import/import.h"
#include "core/base/error.h"

namespace rigor::inline cli {

namespace {

class ImportCommand : public Command {
 public:
  void declare(Options& options) override { options.add_words(words_), imports_.declare(options); }

  int run(const Invocation&) override {
    if (words_.size() != 1)
      throw InputError(fmt::format("rigor import: takes one file (URDF, SDF or MJCF), and found {}", words_.size()));
    const std::string& path = words_.front();
    const Import made = import_model(path, imports_.chosen);
    say_if_it_falls(path, made.scene);
    refuse_losses(made, path, imports_.chosen);
    for (const std::string& text : lines_of(made.losses)) say(text.starts_with(" ") ? text : path + ": " + text);
    print(case_text_of(made));
    return kGood;
  }

 private:
  std::vector<std::string> words_;
  ImportFlags imports_;
};

}  // namespace

CommandRow import_row() {
  return {"import",
          "print a robot's file (URDF, SDF or MJCF) as a case file; stderr lists what was left out",
          "FILE",
          "a file that ends in .urdf, .sdf, .mjcf or .xml",
          {{"rigor import robot.urdf > robot.toml", "a case file to edit"},
           {"rigor import robot.urdf --ground > robot.toml", "the robot above a plane"},
           {"rigor import humanoid.xml --keyframe squat > squat.toml", "start from a keyframe of MJCF"}},
          make_command<ImportCommand>};
}

}  // namespace rigor::inline cli
