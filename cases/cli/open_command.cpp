// rigor open: shows the report of the last run in the browser, by the desktop's xdg-open.
#include <fmt/format.h>

#include <filesystem>

#include "cases/cli/browser.h"
#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "core/base/error.h"

namespace rigor::inline cli {
namespace {

class OpenCommand : public Command {
 public:
  void declare(Options& options) override { out_.declare(options); }

  int run(const Invocation&) override {
    std::error_code error;
    const std::filesystem::path file =
        std::filesystem::absolute(std::filesystem::path(out_.dir) / "report.html", error);
    if (error || !std::filesystem::is_regular_file(file, error))
      throw InputError(
          fmt::format("rigor open: there is no {}; 'rigor run' writes it, and --out names its folder", file.string()));
    const std::string why = why_not_shown(file.string());
    if (why.empty()) return kGood;
    say(fmt::format("{}; open this file in a browser: {}", why, file.string()));
    return kBroken;
  }

 private:
  OutOption out_;
};

}  // namespace

CommandRow open_row() {
  return {"open",
          "show the report of a run in the browser",
          "",
          "",
          {{"rigor open", "the report in out/"}, {"rigor open --out nightly", "the report in nightly/"}},
          make_command<OpenCommand>};
}

}  // namespace rigor::inline cli
