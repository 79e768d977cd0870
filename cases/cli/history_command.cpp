// rigor history: adds the result of a run to a file, commit by commit, and shows the changes.
#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>

#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "cases/report/console/history_table.h"
#include "cases/report/html/history_page.h"
#include "core/base/error.h"
#include "core/base/near_match.h"

namespace rigor {
namespace {

namespace fs = std::filesystem;

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

int add(const CommandLine& line) {
  if (line.words.size() != 2)
    throw InputError("rigor history add: takes one folder that 'rigor run' wrote, or its results.json");
  std::error_code error;
  const fs::path given = line.words[1], file = fs::is_directory(given, error) ? given / "results.json" : given;
  const HistoryEntry entry = history_entry(file.string(), current_commit(), now());
  add_to_history(line.file, entry);
  say(fmt::format("{} cells of commit {} are added to {}", entry.cells.size(), entry.commit, line.file));
  return kGood;
}

// Replaces the page as a whole, or leaves the old one.
void write_page(const std::string& file, const std::string& text) {
  const std::string growing = file + ".partial";
  std::ofstream stream(growing, std::ios::binary);
  stream << text;
  stream.close();
  std::error_code error;
  if (stream) fs::rename(growing, file, error);
  if (stream && !error) return;
  const std::string why = error ? error.message() : std::strerror(errno);
  fs::remove(growing, error);
  throw InputError(fmt::format("--page {}: cannot be written: {}", file, why));
}

int show(const CommandLine& line) {
  const std::vector<HistoryEntry> history = read_history(line.file);
  const std::vector<std::string> words(line.words.begin() + 1, line.words.end());
  if (!line.page.empty()) write_page(line.page, history_page(history, words));
  print_table(history_table(history, words));
  return kGood;
}

}  // namespace

int history_command(const CommandLine& line, const EngineTable&) {
  const std::vector<std::string> known = {"add", "show"};
  const std::string what = line.words.empty() ? "" : line.words.front();
  if (what == "add") return add(line);
  if (what == "show") return show(line);
  throw InputError(fmt::format("rigor history: found '{}'{}; allowed: add DIR, or show [CASE or ENGINE]", what,
                               did_you_mean(what, known)));
}

CommandRow history_row() {
  return {"history",
          "add a result to a history, or show errors and costs along it",
          "ACTION",
          "add and the folder of a run; or show and parts of case and engine names",
          {"--file", "--page"},
          {{"rigor history add out", "add the run in out/ to history.jsonl"},
           {"rigor history show springs ode --page history.html", "show some of it, as a page too"}},
          history_command};
}

}  // namespace rigor
