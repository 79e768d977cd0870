#include "tests/fuzz/targets.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "adapters/plugin/answer.h"
#include "adapters/plugin/plugin_info.h"
#include "cases/case/case_reader.h"
#include "cases/results/baseline.h"
#include "cases/results/history.h"
#include "cases/results/result_json.h"
#include "cases/results/spread.h"
#include "cases/runner/journal.h"
#include "core/base/error.h"
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

// For what is read by its path; the same file again and again, in memory where that is to be had.
const std::string& file_with(const std::string& bytes) {
  static const std::string path = [] {
    const auto folder = std::filesystem::exists("/dev/shm") ? "/dev/shm" : std::filesystem::temp_directory_path();
    return (folder / ("rigor_fuzz_" + std::to_string(getpid()))).string();
  }();
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

void read_case_file(const std::string& bytes) {
  read_or_refuse([&] { read_case_text(bytes, "fuzzed.toml", "fuzzed", test::words()); });
}

// The answers of a plug-in: the handshake, and those to calls about two bodies.
void read_plugin(const std::string& bytes) {
  read_or_refuse([&] { read_plugin_info(bytes, "fuzzed"); });
  try {
    const Asked asked{"fuzzed", "read", 1};
    const nlohmann::json answer = parsed_answer(bytes, asked);
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

// results.json or a baseline, and a history. What was read is written so that it reads the same.
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
  static const std::vector<Target> all = {
      {"case", read_case_file}, {"plugin", read_plugin}, {"records", read_records}, {"results", read_results}};
  return all;
}

}  // namespace rigor::fuzz
