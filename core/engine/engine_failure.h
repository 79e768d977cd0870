// What an engine that lives outside throws when it cannot go on, in the words of a cell's status: it says that it does
// not support the scene, or that its state is no longer finite; it died or says that it failed; it did not answer in
// time; what it said is no answer. The text is a whole sentence.
#pragma once

#include <stdexcept>
#include <string>

namespace rigor {

enum class FailureKind { unsupported, diverged, crashed, timed_out, invalid };

class EngineFailure : public std::runtime_error {
 public:
  EngineFailure(FailureKind kind, const std::string& sentence) : std::runtime_error(sentence), kind_(kind) {}
  FailureKind kind() const { return kind_; }

 private:
  FailureKind kind_;
};

}  // namespace rigor
