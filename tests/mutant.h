// The code that tests/mutants puts behind each mutant: the mutant whose number is in RIGOR_MUTANT is on, all others are
// off. RIGOR_MUTANT_REACH names a file with one byte per mutant, in which reached mutants are marked.
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <type_traits>
#include <utility>

// A mutant may well look odd.
#pragma GCC diagnostic ignored "-Wcomment"
#pragma GCC diagnostic ignored "-Wdangling-else"
#pragma GCC diagnostic ignored "-Wempty-body"
#pragma GCC diagnostic ignored "-Wfloat-equal"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wmisleading-indentation"
#pragma GCC diagnostic ignored "-Wparentheses"
#pragma GCC diagnostic ignored "-Wreturn-type"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wsign-compare"
#pragma GCC diagnostic ignored "-Wtype-limits"
#pragma GCC diagnostic ignored "-Wunused-but-set-variable"
#pragma GCC diagnostic ignored "-Wunused-value"
#pragma GCC diagnostic ignored "-Wunused-variable"

namespace mutant {

struct Asked {
  int on = -1;
  unsigned char* reached = nullptr;
  Asked() {
    if (const char* number = std::getenv("RIGOR_MUTANT")) on = std::atoi(number);
    const char* file = std::getenv("RIGOR_MUTANT_REACH");
    const int descriptor = file ? open(file, O_RDWR | O_CLOEXEC) : -1;
    struct stat size;
    if (descriptor < 0 || fstat(descriptor, &size) != 0) return;
    void* shared =
        mmap(nullptr, static_cast<std::size_t>(size.st_size), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
    close(descriptor);
    if (shared != MAP_FAILED) reached = static_cast<unsigned char*>(shared);
  }
};
inline const Asked asked;

inline bool is_on(int number) {
  if (asked.reached) asked.reached[number] = 1;
  return number == asked.on;
}

// Eigen's sums become what they are the sum of; others stay what they are.
template <typename T>
auto plain(const T& value) {
  if constexpr (requires { value.eval(); }) {
    return value.eval();
  } else {
    return value;
  }
}

#define RIGOR_MUTANT_OPERATOR(name, sign, other)               \
  template <typename A, typename B>                            \
  auto name(int number, const A& a, const B& b) {              \
    return is_on(number) ? plain(a other b) : plain(a sign b); \
  }
RIGOR_MUTANT_OPERATOR(less, <, <=)
RIGOR_MUTANT_OPERATOR(at_most, <=, <)
RIGOR_MUTANT_OPERATOR(more, >, >=)
RIGOR_MUTANT_OPERATOR(at_least, >=, >)
RIGOR_MUTANT_OPERATOR(same, ==, !=)
RIGOR_MUTANT_OPERATOR(other, !=, ==)
RIGOR_MUTANT_OPERATOR(plus, +, -)
RIGOR_MUTANT_OPERATOR(minus, -, +)
RIGOR_MUTANT_OPERATOR(times, *, /)
RIGOR_MUTANT_OPERATOR(over, /, *)
#undef RIGOR_MUTANT_OPERATOR

template <typename A, typename B>
decltype(auto) add(int number, A&& a, const B& b) {
  is_on(number) ? void(a -= b) : void(a += b);
  return std::forward<A>(a);
}
template <typename A, typename B>
decltype(auto) take(int number, A&& a, const B& b) {
  is_on(number) ? void(a += b) : void(a -= b);
  return std::forward<A>(a);
}

template <typename T>
bool negated(int number, const T& value) {
  return is_on(number) ? static_cast<bool>(value) : !value;
}
template <typename Rest>
bool both(int number, bool first, const Rest& rest) {
  return is_on(number) ? first || rest() : first && rest();
}
template <typename Rest>
bool either(int number, bool first, const Rest& rest) {
  return is_on(number) ? first && rest() : first || rest();
}
template <typename T, typename Other>
T value(int number, T as_is, Other other) {
  return is_on(number) ? static_cast<T>(other) : as_is;
}
template <typename T>
T max(int number, const T& a, const T& b) {
  return is_on(number) ? std::min<T>(a, b) : std::max<T>(a, b);
}
template <typename T>
T min(int number, const T& a, const T& b) {
  return is_on(number) ? std::max<T>(a, b) : std::min<T>(a, b);
}
template <typename... All>
bool any_of(int number, All&&... all) {
  return is_on(number) ? std::all_of(std::forward<All>(all)...) : std::any_of(std::forward<All>(all)...);
}
template <typename... All>
bool all_of(int number, All&&... all) {
  return is_on(number) ? std::any_of(std::forward<All>(all)...) : std::all_of(std::forward<All>(all)...);
}

}  // namespace mutant
