#include "adapters/mujoco/mujoco_library.h"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"

namespace rigor::mujoco_library {
namespace {

thread_local std::string warnings;

void keep_warning(const char* text) {
  if (!warnings.empty()) warnings += "; ";
  warnings += text;
}

[[noreturn]] void throw_error(const char* text) { throw std::runtime_error(fmt::format("MuJoCo: {}", text)); }

// MuJoCo's file system in memory, some 2 MB.
class Files {
 public:
  Files() : vfs_(std::make_unique<mjVFS>()) { mj_defaultVFS(vfs_.get()); }
  ~Files() { mj_deleteVFS(vfs_.get()); }
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;

  void add(const char* name, const std::string& text) {
    if (mj_makeEmptyFileVFS(vfs_.get(), name, static_cast<int>(text.size())) != 0)
      throw std::runtime_error("MuJoCo takes no file of this size");
    std::memcpy(vfs_->filedata[mj_findFileVFS(vfs_.get(), name)], text.data(), text.size());
  }
  const mjVFS* get() const { return vfs_.get(); }

 private:
  std::unique_ptr<mjVFS> vfs_;
};

}  // namespace

void start() {
  static std::once_flag once;
  std::call_once(once, [] { mju_user_warning = keep_warning, mju_user_error = throw_error; });
}

std::string take_warnings() { return std::exchange(warnings, ""); }

Model compile(const std::string& mjcf) {
  constexpr const char* kName = "scene.xml";
  Files files;
  files.add(kName, mjcf);
  std::array<char, 1000> error{};
  Model model(mj_loadXML(kName, files.get(), error.data(), static_cast<int>(error.size())));
  if (!model) throw InputError(fmt::format("MuJoCo refuses the scene: {}", error.data()));
  return model;
}

}  // namespace rigor::mujoco_library
