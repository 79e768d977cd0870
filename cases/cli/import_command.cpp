// rigor import: a robot's file as a case file on stdout, and on stderr what it says that a scene cannot.
#include "cases/case/case_reader.h"
#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "cases/cli/vocabulary.h"
#include "cases/import/import.h"
#include "core/base/error.h"

namespace rigor {

int import_command(const CommandLine& line, const EngineTable& engines) {
  if (line.words.size() != 1) throw InputError("rigor import: takes one file, URDF, SDF or MJCF");
  const std::string& path = line.words.front();
  const Import made = import_model(path, line.keyframe);
  // What is printed is what `rigor run` reads.
  read_case_text(made.case_text, path, path, vocabulary_of(engines.infos()));
  for (const std::string& sentence : made.left_out) say(harmless("left out: " + sentence));
  print(made.case_text);
  return kGood;
}

}  // namespace rigor
