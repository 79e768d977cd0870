// rigor export: prints a case's scene in the format of another program.
#include <fmt/format.h>

#include "cases/cli/commands.h"
#include "cases/cli/options.h"
#include "cases/cli/output.h"
#include "cases/report/scene/scene_formats.h"
#include "core/base/error.h"

namespace rigor {

static int export_command(const CommandLine& line, const EngineTable& engines) {
  if (line.format.empty()) throw InputError("rigor export: which format? Give --format mjcf or --format sdf");
  const SceneFormat& format = find_scene_format(line.format);
  LeftOut left_out;
  const std::string text = format.text(the_case(line, engines).scene, left_out);
  for (const std::string& sentence : left_out.sentences()) say(harmless("left out: " + sentence));
  print(text);
  return kGood;
}

CommandRow export_row() {
  return {"export",
          "print a case's scene for other programs; stderr lists what was left out",
          "CASE",
          "a case or a file",
          with_import_options({"--format", "--suite"}),
          {{"rigor export joints/double-pendulum --format mjcf > pendulum.xml", "for MuJoCo"},
           {"rigor export joints/double-pendulum --format sdf > pendulum.sdf", "for Gazebo"}},
          export_command};
}

}  // namespace rigor
