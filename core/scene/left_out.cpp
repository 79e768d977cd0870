#include "core/scene/left_out.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "core/base/error.h"

namespace rigor::inline scene {

std::string word_of(LossKind kind) {
  return kind == LossKind::visual ? "visual" : kind == LossKind::assumed ? "assumed" : "physical";
}

void LeftOut::add(const std::string& where, const std::string& what, const Reason& reason) {
  const auto [found, is_new] = index_.try_emplace({what, reason.text}, losses_.size());
  if (is_new) {
    if (losses_.size() == kMostKinds)
      throw InputError(
          fmt::format("{}: {}: there are over {} kinds of things here that no scene can say", where, what, kMostKinds));
    losses_.push_back({reason.kind, what, reason.text, {}, 0});
  }
  Loss& loss = losses_[found->second];
  if (++loss.count <= kPlaces) loss.places.push_back(where);
}

std::vector<std::string> LeftOut::sentences() const {
  std::vector<std::string> all;
  for (const Loss& loss : losses_) {
    for (const std::string& place : loss.places) all.push_back(fmt::format("{}: {}: {}", place, loss.what, loss.why));
    if (loss.count > loss.places.size())
      all.push_back(fmt::format("and {} more: {}: {}", loss.count - loss.places.size(), loss.what, loss.why));
  }
  return all;
}

std::vector<Loss> losses_of(const std::vector<Loss>& losses, LossKind kind) {
  std::vector<Loss> of_kind;
  std::copy_if(losses.begin(), losses.end(), std::back_inserter(of_kind),
               [&](const Loss& loss) { return loss.kind == kind; });
  return of_kind;
}

std::string sentence_of(const Loss& loss) {
  const std::string times = loss.count == 1 ? "" : fmt::format("{} times, first at ", loss.count);
  return fmt::format("{}: {} ({}{})", loss.what, loss.why, times, loss.places.front());
}

std::string not_the_same_robot(const std::vector<Loss>& losses) {
  std::map<std::string, std::size_t> counts;
  std::vector<std::string> order;
  for (const Loss& loss : losses_of(losses, LossKind::physical)) {
    if (counts[loss.what] == 0) order.push_back(loss.what);
    counts[loss.what] += loss.count;
  }
  std::string text;
  for (const std::string& what : order) {
    text += text.empty() ? "not the same robot: lost " : ", ";
    text += counts[what] == 1 ? what : fmt::format("{} ({} times)", what, counts[what]);
  }
  return text;
}

}  // namespace rigor::inline scene
