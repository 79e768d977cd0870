#include "cases/runner/build_identity.h"

#include <fmt/format.h>
#include <link.h>

#include <vector>

#include "core/base/content_hash.h"

namespace rigor::inline runner {
namespace {

// In the list of loaded objects the program has no name, and the kernel's object has no file.
int add_file(dl_phdr_info* about, std::size_t, void* files) {
  const std::string name = about->dlpi_name;
  static_cast<std::vector<std::string>*>(files)->push_back(name.empty() ? "/proc/self/exe" : name);
  return 0;
}

}  // namespace

const std::string& build_identity() {
  static const std::string identity = [] {
    std::vector<std::string> files;
    dl_iterate_phdr(add_file, &files);
    std::uint64_t hash = kHashOfNothing;
    for (const std::string& file : files) hash = hash_of_file(file, content_hash(file, hash));
    return fmt::format("{:016x}", hash);
  }();
  return identity;
}

}  // namespace rigor::inline runner
