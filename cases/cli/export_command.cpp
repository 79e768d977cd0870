// rigor export: prints a case's scene in the format of another program.
#include <fmt/format.h>

#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "cases/report/scene/scene_formats.h"
#include "core/base/error.h"
#include "core/base/names_of.h"

namespace rigor::inline cli {

namespace {

class ExportCommand : public Command {
 public:
  void declare(Options& options) override {
    cases_.declare(options);
    options.add({"--format", "F", either_of(names_of(scene_formats())), names_of(scene_formats())}, format_);
  }

  int run(const Invocation& invocation) override {
    if (format_.empty()) throw InputError("rigor export: which format? Give --format mjcf or --format sdf");
    const SceneFormat& format = find_scene_format(format_);
    LeftOut left_out;
    const std::string text = format.text(the_case(cases_, invocation, built_in_engines()).scene, left_out);
    for (const std::string& sentence : left_out.sentences()) say(harmless("left out: " + sentence));
    print(text);
    return kGood;
  }

 private:
  CaseWords cases_;
  std::string format_;
};

}  // namespace

CommandRow export_row() {
  return {"export",
          "print a case's scene for other programs; stderr lists what was left out",
          "CASE",
          "a case or a file",
          {{"rigor export joints/double-pendulum --format mjcf > pendulum.xml", "for MuJoCo"},
           {"rigor export joints/double-pendulum --format sdf > pendulum.sdf", "for Gazebo"}},
          make_command<ExportCommand>};
}

}  // namespace rigor::inline cli
