#include "adapters/common/compiled_mjcf.h"

#include <fmt/format.h>

#include <algorithm>

namespace rigor::inline adapters {

std::string MjcfSource::place_of(const std::string& what, const std::string& name, int index) const {
  const auto found = places.find(what + "/" + name);
  if (name.empty()) return fmt::format("{}: {} {}", path, what, index);
  return fmt::format("{}: {} '{}'", found == places.end() ? path : found->second, what, name);
}

double CompiledMjcf::at(const std::string& name, std::size_t index) const {
  const auto found = numbers.find(name);
  return found == numbers.end() || index >= found->second.size() ? 0 : found->second[index];
}

std::size_t CompiledMjcf::size(const std::string& name) const {
  const auto found = numbers.find(name);
  return found == numbers.end() ? 0 : found->second.size();
}

std::string CompiledMjcf::name_of(const std::string& kind, std::size_t index) const {
  const auto found = names.find(kind);
  return found == names.end() || index >= found->second.size() ? "" : found->second[index];
}

void CompiledMjcf::take_switches() {
  const auto clear = [&](const char* flag, const std::vector<const char*>& arrays) {
    if (!off.contains(flag) && !off.contains("constraint")) return;
    for (const char* name : arrays) std::fill(numbers[name].begin(), numbers[name].end(), 0);
  };
  const auto clear_alone = [&](const char* flag, const std::vector<const char*>& arrays) {
    if (!off.contains(flag)) return;
    for (const char* name : arrays) std::fill(numbers[name].begin(), numbers[name].end(), 0);
  };
  clear_alone("gravity", {"opt_gravity", "body_gravcomp"});
  clear("contact", {"geom_contype", "geom_conaffinity", "npair"});
  clear("limit", {"jnt_limited", "tendon_limited"});
  clear("equality", {"eq_active"});
  clear("frictionloss", {"dof_frictionloss", "tendon_frictionloss"});
  clear_alone("spring", {"jnt_stiffness", "jnt_stiffnesspoly", "tendon_stiffness", "tendon_stiffnesspoly"});
  clear_alone("damper", {"dof_damping", "dof_dampingpoly", "tendon_damping", "tendon_dampingpoly"});
  clear_alone("actuation", {"actuator_gainprm", "actuator_biasprm", "actuator_biastype"});
  clear_alone("clampctrl", {"actuator_ctrllimited"});
  for (const char* flag : {"gravity", "contact", "limit", "equality", "frictionloss", "spring", "damper", "actuation",
                           "clampctrl", "constraint"})
    off.erase(flag);
}

}  // namespace rigor::inline adapters
