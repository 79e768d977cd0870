// rigor import: prints a robot's file as a case file; stderr lists what a scene cannot say.
#include <fmt/format.h>

#include "cases/case/case_reader.h"
#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "cases/cli/vocabulary.h"
#include "cases/import/import.h"
#include "core/base/error.h"

namespace rigor {

static int import_command(const CommandLine& line, const EngineTable& engines) {
  if (line.words.size() != 1)
    throw InputError(fmt::format("rigor import: takes one file (URDF, SDF or MJCF), and found {}", line.words.size()));
  const std::string& path = line.words.front();
  const Import made = import_model(path, line.keyframe);
  // The printed text must be a case file that `rigor run` reads.
  const Case definition = read_case_text(made.case_text, path, path, vocabulary_of(engines.infos()));
  const std::string falling = falls_freely(definition.scene);
  if (!falling.empty()) say(fmt::format("{}: there is no ground, so '{}' falls freely", path, falling));
  if (!made.losses.empty()) say(fmt::format("{}: {} kinds of physics left out or assumed:", path, made.losses.size()));
  for (const std::string& loss : made.losses) say("  " + loss);
  for (const std::string& sentence : made.left_out) say("left out: " + sentence);
  print(made.case_text);
  return kGood;
}

CommandRow import_row() {
  return {"import",
          "print a robot's file (URDF, SDF or MJCF) as a case file; stderr lists what was left out",
          "FILE",
          "a file that ends in .urdf, .sdf, .mjcf or .xml",
          {"--keyframe"},
          {{"rigor import robot.urdf > robot.toml", "a case file to edit"},
           {"rigor import humanoid.xml --keyframe squat > squat.toml", "start from a keyframe of MJCF"}},
          import_command};
}

}  // namespace rigor
