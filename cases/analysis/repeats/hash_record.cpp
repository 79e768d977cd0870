#include "cases/analysis/repeats/hash_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>

#include "core/base/error.h"
#include "core/base/json.h"

namespace rigor::inline analysis {
namespace {

constexpr int kRecordVersion = 2;    // 1: each hash was made in one chain
constexpr std::size_t kDigits = 16;  // of a hash, hexadecimal

// FNV-1a (Fowler, Noll, Vo).
std::string hash_of_text(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return fmt::format("{:016x}", hash);
}

std::vector<std::uint64_t> hashes_in(const std::string& text) {
  std::vector<std::uint64_t> hashes;
  for (std::size_t at = 0; at + kDigits <= text.size(); at += kDigits) {
    std::uint64_t hash = 0;
    const auto [end, error] = std::from_chars(text.data() + at, text.data() + at + kDigits, hash, 16);
    if (error != std::errc() || end != text.data() + at + kDigits) throw InputError("");
    hashes.push_back(hash);
  }
  if (hashes.empty() || text.size() % kDigits != 0) throw InputError("");
  return hashes;
}

HashRecord record_in(const std::string& line) {
  const Json row = parse_json_or_discard(line);
  if (row.is_discarded() || !row.is_object() || !row.contains("rigor_hashes")) throw InputError("");
  if (row.at("rigor_hashes") != kRecordVersion)
    throw InputError(fmt::format(" of version {}: found {}", kRecordVersion, row.at("rigor_hashes").dump()));
  try {
    return {row.at("case"),    row.at("scene"), row.at("run"),
            row.at("version"), row.at("dt"),    hashes_in(row.at("hashes").get<std::string>())};
  } catch (const Json::exception&) {
    throw InputError("");
  }
}

}  // namespace

HashRecord hash_record(const Case& definition, const RunName& run, const EngineInfo& engine, const StepSize& dt,
                       std::vector<std::uint64_t> hashes) {
  return {definition.id, hash_of_text(definition.text), run.text, engine.version, dt.text, std::move(hashes)};
}

std::string line_of(const HashRecord& record) {
  std::string digits;
  for (const std::uint64_t hash : record.hashes) digits += fmt::format("{:016x}", hash);
  const Json row = {
      {"rigor_hashes", kRecordVersion}, {"case", record.case_id}, {"scene", record.scene}, {"run", record.run},
      {"version", record.version},      {"dt", record.dt},        {"hashes", digits}};
  return row.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::vector<HashRecord> read_hash_records(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw InputError(fmt::format("--against: cannot read '{}'", path));
  std::vector<HashRecord> records;
  std::string text;
  for (int line = 1; std::getline(file, text); ++line) {
    try {
      records.push_back(record_in(text));
    } catch (const InputError& error) {
      throw InputError(
          fmt::format("{}:{}: not a record of hashes{}; rigor repeat --record writes one", path, line, error.what()));
    }
  }
  if (records.empty()) throw InputError(fmt::format("{}: holds no record of hashes", path));
  return records;
}

const HashRecord& matching_record(const std::vector<HashRecord>& records, const HashRecord& own,
                                  const std::string& path) {
  const auto row =
      std::find_if(records.begin(), records.end(), [&](const HashRecord& one) { return one.case_id == own.case_id; });
  if (row == records.end()) throw InputError(fmt::format("{}: has no hashes of {}", path, own.case_id));
  const auto expect = [&](const char* what, const std::string& there, const std::string& here) {
    if (there != here)
      throw InputError(
          fmt::format("{}: the hashes of {} are of {} '{}'; this run has '{}'", path, own.case_id, what, there, here));
  };
  expect("run", row->run, own.run), expect("version", row->version, own.version), expect("dt", row->dt, own.dt);
  expect("case file", row->scene, own.scene);
  if (row->hashes.size() != own.hashes.size())
    throw InputError(fmt::format("{}: the hashes of {} are of {} steps; this run has {}", path, own.case_id,
                                 row->hashes.size() - 1, own.hashes.size() - 1));
  return *row;
}

}  // namespace rigor::inline analysis
