#include "cases/runner/results.h"

#include <algorithm>
#include <cassert>
#include <iterator>

namespace rigor {
namespace {
// In the order of the enumeration.
constexpr const char* kStatusWords[] = {"pass",     "fail",    "known-deviation", "unexpected-pass", "unsupported",
                                        "diverged", "crashed", "timed-out",       "invalid"};
constexpr const char* kAnswerWords[] = {"held", "failed", "not checked"};
}  // namespace

std::string word_of(Status status) { return kStatusWords[static_cast<int>(status)]; }

Status status_of(const std::string& word) {
  const auto found = std::find(std::begin(kStatusWords), std::end(kStatusWords), word);
  assert(found != std::end(kStatusWords));
  return static_cast<Status>(found - std::begin(kStatusWords));
}

std::string word_of(GateAnswer answer) { return kAnswerWords[static_cast<int>(answer)]; }

}  // namespace rigor
