/* The header that a shared library's engine is written to; share/rigor/examples/toy.c is a whole one. */
#include <rigor_engine.h>

const rigor_engine_v1* rigor_engine_entry(uint32_t abi_major) {
  (void)abi_major;
  return 0; /* this one knows no version */
}
