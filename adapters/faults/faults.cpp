#include "adapters/faults/faults.h"

#include <utility>

namespace rigor::inline adapters {
namespace {

template <typename F, typename... Arguments>
std::function<void(Arguments...)> one_after_the_other(const F& first, const F& second) {
  if (!first || !second) return first ? first : second;
  return [=](Arguments... arguments) { first(arguments...), second(arguments...); };
}

}  // namespace

const std::vector<Fault>& faults() {
  static const std::vector<Fault> table = [] {
    std::vector<Fault> all;
    for (auto& part : {body_faults(), load_faults(), joint_faults(), step_faults(), contact_faults(), reading_faults()})
      all.insert(all.end(), part.begin(), part.end());
    return all;
  }();
  return table;
}

Fault combined(const Fault& first, const Fault& second) {
  using OnScene = std::function<void(Scene&)>;
  using OnStep = std::function<void(Moment&)>;
  using OnRead = std::function<void(MutableBodyColumns, const Scene&)>;
  Fault both;
  both.name = first.name + ", and " + second.name;
  both.scene = one_after_the_other<OnScene, Scene&>(first.scene, second.scene);
  both.step = one_after_the_other<OnStep, Moment&>(first.step, second.step);
  both.read = one_after_the_other<OnRead, MutableBodyColumns, const Scene&>(first.read, second.read);
  using OnContacts = std::function<void(std::vector<ReportedContact>&)>;
  both.contacts = one_after_the_other<OnContacts, std::vector<ReportedContact>&>(first.contacts, second.contacts);
  both.reads_late = first.reads_late || second.reads_late;
  return both;
}

}  // namespace rigor::inline adapters
