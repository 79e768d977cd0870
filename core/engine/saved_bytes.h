// Saved states of the core and of adapters: bytes that name what they belong to, with a checksum. A state of another
// engine, version, method or scene is refused before anything changes.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "core/engine/capabilities.h"
#include "core/engine/engine.h"
#include "core/engine/state_archive.h"

namespace rigor::inline engine {

class SavedBytes : public SavedState {
 public:
  explicit SavedBytes(std::string bytes) : bytes_(std::move(bytes)) {}
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

// What a state belongs to.
class StateOwner {
 public:
  StateOwner(std::string engine, std::string version, const Scene& scene, const Settings& settings);

  // Both call `visit` with an archive. restore() throws InputError for a state that is damaged or of another owner.
  template <typename Visit>
  std::unique_ptr<SavedState> save(const Visit& visit) const {
    StateArchive archive;
    visit(archive);
    return sealed(archive.bytes());
  }
  template <typename Visit>
  void restore(const SavedState& state, const Visit& visit) const {
    StateArchive archive(opened(state));
    visit(archive);
    archive.end();
  }

 private:
  std::unique_ptr<SavedState> sealed(const std::string& state) const;
  std::string_view opened(const SavedState& state) const;

  std::string engine_, version_, run_;
  std::uint64_t scene_;
};

// A world whose whole state goes through an archive.
class ArchivesState : public SavesState {
 public:
  ArchivesState(std::string engine, std::string version, const Scene& scene, const Settings& settings)
      : owner_(std::move(engine), std::move(version), scene, settings) {}

  std::unique_ptr<SavedState> save() const final;
  void restore(const SavedState& state) final;

 private:
  // All that the next steps depend on. An archive that saves changes nothing.
  virtual void archive_state(StateArchive& archive) = 0;

  StateOwner owner_;
};

// For tests of damaged content: the same bytes with a checksum that fits them.
std::string with_new_checksum(std::string bytes);

}  // namespace rigor::inline engine
