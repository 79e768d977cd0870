// The memory that an engine from outside may have. What asks for more is refused it, by which an engine dies at the
// price of its cell, and not whatever else the machine does.
#pragma once

#include <sys/resource.h>

#include <algorithm>

namespace rigor {

// Bytes of data: RLIMIT_DATA, for address space alone is reserved by the gigabyte in WebAssembly.
inline constexpr rlim_t kMostMemory = rlim_t{4} << 30;

// Of this process, for good. Between fork and exec it may be called: system calls alone.
inline void limit_memory() {
  rlimit now{};
  getrlimit(RLIMIT_DATA, &now);
  const rlimit limit{std::min(kMostMemory, now.rlim_max), std::min(kMostMemory, now.rlim_max)};
  if (now.rlim_cur > limit.rlim_cur) setrlimit(RLIMIT_DATA, &limit);
}

}  // namespace rigor
