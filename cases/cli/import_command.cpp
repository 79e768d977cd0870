// rigor import: prints a robot's file as a case file; stderr lists what a scene cannot say.
#include <fmt/format.h>

#include "cases/case/case_reader.h"
#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "cases/cli/vocabulary.h"
#include "cases/import/import.h"
#include "core/base/error.h"

namespace rigor {

namespace {

class ImportCommand : public Command {
 public:
  void declare(Options& options) override {
    options.add_words(words_);
    options.add({"--keyframe", "NAME", "start an MJCF model from this keyframe"}, keyframe_);
  }

  int run(const Invocation&) override {
    if (words_.size() != 1)
      throw InputError(fmt::format("rigor import: takes one file (URDF, SDF or MJCF), and found {}", words_.size()));
    const std::string& path = words_.front();
    const Import made = import_model(path, keyframe_);
    // The printed text must be a case file that `rigor run` reads.
    const Case definition = read_case_text(made.case_text, path, path, vocabulary_of(built_in_engines().infos()));
    const std::string falling = falls_freely(definition.scene);
    if (!falling.empty()) say(fmt::format("{}: there is no ground, so '{}' falls freely", path, falling));
    if (!made.losses.empty())
      say(fmt::format("{}: {} kinds of physics left out or assumed:", path, made.losses.size()));
    for (const std::string& loss : made.losses) say("  " + loss);
    for (const std::string& sentence : made.left_out) say("left out: " + sentence);
    print(made.case_text);
    return kGood;
  }

 private:
  std::vector<std::string> words_;
  std::string keyframe_;  // empty: the model's own state
};

}  // namespace

CommandRow import_row() {
  return {"import",
          "print a robot's file (URDF, SDF or MJCF) as a case file; stderr lists what was left out",
          "FILE",
          "a file that ends in .urdf, .sdf, .mjcf or .xml",
          {{"rigor import robot.urdf > robot.toml", "a case file to edit"},
           {"rigor import humanoid.xml --keyframe squat > squat.toml", "start from a keyframe of MJCF"}},
          make_command<ImportCommand>};
}

}  // namespace rigor
