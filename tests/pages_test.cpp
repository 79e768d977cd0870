// The pages: every README has the same headings, links lead somewhere, and entries of the changelog are short.
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "generated/tests/places.h"

BOOST_AUTO_TEST_SUITE(pages)

namespace {

namespace fs = std::filesystem;

const fs::path kPagesTop = RIGOR_SOURCE_DIR;

// Pages of the repository. Folders of packages and builds are skipped.
std::vector<fs::path> all_pages() {
  std::vector<fs::path> found;
  const auto add = [&](const fs::path& path) {
    if (path.extension() == ".md") found.push_back(path);
  };
  for (const auto& entry : fs::directory_iterator(kPagesTop)) add(entry.path());
  for (const char* room : {".github", "core", "adapters", "cases", "bench", "tests"}) {
    for (auto it = fs::recursive_directory_iterator(kPagesTop / room); it != fs::recursive_directory_iterator(); ++it) {
      if (it->path().filename() == "node_modules") it.disable_recursion_pending();
      add(it->path());
    }
  }
  return found;
}

std::string text_of(const fs::path& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Headings outside of code blocks, with their hashes: "## Layout".
std::vector<std::string> headings_of(const fs::path& page) {
  std::vector<std::string> found;
  std::istringstream in(text_of(page));
  bool is_code = false;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("```")) is_code = !is_code;
    if (!is_code && line.starts_with("#")) found.push_back(line);
  }
  return found;
}

// The anchor that a forge gives a heading: lower case, without punctuation, spaces as hyphens.
std::string anchor_of(const std::string& heading) {
  std::string anchor;
  for (const char c : heading.substr(heading.find(' ') + 1)) {
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_')
      anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (c == ' ') anchor += '-';
  }
  return anchor;
}

bool has_anchor(const fs::path& page, const std::string& anchor) {
  const std::vector<std::string> headings = headings_of(page);
  return std::any_of(headings.begin(), headings.end(),
                     [&](const std::string& heading) { return anchor_of(heading) == anchor; });
}

// Words of an entry; a piece of code counts as one.
std::size_t words_of(const std::string& entry) {
  const std::string text = std::regex_replace(entry, std::regex("`[^`]*`"), "Code");
  static const std::regex word("[A-Za-z][A-Za-z'-]+");
  return static_cast<std::size_t>(std::distance(std::sregex_iterator(text.begin(), text.end(), word), {}));
}

}  // namespace

BOOST_AUTO_TEST_CASE(every_readme_has_the_standard_headings_in_their_order) {
  int readmes = 0;
  for (const fs::path& page : all_pages()) {
    if (page.filename() != "README.md") continue;
    ++readmes;
    const std::vector<std::string> headings = headings_of(page);
    auto at = headings.begin();
    for (const char* name : {"## Purpose", "## Layout", "## How it works", "## How to extend", "## References"}) {
      at = std::find(at, headings.end(), name);
      BOOST_TEST((at != headings.end()), page.string() << " lacks \"" << name << "\", or has it too early");
      if (at == headings.end()) break;
    }
  }
  BOOST_TEST(readmes >= 13);
}

BOOST_AUTO_TEST_CASE(links_lead_to_files_and_headings) {
  static const std::regex link("\\]\\(([^)\\s]+)\\)");
  int links = 0;
  for (const fs::path& page : all_pages()) {
    const std::string text = text_of(page);
    for (auto it = std::sregex_iterator(text.begin(), text.end(), link); it != std::sregex_iterator(); ++it) {
      const std::string target = (*it)[1];
      if (target.starts_with("http")) continue;
      const std::size_t hash = std::min(target.find('#'), target.size());
      const fs::path file = hash == 0 ? page : page.parent_path() / target.substr(0, hash);
      BOOST_TEST(fs::exists(file), page.string() << ": no file for the link " << target);
      if (hash < target.size())
        BOOST_TEST(has_anchor(file, target.substr(hash + 1)), page.string() << ": no heading for the link " << target);
      ++links;
    }
  }
  BOOST_TEST(links >= 20);
}

BOOST_AUTO_TEST_CASE(entries_of_the_changelog_have_at_most_25_words) {
  std::istringstream in(text_of(kPagesTop / "CHANGELOG.md"));
  int entries = 0;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("### "))
      BOOST_TEST((line == "### Added" || line == "### Changed" || line == "### Fixed" || line == "### Removed"), line);
    if (!line.starts_with("- ")) continue;
    BOOST_TEST(words_of(line) <= 25, line);
    ++entries;
  }
  BOOST_TEST(entries >= 100);
}

BOOST_AUTO_TEST_SUITE_END()
