// A fixed share of a grid's jobs, for many machines to have one each: `--shard K/N`. Every job is in exactly one shard,
// which follows from the grid and N alone. Shards are stretches of the grid of about the same work, so that one makes
// the truths of few cases.
#pragma once

#include <string>
#include <vector>

#include "cases/results/results.h"

namespace rigor::inline runner {

struct Shard {
  int index = 1, count = 1;  // from 1 to `count`
  bool is_all() const { return count == 1; }
  bool operator==(const Shard&) const = default;
};

inline constexpr int kMostShards = 100000;

// "2/8". Throws InputError, begun by `what`, for anything but whole numbers of which the first is at most the second.
Shard parse_shard(const std::string& text, const std::string& what);

// The shard of each part of a planned grid. Cells and stable steps that are `unsupported` belong to no shard: 0.
class Partition {
 public:
  struct OfCase {
    int truth = 0;
    std::vector<int> stable_steps, cells;
    bool has(int shard) const;  // whether the shard needs the case, its truth too
  };
  Partition(const Results& grid, int count);
  const std::vector<OfCase>& cases() const { return cases_; }

 private:
  std::vector<OfCase> cases_;
};

// The number of shares into which ranks cut a grid, for any number of ranks, so that another number of ranks can
// continue. There are enough shares that ranks end together, and few enough that few truths are made twice.
inline constexpr int kShares = 1024;

// Those that have a part in a case, one at least.
std::vector<int> shares_in(const Partition::OfCase& of_case);

// The parts of other shards become `unsupported`.
void leave_to_others(CaseResult& result, const Partition::OfCase& of_case, int shard);

// The grid with the cases of one shard alone, in their order, and in them as `unsupported` what other shards do.
Results share_of(const Results& grid, const Shard& shard);

}  // namespace rigor::inline runner
