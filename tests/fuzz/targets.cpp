#include "tests/fuzz/targets.h"

#include <stdlib.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "adapters/plugin/answer.h"
#include "adapters/plugin/plugin_info.h"
#include "cases/case/case_reader.h"
#include "cases/import/import.h"
#include "cases/results/baseline.h"
#include "cases/results/history.h"
#include "cases/results/result_json.h"
#include "cases/results/spread.h"
#include "cases/runner/journal/journal.h"
#include "cases/truth/solved/solution_cache.h"
#include "core/base/content_hash.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "tests/cases/vocabulary.h"

namespace rigor::fuzz {
namespace {

// Refused as bad input is.
template <typename Read>
void read_or_refuse(const Read& read) {
  try {
    read();
  } catch (const InputError&) {
  }
}

// In memory where that is to be had.
std::string path_for(const std::string& ending) {
  const std::filesystem::path folder =
      std::filesystem::exists("/dev/shm") ? "/dev/shm" : std::filesystem::temp_directory_path();
  return (folder / ("rigor_fuzz_" + std::to_string(getpid()) + ending)).string();
}

// For what is read by its path; the same file again and again.
const std::string& file_with(const std::string& bytes) {
  static const std::string path = path_for("");
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Other tests of this process have the cache that they had.
template <typename Do>
auto with_cache_in(const std::string& folder, const Do& act) {
  const char* said = std::getenv("RIGOR_CACHE_DIR");
  const std::optional<std::string> before = said ? std::optional<std::string>(said) : std::nullopt;
  ::setenv("RIGOR_CACHE_DIR", folder.c_str(), 1);
  const auto result = act();
  before ? ::setenv("RIGOR_CACHE_DIR", before->c_str(), 1) : ::unsetenv("RIGOR_CACHE_DIR");
  return result;
}

// A folder of kept solutions with one in it, which may be overwritten.
class KeptFile {
 public:
  KeptFile() : folder_(path_for("_cache")) {
    std::filesystem::remove_all(folder_);
    with_cache_in(folder_, [] { return keep_solution(kContent, {}), 0; });
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) file_ = entry.path().string();
    if (file_.empty()) std::abort();
    constexpr std::size_t kOfNothing = 8 * 8 + 8;  // a dimension, whether it is complete, six lengths; the seal
    head_ = content(file_), head_.resize(head_.size() - kOfNothing);
  }
  ~KeptFile() { std::filesystem::remove_all(folder_); }

  std::optional<ReferenceSolution> with(const std::string& bytes) const {
    std::ofstream(file_, std::ios::binary) << bytes;
    return with_cache_in(folder_, [] { return kept_solution(kContent); });
  }
  // What is read behind the head, under a seal that fits.
  std::optional<ReferenceSolution> with_body(const std::string& body) const {
    const std::string bytes = head_ + body;
    const std::uint64_t seal = content_hash(bytes);
    return with(bytes + std::string(reinterpret_cast<const char*>(&seal), sizeof seal));
  }

 private:
  static constexpr const char* kContent = "fuzzed";
  std::string folder_, file_, head_;
};

// A kept solution: any bytes are none; under a good seal it is none, or one that is kept and read again as it is.
void read_cache(const std::string& bytes) {
  static const KeptFile file;
  if (file.with(bytes)) std::abort();
  if (const auto solution = file.with_body(bytes)) {
    const std::size_t nodes = solution->times.size();
    if (nodes == 0 || solution->states.size() % nodes != 0 || solution->states.size() / nodes != solution->dimension)
      std::abort();
  }
}

// A robot's file in URDF or SDF; MJCF is read by MuJoCo's own parser. What is taken is a case file that can be read.
void read_model(const std::string& bytes) {
  static const std::string path = path_for(".xml");
  std::ofstream(path, std::ios::binary) << bytes;
  if (bytes.find("<mujoco") != std::string::npos) return;
  read_or_refuse([&] { read_case_text(case_text_of(import_model(path)), "fuzzed.toml", "fuzzed", test::words()); });
}

void read_case_file(const std::string& bytes) {
  read_or_refuse([&] { read_case_text(bytes, "fuzzed.toml", "fuzzed", test::words()); });
}

// The answers of a plug-in: the handshake, and those to calls about two bodies.
void read_plugin(const std::string& bytes) {
  read_or_refuse([&] { read_plugin_info(bytes, "fuzzed"); });
  try {
    const Question asked{"fuzzed", "read", 1};
    const Json answer = parsed_answer(bytes, asked);
    BodyTable bodies(2);
    check_time(answer, asked, 1, 0.5);
    read_bodies(answer, asked, bodies.columns());
  } catch (const EngineFailure&) {
  }
}

// A journal's records, or those of a part, and what they hold. Their readers may throw any std::exception: it is caught
// where they are called, and the record is not believed.
void read_records(const std::string& bytes) {
  std::size_t at = 0, job = 0;
  for (Journal::Record record; take_record(bytes, at, job, record);) {
  }
  CaseResult result;
  result.cells.resize(2), result.stable_steps.resize(2);
  result.definition.scene.bodies.resize(2);
  try {
    apply_message(result, bytes);
  } catch (const std::exception&) {
  }
  try {
    const Path path = unpacked(bytes);
    if (packed(path) != bytes) std::abort();
    spread_between(path, path);
  } catch (const std::runtime_error&) {
  }
}

// results.json or a baseline, and a history. Data that were read are written and must read the same.
void read_results(const std::string& bytes) {
  const std::string& path = file_with(bytes);
  read_or_refuse([&] { read_history(path); });
  read_or_refuse([&] {
    const std::string text = baseline_text(read_baseline(path));
    if (baseline_text(read_baseline(file_with(text))) != text) std::abort();
  });
}

}  // namespace

const std::vector<Target>& targets() {
  static const std::vector<Target> all = {{"cache", read_cache},     {"case", read_case_file},
                                          {"import", read_model},    {"plugin", read_plugin},
                                          {"records", read_records}, {"results", read_results}};
  return all;
}

}  // namespace rigor::fuzz
