// The memory limit of an engine from outside. Larger requests fail, so the engine costs its cell and does not affect
// other programs.
#pragma once

#include <sys/resource.h>

#include <algorithm>

#include "core/base/sanitizers.h"

namespace rigor::inline adapters {

// Bytes of data: RLIMIT_DATA, for address space alone is reserved by the gigabyte in WebAssembly.
inline constexpr rlim_t kMostMemory = rlim_t{4} << 30;

// Applies to this process permanently. May be called between fork and exec: only system calls. A build with a
// sanitizer sets no limit: the sanitizer's own maps count, too, and are terabytes.
inline void limit_memory() {
  if (kHasAddressSanitizer || kHasThreadSanitizer) return;
  rlimit now{};
  getrlimit(RLIMIT_DATA, &now);
  const rlimit limit{std::min(kMostMemory, now.rlim_max), std::min(kMostMemory, now.rlim_max)};
  if (now.rlim_cur > limit.rlim_cur) setrlimit(RLIMIT_DATA, &limit);
}

}  // namespace rigor::inline adapters
