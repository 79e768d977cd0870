// The hashes of runs in a file, one JSON object a line, to compare with the same runs in another process or on another
// machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cases/case/case.h"
#include "core/engine/engine.h"
#include "core/engine/run_name.h"

namespace rigor::inline analysis {

struct HashRecord {
  std::string case_id;
  std::string scene;  // a hash of the case file's text
  std::string run, version, dt;
  std::vector<std::uint64_t> hashes;  // of the states at t = 0, after one step, ...
};

HashRecord hash_record(const Case& definition, const RunName& run, const EngineInfo& engine, const StepSize& dt,
                       std::vector<std::uint64_t> hashes);

std::string line_of(const HashRecord& record);

// Throws InputError, with file and line, for a text that is no record.
std::vector<HashRecord> read_hash_records(const std::string& path);

// The row of the same case. Throws InputError if there is none, or if it is of another scene, run, version or step.
const HashRecord& matching_record(const std::vector<HashRecord>& records, const HashRecord& own,
                                  const std::string& path);

}  // namespace rigor::inline analysis
