// Limits the memory of work on untrusted files.
#pragma once

#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <new>
#include <string>

#include "core/base/error.h"
#include "core/base/sanitizers.h"

namespace rigor::inline imports {

// A sanitizer's own maps are terabytes.
inline constexpr bool kMemoryIsCounted = !kHasAddressSanitizer && !kHasThreadSanitizer;

// Limits the process to `most` bytes beyond its present use, until it is destroyed.
class MemoryLimit {
 public:
  explicit MemoryLimit(std::size_t most) {
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    if (!kMemoryIsCounted || pages == 0 || getrlimit(RLIMIT_AS, &before_) != 0) return;
    rlimit limit = before_;
    limit.rlim_cur = std::min<rlim_t>(pages * 4096 + most, before_.rlim_cur);
    is_set_ = setrlimit(RLIMIT_AS, &limit) == 0;
  }
  ~MemoryLimit() {
    if (is_set_) setrlimit(RLIMIT_AS, &before_);
  }
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;

 private:
  rlimit before_ = {};
  bool is_set_ = false;
};

template <typename Work>
auto within_memory(std::size_t most, const std::string& file, const Work& work) {
  const MemoryLimit limit(most);
  try {
    return work();
  } catch (const std::bad_alloc&) {
    throw InputError(file + ":1: takes more than a gigabyte of memory to read");
  }
}

}  // namespace rigor::inline imports
