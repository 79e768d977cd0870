// history.html: how errors and costs moved from commit to commit, drawn. One file that needs nothing else, no script
// either.
#pragma once

#include <string>
#include <vector>

#include "cases/results/history.h"

namespace rigor {

// Of the cells whose names have one of `words` in them, or of all: first those that changed.
std::string history_page(const std::vector<HistoryEntry>& history, const std::vector<std::string>& words);

}  // namespace rigor
