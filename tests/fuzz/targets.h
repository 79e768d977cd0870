// What is fuzzed: each target takes any bytes as one of the things that Rigor reads from elsewhere. It returns if they
// are read or refused as they should be; anything else (another exception, a crash, an endless loop) is a finding.
#pragma once

#include <string>
#include <vector>

namespace rigor::fuzz {

struct Target {
  std::string name;  // also of its corpus, tests/fuzz/corpus/NAME/
  void (*read)(const std::string& bytes);
};

const std::vector<Target>& targets();  // alphabetical

}  // namespace rigor::fuzz
