// The runs of a grid in sentences. External engines are named; Rigor's own methods are counted where they are many.
#pragma once

#include <string>
#include <vector>

#include "cases/report/wording/message.h"
#include "cases/results/results.h"

namespace rigor::inline report {

class RunNames {
 public:
  static constexpr std::size_t kFewOfOurs = 3;  // own methods that a sentence may name

  explicit RunNames(const Results& results) : results_(results) {}

  const std::string& of(std::size_t run) const { return results_.runs[run].text; }
  bool is_ours(std::size_t run) const { return is_in_house(results_, run); }
  // Whether at least half of the cases have cells of it.
  bool is_common(std::size_t run) const;
  std::vector<std::size_t> order() const;  // of all runs: external engines first
  std::size_t ours_among(const std::vector<std::size_t>& runs) const;

  std::string all(const std::vector<std::size_t>& runs) const;
  // In few words: "ode, bullet, 4 of 9 core methods". The two counts are stated as the claims "core methods: WHAT" and
  // "core methods in all: WHAT".
  std::string brief(const std::vector<std::size_t>& runs, std::size_t all_ours, const std::string& what,
                    Claims& claims) const;

 private:
  const Results& results_;
};

}  // namespace rigor::inline report
