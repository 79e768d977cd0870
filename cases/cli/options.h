// The options of each command, declared to the parser of words.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "cases/cli/commands.h"
#include "cases/results/changes.h"

namespace rigor {

// Values as typed. Numbers are read later, so that messages are the same as for a case file.
struct Typed {
  std::vector<std::string> dt;
  std::string duration, jobs, shard, samples, seed, every = "1", limit = "120", times,
                                                    factor = fmt::format("{:g}", kDefaultFactor);
};

// The options of each command that takes robots' files.
std::vector<std::string> with_import_options(std::vector<std::string> options);

// Declares the words and options that the row takes; `line` and `typed` receive their values.
void add_options(CLI::App& command, const CommandRow& row, CommandLine& line, Typed& typed);

}  // namespace rigor
