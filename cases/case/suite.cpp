#include "cases/case/suite.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "cases/case/case_reader.h"
#include "cases/case/family.h"
#include "cases/case/program_home.h"
#include "cases/import/import.h"
#include "core/base/error.h"
#include "core/base/near_match.h"

namespace rigor::inline cases {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExtension = ".toml";

// The case files below a folder, sorted, without family.toml. An unreadable folder is skipped.
std::vector<fs::path> case_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  fs::recursive_directory_iterator entry(folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    std::error_code gone;
    const fs::path& path = entry->path();
    if (path.extension() == kExtension && path.filename() != kFamilyFile && !entry->is_directory(gone))
      files.push_back(path);
  }
  if (error) throw InputError(fmt::format("{}: cannot be searched for cases: {}", folder.string(), error.message()));
  std::sort(files.begin(), files.end());
  return files;
}

// Below `folder` and named from it; empty if it is not below.
std::string named_from(const fs::path& folder, const fs::path& path) {
  std::error_code error;
  const fs::path base = fs::weakly_canonical(folder, error), whole = fs::weakly_canonical(path, error);
  const fs::path relative = whole.lexically_relative(base);
  return relative.empty() || *relative.begin() == ".." ? "" : relative.generic_string();
}

// Results give the place of a gate relative to the current folder, as annotations of a repository need, or relative to
// the suite. They never contain this machine's paths.
void shorten_places(Case& definition, const std::string& folder, const std::string& suite_dir) {
  std::error_code error;
  const auto shorten = [&](std::string& where) {
    const std::size_t dot = where.starts_with(folder) ? where.find(kExtension, folder.size()) : std::string::npos;
    if (dot == std::string::npos) return;
    const std::size_t end = dot + std::string(kExtension).size();
    const std::string path = where.substr(0, end);
    std::string shorter = named_from(fs::current_path(error), path);
    if (shorter.empty()) shorter = named_from(suite_dir, path);
    if (!shorter.empty()) where.replace(0, end, shorter);
  };
  shorten(definition.truth_where);
  for (Gate& gate : definition.gates) shorten(gate.where);
}

// The family.toml of each folder that a case was found in, read once.
class Families {
 public:
  explicit Families(const Vocabulary& words) : words_(words) {}
  void add_gates(const std::string& case_path, Case& definition) {
    const fs::path path = fs::path(case_path).parent_path() / kFamilyFile;
    auto found = families_.find(path.string());
    if (found == families_.end()) {
      std::error_code error;
      const bool is_there = fs::exists(fs::symlink_status(path, error));
      found = families_.emplace(path.string(), is_there ? read_family(path.string(), words_) : Family{}).first;
    }
    add_family_gates(found->second, words_, definition);
  }

 private:
  const Vocabulary& words_;
  std::map<std::string, Family> families_;
};

// A case's file, and the id by which it goes.
struct Found {
  std::string id, path;
};

// The suite as it lies on the disk.
class Suite {
 public:
  explicit Suite(const std::string& dir) : dir_(dir) {
    std::error_code error;
    if (!fs::is_directory(dir_, error)) return;  // files elsewhere can still be run
    for (const fs::path& file : case_files(dir_)) ids_.push_back(id_of(file));
    std::sort(ids_.begin(), ids_.end());
  }

  // Without the folder no word can name a case, so the folder is at fault and not the word.
  void expect_folder() const {
    std::error_code error;
    if (!fs::is_directory(dir_, error))
      throw InputError(fmt::format("--suite: there is no folder '{}'", dir_.string()));
  }

  const std::vector<std::string>& ids() const { return ids_; }
  Found found(const std::string& id) const { return {id, (dir_ / (id + kExtension)).string()}; }

  // The ids that a word names: itself, its family, or those that end with it.
  std::vector<std::string> named(const std::string& word) const {
    if (std::binary_search(ids_.begin(), ids_.end(), word)) return {word};
    const std::string family = word.ends_with('/') ? word : word + "/";
    auto ids = those([&](const std::string& id) { return id.starts_with(family); });
    if (!ids.empty()) return ids;
    ids = those([&](const std::string& id) { return last_part(id) == word; });
    if (ids.size() > 1) {
      throw InputError(fmt::format("'{}' is the name of several cases: {}; give one of these", word, listed(ids)));
    }
    return ids;
  }

  // Every word that names a case or a family.
  std::vector<std::string> words() const {
    std::set<std::string> words(ids_.begin(), ids_.end());
    for (const std::string& id : ids_) {
      words.insert(last_part(id));
      for (auto slash = id.find('/'); slash != std::string::npos; slash = id.find('/', slash + 1)) {
        words.insert(id.substr(0, slash));
      }
    }
    return {words.begin(), words.end()};
  }

  // A file given by its path goes by that path, unless it is one of the suite's.
  Found found_at(const fs::path& path) const {
    std::error_code error;
    const fs::path inside = fs::relative(path, dir_, error);
    const std::string id = error || inside.empty() ? "" : fs::path(inside).replace_extension().generic_string();
    const bool of_suite = std::binary_search(ids_.begin(), ids_.end(), id) && inside.extension() == kExtension;
    return {of_suite ? id : path.string(), path.string()};
  }

 private:
  static std::string last_part(const std::string& id) { return id.substr(id.rfind('/') + 1); }

  std::string id_of(const fs::path& file) const {
    return file.lexically_relative(dir_).replace_extension().generic_string();
  }

  template <typename Condition>
  std::vector<std::string> those(const Condition& condition) const {
    std::vector<std::string> ids;
    std::copy_if(ids_.begin(), ids_.end(), std::back_inserter(ids), condition);
    return ids;
  }

  fs::path dir_;
  std::vector<std::string> ids_;
};

Case case_of_model(const std::string& path, const std::string& id, const ImportOptions& options) {
  Import made = import_model(path, options);
  refuse_losses(made, path, options);
  Case out;
  out.id = id, out.title = made.title, out.source = made.source;
  out.text = case_text_of(made);
  out.duration = kModelDuration;
  for (const char* dt : kModelSteps) out.dt.push_back(parse_step_size(dt, "dt"));
  out.truth = truth_of_model(made.scene), out.truth_where = path + ":1:1";
  out.scene = std::move(made.scene), out.losses = std::move(made.losses);
  return out;
}

std::vector<Found> find_on_disk(const std::string& word, const Suite& suite) {
  std::error_code error;
  const fs::file_status status = fs::status(word, error);
  if (fs::is_directory(status)) {
    std::vector<Found> found;
    for (const fs::path& file : case_files(word)) found.push_back(suite.found_at(file));
    if (found.empty())
      throw InputError(fmt::format("{}: there is no case, no {} file, in this folder", word, kExtension));
    return found;
  }
  if (fs::exists(status)) {
    if (fs::path(word).extension() != kExtension && !is_model_file(word))
      throw InputError(
          fmt::format("{}: is not a {} file, nor one of a robot: .urdf, .sdf, .mjcf, .xml", word, kExtension));
    if (fs::path(word).filename() == kFamilyFile)
      throw InputError(fmt::format("{}: states the gates of the cases beside it and is none itself", word));
    return {suite.found_at(word)};
  }
  suite.expect_folder();
  throw InputError(fmt::format("there is no case, family, file or folder '{}'{}; 'rigor list cases' names the cases",
                               word, did_you_mean(word, suite.words())));
}

std::vector<Found> find_cases(const std::string& word, const Suite& suite) {
  if (word.empty()) throw InputError("an empty word names no case");
  const auto ids = suite.named(word);
  if (ids.empty()) return find_on_disk(word, suite);
  std::vector<Found> found;
  for (const std::string& id : ids) found.push_back(suite.found(id));
  return found;
}

}  // namespace

std::vector<std::string> suite_ids(const std::string& suite_dir) { return Suite(suite_dir).ids(); }

std::vector<Case> select_cases(const std::vector<std::string>& words, const std::string& suite_dir,
                               const Vocabulary& vocabulary, const ImportOptions& options) {
  const Suite suite(suite_dir);
  std::vector<Found> selected;
  for (const std::string& id : suite.ids()) {
    if (words.empty()) selected.push_back(suite.found(id));
  }
  for (const std::string& word : words) {
    for (Found& found : find_cases(word, suite)) selected.push_back(std::move(found));
  }
  if (selected.empty()) suite.expect_folder();
  if (selected.empty()) throw InputError(fmt::format("--suite: there is no case in the folder '{}'", suite_dir));

  std::vector<Case> cases;
  std::set<std::string> seen;  // by file, however it was named
  Families families(vocabulary);
  for (const Found& found : selected) {
    std::error_code error;
    if (!seen.insert(fs::weakly_canonical(found.path, error).string()).second) continue;
    cases.push_back(is_model_file(found.path) ? case_of_model(found.path, found.id, options)
                                              : read_case(found.path, found.id, vocabulary));
    families.add_gates(found.path, cases.back());
    shorten_places(cases.back(), fs::path(found.path).parent_path().string(), suite_dir);
  }
  return cases;
}

std::string default_suite_dir() { return home_folder("suite", RIGOR_SUITE_DIR); }

}  // namespace rigor::inline cases
