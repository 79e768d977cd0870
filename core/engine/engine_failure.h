// Exceptions of an engine outside this process that cannot continue, named after the status of a cell. It may reject
// the scene, report a non-finite state, die or fail, miss its time limit, or give an invalid answer. The text is a
// whole sentence.
#pragma once

#include <stdexcept>
#include <string>

namespace rigor::inline engine {

enum class FailureKind { unsupported, diverged, crashed, timed_out, invalid };

class EngineFailure : public std::runtime_error {
 public:
  EngineFailure(FailureKind kind, const std::string& sentence) : std::runtime_error(sentence), kind_(kind) {}
  FailureKind kind() const { return kind_; }

 private:
  FailureKind kind_;
};

}  // namespace rigor::inline engine
