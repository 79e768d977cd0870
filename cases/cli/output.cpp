#include "cases/cli/output.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>

namespace rigor {

void print(const std::string& text) {
  errno = 0;
  const bool is_written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (is_written) return;
  if (errno == EPIPE) throw ReaderGone();
  throw std::runtime_error(std::string("stdout cannot be written: ") + std::strerror(errno));
}

}  // namespace rigor
