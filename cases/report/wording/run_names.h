// The runs of a grid in sentences: the engines that a reader has come for by name, Rigor's own methods counted where
// they are many.
#pragma once

#include <string>
#include <vector>

#include "cases/results/results.h"

namespace rigor {

class RunNames {
 public:
  static constexpr std::size_t kFewOfOurs = 3;  // methods of ours that a sentence may name

  explicit RunNames(const Results& results) : results_(results) {}

  const std::string& of(std::size_t run) const { return results_.runs[run].text; }
  bool is_ours(std::size_t run) const { return is_in_house(results_, run); }
  // Whether it is more than a run that a case or two ask for.
  bool is_common(std::size_t run) const;
  std::vector<std::size_t> order() const;  // of all runs: engines that are not ours first
  std::size_t ours_among(const std::vector<std::size_t>& runs) const;

  std::string all(const std::vector<std::size_t>& runs) const;
  // In few words: our own methods, of which `all_ours` were asked, are counted where they are many.
  std::string brief(const std::vector<std::size_t>& runs, std::size_t all_ours) const;

 private:
  const Results& results_;
};

}  // namespace rigor
