#include "core/dynamics/kernels/kernels.h"

#include "core/dynamics/kernels/ball_kernels.h"
#include "core/dynamics/kernels/contact_kernels.h"

namespace rigor::inline dynamics {

namespace plain {
extern const Kernels kTable;
extern const BallKernels kBallTable;
extern const ContactKernels kContactTable;
}  // namespace plain
#ifdef __x86_64__
namespace avx2 {
extern const Kernels kTable;
extern const BallKernels kBallTable;
extern const ContactKernels kContactTable;
}  // namespace avx2
namespace avx512 {
extern const Kernels kTable;
extern const BallKernels kBallTable;
extern const ContactKernels kContactTable;
}  // namespace avx512
#endif

namespace {

const Kernels*& in_use() {
  static const Kernels* table = [] {
    const Kernels* all[kMostKernelTables];
    return all[available_kernels(all) - 1];
  }();
  return table;
}

}  // namespace

const Kernels& kernels() { return *in_use(); }

const BallKernels& ball_kernels() {
#ifdef __x86_64__
  if (in_use() == &avx2::kTable) return avx2::kBallTable;
  if (in_use() == &avx512::kTable) return avx512::kBallTable;
#endif
  return plain::kBallTable;
}

const ContactKernels& contact_kernels() {
#ifdef __x86_64__
  if (in_use() == &avx2::kTable) return avx2::kContactTable;
  if (in_use() == &avx512::kTable) return avx512::kContactTable;
#endif
  return plain::kContactTable;
}

std::size_t available_kernels(const Kernels* (&out)[kMostKernelTables]) {
  std::size_t count = 0;
  out[count++] = &plain::kTable;
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2")) out[count++] = &avx2::kTable;
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    out[count++] = &avx512::kTable;
#endif
  return count;
}

KernelsInPlace::KernelsInPlace(const Kernels& table) : before_(in_use()) { in_use() = &table; }
KernelsInPlace::~KernelsInPlace() { in_use() = before_; }

}  // namespace rigor::inline dynamics
