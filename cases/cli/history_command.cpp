// rigor history: adds the result of a run to a file, commit by commit, and shows the changes.
#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>

#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "cases/report/console/history_table.h"
#include "cases/report/html/history_page.h"
#include "core/base/error.h"
#include "core/base/near_match.h"

namespace rigor::inline cli {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kActions = {"add", "show"};

std::string now() {
  const std::time_t seconds = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  std::array<char, 32> text{};
  const std::size_t length = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return {text.data(), length};
}

// The commit that a CI runner names, or that of the current folder's repository.
std::string current_commit() {
  constexpr std::size_t kShort = 12;
  for (const char* variable : {"RIGOR_COMMIT", "GITHUB_SHA", "CI_COMMIT_SHA"}) {
    const char* value = std::getenv(variable);
    if (value && *value) return std::string(value).substr(0, kShort);
  }
  FILE* git = popen("git rev-parse --short=12 HEAD 2>/dev/null", "r");
  constexpr const char* kNone = "unknown";
  if (!git) return kNone;
  std::array<char, 64> text{};
  const std::size_t length = std::fread(text.data(), 1, text.size() - 1, git);
  const bool is_good = pclose(git) == 0;
  std::string commit(text.data(), length);
  while (!commit.empty() && commit.back() == '\n') commit.pop_back();
  return is_good ? commit : kNone;
}

class HistoryCommand : public Command {
 public:
  void declare(Options& options) override {
    options.add_words(words_);
    options.add({"--file", "FILE", "the history's file; default: history.jsonl"}, file_);
    options.add({"--page", "FILE.html", "also draw the history as a page"}, page_);
  }

  int run(const Invocation&) override {
    const std::string what = words_.empty() ? "" : words_.front();
    if (what == "add") return add();
    if (what == "show") return show();
    throw InputError(fmt::format("rigor history: found '{}'{}; allowed: add DIR, or show [CASE or ENGINE]", what,
                                 did_you_mean(what, kActions)));
  }

 private:
  int add() const {
    if (words_.size() != 2)
      throw InputError("rigor history add: takes one folder that 'rigor run' wrote, or its results.json");
    std::error_code error;
    const fs::path given = words_[1], file = fs::is_directory(given, error) ? given / "results.json" : given;
    const HistoryEntry entry = history_entry(file.string(), current_commit(), now());
    add_to_history(file_, entry);
    say(fmt::format("{} cells of commit {} are added to {}", entry.cells.size(), entry.commit, file_));
    return kGood;
  }

  int show() const {
    const std::vector<HistoryEntry> history = read_history(file_);
    const std::vector<std::string> words(words_.begin() + 1, words_.end());
    if (!page_.empty()) write_file("--page", page_, history_page(history, words));
    print_table(history_table(history, words));
    return kGood;
  }

  std::vector<std::string> words_;
  std::string file_ = "history.jsonl", page_;  // an empty page is not drawn
};

}  // namespace

CommandRow history_row() {
  return {"history",
          "add a result to a history, or show errors and costs along it",
          "ACTION",
          "add and the folder of a run; or show and parts of case and engine names",
          {{"rigor history add out", "add the run in out/ to history.jsonl"},
           {"rigor history show springs ode --page history.html", "show some of it, as a page too"}},
          make_command<HistoryCommand>,
          kActions};
}

}  // namespace rigor::inline cli
