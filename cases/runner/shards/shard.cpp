#include "cases/runner/shards/shard.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>

#include "core/base/error.h"

namespace rigor::inline runner {
namespace {

// Body steps that take about as long as a child process and the judging of its run, and as a truth. How well they are
// guessed decides how even the shards are, and nothing else.
constexpr double kCellWork = 2e4, kTruthWork = 2e4;

// Walks along the grid's jobs by their work.
class Walk {
 public:
  Walk(double all, int count) : all_(all), count_(count) {}
  int next(double work) {
    const double middle = (before_ + work / 2) / all_;
    before_ += work;
    return 1 + std::min(count_ - 1, static_cast<int>(middle * count_));
  }

 private:
  double all_, before_ = 0;
  int count_;
};

double bodies_in(const CaseResult& result) { return static_cast<double>(result.definition.scene.bodies.size()); }

double work_of(const CaseResult& result, const Cell& cell) {
  return kCellWork + bodies_in(result) * result.definition.duration / cell.dt.seconds;
}

template <typename Part>
bool has_job(const Part& part) {
  return part.status != Status::unsupported;
}

bool read_whole(std::string_view text, int& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

}  // namespace

Shard parse_shard(const std::string& text, const std::string& what) {
  Shard shard;
  const std::size_t slash = std::min(text.find('/'), text.size());
  const bool is_read = slash < text.size() && read_whole(std::string_view(text).substr(0, slash), shard.index) &&
                       read_whole(std::string_view(text).substr(slash + 1), shard.count);
  if (!is_read || shard.count < 1 || shard.count > kMostShards || shard.index < 1 || shard.index > shard.count) {
    throw InputError(
        fmt::format("{}: found '{}'; allowed: K/N, the K-th of N parts, as 1/4 to 4/4, of at most {} parts", what, text,
                    kMostShards));
  }
  return shard;
}

bool Partition::OfCase::has(int shard) const {
  const auto is_its = [&](int of) { return of == shard; };
  return is_its(truth) || std::any_of(stable_steps.begin(), stable_steps.end(), is_its) ||
         std::any_of(cells.begin(), cells.end(), is_its);
}

// Searches are shared out by themselves, for how long one takes beside a cell is not known beforehand.
Partition::Partition(const Results& grid, int count) {
  double of_cells = 0, of_searches = 0;
  for (const CaseResult& result : grid.cases) {
    of_cells += kTruthWork;
    for (const Cell& cell : result.cells) of_cells += has_job(cell) ? work_of(result, cell) : 0;
    for (const StableStepResult& stable : result.stable_steps) of_searches += has_job(stable) ? bodies_in(result) : 0;
  }
  Walk cells(of_cells, count), searches(of_searches, count);
  for (const CaseResult& result : grid.cases) {
    OfCase of_case;
    of_case.truth = cells.next(kTruthWork);
    for (const StableStepResult& stable : result.stable_steps)
      of_case.stable_steps.push_back(has_job(stable) ? searches.next(bodies_in(result)) : 0);
    for (const Cell& cell : result.cells)
      of_case.cells.push_back(has_job(cell) ? cells.next(work_of(result, cell)) : 0);
    cases_.push_back(std::move(of_case));
  }
}

std::vector<int> shares_in(const Partition::OfCase& of_case) {
  std::set<int> found(of_case.cells.begin(), of_case.cells.end());
  found.insert(of_case.stable_steps.begin(), of_case.stable_steps.end());
  found.erase(0);
  if (found.empty()) found.insert(of_case.truth);
  return {found.begin(), found.end()};
}

void leave_to_others(CaseResult& result, const Partition::OfCase& of_case, int shard) {
  const auto leave = [&](auto& part, int of) {
    if (of != 0 && of != shard) skip(part, SkipReason::another_shard);
  };
  for (std::size_t i = 0; i < result.stable_steps.size(); ++i) leave(result.stable_steps[i], of_case.stable_steps[i]);
  for (std::size_t i = 0; i < result.cells.size(); ++i) leave(result.cells[i], of_case.cells[i]);
}

Results share_of(const Results& grid, const Shard& shard) {
  const Partition partition(grid, shard.count);
  Results share;
  share.runs = grid.runs, share.engines = grid.engines;
  for (std::size_t c = 0; c < grid.cases.size(); ++c) {
    const Partition::OfCase& of_case = partition.cases()[c];
    if (!of_case.has(shard.index)) continue;
    share.cases.push_back(grid.cases[c]);
    leave_to_others(share.cases.back(), of_case, shard.index);
  }
  return share;
}

}  // namespace rigor::inline runner
