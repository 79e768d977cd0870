#include "core/scene/link_model.h"

#include <fmt/format.h>

#include "core/base/error.h"

namespace rigor {

void LeftOut::add(const std::string& where, const std::string& what, const std::string& why) {
  const auto [found, is_new] = index_.try_emplace({what, why}, kinds_.size());
  if (is_new) {
    if (kinds_.size() == kMostKinds)
      throw InputError(
          fmt::format("{}: {}: there are over {} kinds of things here that no scene can say", where, what, kMostKinds));
    kinds_.push_back({what, why, {}});
  }
  Kind& kind = kinds_[found->second];
  if (++kind.count <= kPlaces) kind.places.push_back(where);
}

std::vector<std::string> LeftOut::sentences() const {
  std::vector<std::string> all;
  for (const Kind& kind : kinds_) {
    for (const std::string& place : kind.places) all.push_back(fmt::format("{}: {}: {}", place, kind.what, kind.why));
    if (kind.count > kind.places.size())
      all.push_back(fmt::format("and {} more: {}: {}", kind.count - kind.places.size(), kind.what, kind.why));
  }
  return all;
}

std::vector<std::string> LeftOut::losses() const {
  std::vector<std::string> all;
  for (const Kind& kind : kinds_) {
    if (kind.why.starts_with(kNoMotion)) continue;
    const std::string times = kind.count == 1 ? "" : fmt::format("{} times, first at ", kind.count);
    all.push_back(fmt::format("{}: {} ({}{})", kind.what, kind.why, times, kind.places.front()));
  }
  return all;
}

}  // namespace rigor
