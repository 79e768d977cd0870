// The result of one shard for `rigor merge`, in one file. The first line is JSON that describes the grid. The answers
// of the shard's cells follow, with the paths for spreads between cells of different shards.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "cases/runner/grid.h"
#include "cases/runner/journal/journal.h"
#include "cases/runner/shards/shard.h"

namespace rigor::inline runner {

inline constexpr const char* kPartFile = "part.journal";

struct PartTitle {
  Shard shard;
  std::string version, build;          // of the program; see build_identity.h
  std::vector<std::string> arguments;  // the command and its options, without options that may differ between parts
  std::string suite, adapters;         // the folders, absolute
  // For the whole grid: each case's id and the hash of its plan. For a sweep: one hash of everything.
  std::vector<std::pair<std::string, std::string>> plans;
  double wall_seconds = 0;
};

struct Part {
  std::string folder;  // as it was named
  PartTitle title;
  struct Answer {
    std::size_t of;  // of a grid: index in title.plans; of a sweep: the row, among all
    Journal::Record record;
  };
  std::vector<Answer> answers;
};

// The file's first line; behind it come the answers, each framed.
std::string part_head(const PartTitle& title, std::size_t answers);

// Each case's id and the hash of all that its results depend on.
std::vector<std::pair<std::string, std::string>> plans_of(const Results& grid, const EngineTable& engines,
                                                          const GridOptions& options);

// The file's text. `planned`: the shard's share before it ran; its journals are there still.
std::string part_text(const PartTitle& title, const Results& planned, const Results& share, const EngineTable& engines,
                      const GridOptions& options);

// Throws InputError for a folder that holds no part, or one that is damaged or cut short.
Part read_part(const std::string& folder);

// Throws InputError, naming the difference, unless the parts belong to one grid and to different shards of it.
void check_same_grid(const std::vector<Part>& parts);

// Sentences about missing shards.
std::vector<std::string> missing_shards(const std::vector<Part>& parts);

// The result of merging, beside the grid that it filled in.
struct Merged {
  std::vector<std::string> missing;                 // sentences: shards, cells; these cells are `crashed`
  std::vector<std::string> remarks;                 // sentences
  std::map<std::string, std::string> trajectories;  // file name -> the folder of the part that has it
};

// Fills in a planned grid. Throws InputError for an invalid answer.
Merged fill_in(Results& grid, const std::vector<Part>& parts);

}  // namespace rigor::inline runner
