// rigor play: opens the laboratory in the browser. The scene stands in the page's address.
#include <fmt/format.h>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "adapters/engines.h"
#include "cases/cli/browser.h"
#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "core/base/error.h"

#ifndef RIGOR_PLAY_PAGE
#define RIGOR_PLAY_PAGE "build/release/play/index.html"
#endif

namespace rigor {
namespace {

namespace fs = std::filesystem;

std::string escaped(const std::string& text) {
  std::string out;
  for (const unsigned char c : text) {
    const bool is_plain = std::isalnum(c) != 0 || c == '/' || c == '-' || c == '_' || c == '.';
    out += is_plain ? std::string(1, static_cast<char>(c)) : fmt::format("%{:02X}", static_cast<int>(c));
  }
  return out;
}

// xdg-open drops what stands behind the "#" of an address. So it gets a file that leads there.
fs::path file_that_leads_to(const std::string& address) {
  const fs::path file = fs::temp_directory_path() / "rigor-play.html";
  std::ofstream stream(file);
  stream << "<!doctype html><meta charset=\"utf-8\"><meta http-equiv=\"refresh\" content=\"0; url=" << address
         << "\"><title>Rigor: laboratory</title><a href=\"" << address << "\">Rigor: laboratory</a>\n";
  if (!stream.flush()) throw InputError(fmt::format("rigor play: cannot write {}", file.string()));
  return file;
}

class PlayCommand : public Command {
 public:
  void declare(Options& options) override { cases_.declare(options); }

  int run(const Invocation& invocation) override {
    const fs::path page = RIGOR_PLAY_PAGE;
    std::error_code error;
    if (!fs::is_regular_file(page, error))
      throw InputError(
          fmt::format("rigor play: there is no {}; 'cases/setup release play' builds the laboratory", page.string()));
    const std::string address = "file://" + escaped(page.string()) + place_of(invocation);
    const std::string why = why_not_shown(cases_.words.empty() ? page.string() : file_that_leads_to(address).string());
    if (why.empty()) return kGood;
    say(fmt::format("{}; open this address in a browser: {}", why, address));
    return kBroken;
  }

 private:
  // The page carries the suite, and no file from elsewhere.
  std::string place_of(const Invocation& invocation) const {
    if (cases_.words.empty()) return "";
    const Case chosen = the_case(cases_, invocation, engines());
    if (fs::exists(cases_.words.front()) && chosen.id == cases_.words.front())
      throw InputError(
          fmt::format("rigor play: {} is not a case of the suite; run 'rigor play' and drop the file onto "
                      "the page",
                      chosen.id));
    return "#/" + escaped(chosen.id);
  }

  CaseWords cases_;
};

}  // namespace

CommandRow play_row() {
  return {"play",
          "open the laboratory in the browser: scenes, methods and sliders, live",
          "CASE",
          "a case of the suite; default: the first scene of the course",
          {{"rigor play", "the laboratory"}, {"rigor play contact/collision", "with this scene"}},
          make_command<PlayCommand>};
}

}  // namespace rigor
