#include "cases/runner/shards/part.h"

#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "cases/results/result_json.h"
#include "cases/runner/build_identity.h"
#include "cases/runner/case_process.h"
#include "cases/runner/platform/platform.h"
#include "cases/runner/stable_step.h"
#include "core/base/content_hash.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/json_words.h"

namespace rigor::inline runner {
namespace {

using Subject = MessageSubject;

constexpr int kForm = 1;

Json json_of(const PartTitle& title, std::size_t answers) {
  return {{"rigor_part", kForm},     {"shard", title.shard.index},
          {"of", title.shard.count}, {"version", title.version},
          {"build", title.build},    {"arguments", title.arguments},
          {"suite", title.suite},    {"deviations", title.adapters},
          {"cases", title.plans},    {"wall_seconds", title.wall_seconds},
          {"answers", answers}};
}

PartTitle title_from(const Json& json) {
  if (json.at("rigor_part") != kForm) throw std::runtime_error("it is of another form");
  PartTitle title;
  title.shard = {json.at("shard").get<int>(), json.at("of").get<int>()};
  title.shard = parse_shard(fmt::format("{}/{}", title.shard.index, title.shard.count), "its shard");
  title.version = json.at("version").get<std::string>(), title.build = json.at("build").get<std::string>();
  title.arguments = json.at("arguments").get<std::vector<std::string>>();
  title.suite = json.at("suite").get<std::string>(), title.adapters = json.at("deviations").get<std::string>();
  title.plans = json.at("cases").get<std::vector<std::pair<std::string, std::string>>>();
  title.wall_seconds = json.at("wall_seconds").get<double>();
  return title;
}

// Why a case could not be judged, which no message of a case's process says.
std::string message_of_error(const CaseResult& result) {
  return text_of({{"error", result.error}, {"is_input", result.error_is_input}}, -1);
}

bool take_error(CaseResult& result, const std::string& message) {
  if (!message.starts_with("{\"error\"")) return false;
  const Json json = parse_json(message);
  if (result.error.empty()) {
    result.error = json.at("error").get<std::string>();
    result.error_is_input = json.at("is_input").get<bool>();
  }
  return true;
}

// Those that failed have left nothing in the journal.
void add_failed(const CaseResult& result, const std::set<std::size_t>& cells, const std::set<std::size_t>& stable_steps,
                std::vector<Journal::Record>& answers) {
  for (std::size_t i = 0; i < result.cells.size(); ++i) {
    if (result.cells[i].status != Status::unsupported && !cells.contains(i))
      answers.push_back({message_of_cell(i, result.cells[i], result.definition.scene), ""});
  }
  for (std::size_t i = 0; i < result.stable_steps.size(); ++i) {
    if (result.stable_steps[i].status != Status::unsupported && !stable_steps.contains(i))
      answers.push_back({message_of_stable_step(i, result.stable_steps[i]), ""});
  }
}

std::vector<Journal::Record> answers_of(const Results& planned, std::size_t index, const CaseResult& result,
                                        const EngineTable& engines, const GridOptions& options) {
  std::vector<Journal::Record> answers;
  if (result.truth) answers.push_back({message_of_truth(*result.truth), ""});
  if (!result.error.empty()) answers.push_back({message_of_error(result), ""});
  CaseResult scratch = planned.cases[index];
  std::set<std::size_t> cells, stable_steps;
  for (Journal::Record& record : kept_answers(planned, planned.cases[index], engines, options)) {
    const Subject subject = apply_message(scratch, record.message);
    (subject.part == Subject::Part::cell ? cells : stable_steps).insert(subject.index);
    answers.push_back(std::move(record));
  }
  add_failed(result, cells, stable_steps, answers);
  return answers;
}

std::string words_of(const std::vector<std::string>& arguments) {
  return fmt::format("'rigor {}'", fmt::join(arguments, " "));
}

// "" if both belong to the same grid.
std::string difference(const PartTitle& a, const PartTitle& b) {
  if (a.version != b.version) return fmt::format("version {} and {}", a.version, b.version);
  if (a.build != b.build) return "made by different builds of rigor or of an engine";
  if (a.shard.count != b.shard.count) return fmt::format("one of {} parts and one of {}", a.shard.count, b.shard.count);
  if (a.plans == b.plans) return "";
  if (a.arguments != b.arguments) return fmt::format("{} and {}", words_of(a.arguments), words_of(b.arguments));
  for (std::size_t i = 0; i < std::min(a.plans.size(), b.plans.size()); ++i) {
    if (a.plans[i].first != b.plans[i].first)
      return fmt::format("the case '{}' and '{}'", a.plans[i].first, b.plans[i].first);
    if (a.plans[i].second != b.plans[i].second)
      return fmt::format("the case '{}' is not the same in both", a.plans[i].first);
  }
  return fmt::format("{} cases and {}", a.plans.size(), b.plans.size());
}

std::set<int> shards_of(const std::vector<Part>& parts) {
  std::set<int> there;
  for (const Part& part : parts) there.insert(part.title.shard.index);
  return there;
}

std::string id_of(const Part& part, const Part::Answer& answer) {
  return answer.of < part.title.plans.size() ? part.title.plans[answer.of].first : "no case";
}

class Merge {
 public:
  explicit Merge(Results& grid) : grid_(grid), plan_(grid), paths_(grid.cases.size()), truths_(grid.cases.size()) {
    for (std::size_t i = 0; i < grid.cases.size(); ++i) index_[grid.cases[i].definition.id] = i;
  }

  void add(const Part& part) {
    for (const Part::Answer& answer : part.answers) {
      try {
        add(part, answer);
      } catch (const std::exception& error) {
        throw InputError(fmt::format("{}: is damaged: an answer of '{}' cannot be read: {}", part.folder,
                                     id_of(part, answer), in_words(error)));
      }
    }
    grid_.wall_seconds += part.title.wall_seconds;
  }

  Merged finish(const std::vector<Part>& parts) {
    merged_.missing = missing_shards(parts);
    const std::set<int> there = shards_of(parts);
    const Partition partition(plan_, parts.front().title.shard.count);
    for (std::size_t c = 0; c < grid_.cases.size(); ++c) {
      note_missing(grid_.cases[c], plan_.cases[c], partition.cases()[c], there);
      CaseResult& result = grid_.cases[c];
      if (!result.truth && result.error.empty()) result.error = "no part has come as far as its truth";
      result.spreads = spreads_of(plan_.cases[c], paths_[c]);
      hold_to_cells(result);
    }
    return std::move(merged_);
  }

 private:
  void add(const Part& part, const Part::Answer& answer) {
    const std::size_t c = index_.at(id_of(part, answer));
    CaseResult& result = grid_.cases[c];
    if (take_error(result, answer.record.message)) return;
    if (answer.record.message.starts_with("{\"truth\"")) return add_truth(part, c, answer.record.message);
    const Subject subject = apply_message(result, answer.record.message);
    if (subject.part == Subject::Part::spreads) throw std::runtime_error("it is about no cell");
    if (subject.part != Subject::Part::cell) return;
    const Cell& cell = result.cells[subject.index];
    if (!cell.trajectory.empty() && cell.trajectory != plan_.cases[c].cells[subject.index].trajectory)
      throw std::runtime_error("it names another trajectory");
    if (!answer.record.path.empty()) paths_[c][subject.index] = unpacked(answer.record.path);
    if (!cell.trajectory.empty()) merged_.trajectories[cell.trajectory] = part.folder;
  }

  void add_truth(const Part& part, std::size_t c, const std::string& message) {
    if (truths_[c].message.empty()) {
      apply_message(grid_.cases[c], message);
      truths_[c] = {message, part.folder};
    } else if (truths_[c].message != message) {
      merged_.remarks.push_back(
          fmt::format("the truth of {} is not the same in {} and {}: their machines compute "
                      "differently",
                      grid_.cases[c].definition.id, truths_[c].path, part.folder));
    }
  }

  // A cell that was heard of is no longer as it was planned.
  void note_missing(CaseResult& result, const CaseResult& planned, const Partition::OfCase& shards,
                    const std::set<int>& there) {
    std::size_t lost = 0;
    const auto note = [&](auto& part, const auto& before, int shard) {
      if (before.status == Status::unsupported || part.reason != before.reason) return;
      const bool is_there = there.contains(shard);
      part.reason = is_there ? "it did not run" : fmt::format("it did not run: shard {} is missing", shard);
      lost += is_there;
    };
    for (std::size_t i = 0; i < result.cells.size(); ++i) {
      note(result.cells[i], planned.cells[i], shards.cells[i]);
      if (result.cells[i].status == Status::crashed) result.cells[i].trajectory.clear();
    }
    for (std::size_t i = 0; i < result.stable_steps.size(); ++i)
      note(result.stable_steps[i], planned.stable_steps[i], shards.stable_steps[i]);
    if (lost > 0)
      merged_.missing.push_back(fmt::format("{}: {} cells that the parts should have", result.definition.id, lost));
  }

  Results& grid_;
  const Results plan_;
  std::map<std::string, std::size_t> index_;
  std::vector<PathsOfCells> paths_;
  std::vector<Journal::Record> truths_;  // the message, and the folder that it is from
  Merged merged_;
};

}  // namespace

std::vector<std::pair<std::string, std::string>> plans_of(const Results& grid, const EngineTable& engines,
                                                          const GridOptions& options) {
  std::vector<std::pair<std::string, std::string>> plans;
  for (const CaseResult& planned : grid.cases) {
    plans.emplace_back(planned.definition.id,
                       fmt::format("{:016x}", content_hash(plan_of(grid, planned, engines, options))));
  }
  return plans;
}

std::string part_text(const PartTitle& title, const Results& planned, const Results& share, const EngineTable& engines,
                      const GridOptions& options) {
  std::map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < title.plans.size(); ++i) index[title.plans[i].first] = i;
  std::string records;
  std::size_t count = 0;
  for (std::size_t c = 0; c < share.cases.size(); ++c) {
    for (const Journal::Record& answer : answers_of(planned, c, share.cases[c], engines, options)) {
      records += framed(index.at(share.cases[c].definition.id), answer);
      ++count;
    }
  }
  return part_head(title, count) + records;
}

std::string part_head(const PartTitle& title, std::size_t answers) {
  return text_of(json_of(title, answers), -1) + "\n";
}

std::vector<std::string> missing_shards(const std::vector<Part>& parts) {
  const int count = parts.front().title.shard.count;
  const std::set<int> there = shards_of(parts);
  std::vector<std::string> missing;
  for (int shard = 1; shard <= count; ++shard) {
    if (!there.contains(shard)) missing.push_back(fmt::format("shard {} of {} is missing", shard, count));
  }
  return missing;
}

Part read_part(const std::string& folder) {
  const std::filesystem::path file = std::filesystem::path(folder) / kPartFile;
  const ReadFile read = read_file(file);
  if (!read.is_whole)
    throw InputError(
        fmt::format("{}: holds no part of a grid: there is no '{}' in it that can be read; give folders "
                    "that 'rigor run --shard K/N --out DIR' wrote",
                    folder, kPartFile));
  const std::string& bytes = read.bytes;
  try {
    std::size_t at = std::min(bytes.find('\n'), bytes.size());
    const Json json = parse_json(bytes.substr(0, at));
    Part part{folder, title_from(json), {}};
    std::size_t index = 0;
    ++at;
    for (Journal::Record record; at < bytes.size() && take_record(bytes, at, index, record);)
      part.answers.push_back({index, std::move(record)});
    if (at != bytes.size() || part.answers.size() != json.at("answers").get<std::size_t>())
      throw std::runtime_error("it is cut short, or bytes of it have changed");
    return part;
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: is no part of a grid, or a damaged one: {}", file.string(), error.what()));
  }
}

void check_same_grid(const std::vector<Part>& parts) {
  std::map<int, std::string> seen;
  for (const Part& part : parts) {
    const std::string differs = difference(parts.front().title, part.title);
    if (!differs.empty())
      throw InputError(
          fmt::format("{} and {} are parts of different grids: {}", parts.front().folder, part.folder, differs));
    const auto [there, is_new] = seen.emplace(part.title.shard.index, part.folder);
    if (!is_new)
      throw InputError(fmt::format("{} and {} are both shard {} of {}; give each part once", there->second, part.folder,
                                   part.title.shard.index, part.title.shard.count));
  }
}

Merged fill_in(Results& grid, const std::vector<Part>& parts) {
  Merge merge(grid);
  for (const Part& part : parts) merge.add(part);
  return merge.finish(parts);
}

}  // namespace rigor::inline runner
