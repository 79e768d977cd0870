// rigor play: opens the laboratory in the browser. The scene stands in the page's address.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include "cases/case/suite.h"
#include "cases/cli/browser.h"
#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "core/base/error.h"
#include "core/base/near_match.h"

#ifndef RIGOR_PLAY_PAGE
#define RIGOR_PLAY_PAGE "build/release/play/index.html"
#endif

namespace rigor::inline cli {
namespace {

namespace fs = std::filesystem;

std::string in_address(const std::string& text) {
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

// Throws InputError for a case that the page does not carry.
std::string case_id_of(const std::string& word) {
  const std::vector<std::string> ids = suite_ids(default_suite_dir());
  if (std::find(ids.begin(), ids.end(), word) != ids.end()) return word;
  std::error_code error;
  if (fs::exists(word, error))
    throw InputError(
        fmt::format("rigor play: {} is no case of the suite; run 'rigor play' and drop the file onto the page", word));
  throw InputError(
      fmt::format("rigor play: there is no case '{}'{}; rigor list cases names them", word, did_you_mean(word, ids)));
}

class PlayCommand : public Command {
 public:
  void declare(Options& options) override { options.add_words(words_); }

  int run(const Invocation&) override {
    if (words_.size() > 1)
      throw InputError(fmt::format("rigor play: found {} cases; allowed: at most one", words_.size()));
    const std::string place = words_.empty() ? "" : "#/" + in_address(case_id_of(words_.front()));
    const fs::path page = RIGOR_PLAY_PAGE;
    std::error_code error;
    if (!fs::is_regular_file(page, error))
      throw InputError(
          fmt::format("rigor play: there is no {}; 'cases/setup release play' builds the laboratory", page.string()));
    const std::string address = "file://" + in_address(page.string()) + place;
    const std::string why = why_not_shown(place.empty() ? page.string() : file_that_leads_to(address).string());
    if (why.empty()) return kGood;
    say(fmt::format("{}; open this address in a browser: {}", why, address));
    return kBroken;
  }

 private:
  std::vector<std::string> words_;
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

}  // namespace rigor::inline cli
