#include "core/dynamics/contact.h"

#include <algorithm>
#include <cassert>

namespace rigor {

const std::vector<ContactMethod>& contact_methods() {
  static const std::vector<ContactMethod> table = {kCourseContact};
  return table;
}

const ContactMethod& contact_method(const std::string& name) {
  const auto& table = contact_methods();
  const auto row = std::find_if(table.begin(), table.end(), [&](const auto& r) { return r.name == name; });
  assert(row != table.end() && "option values are checked when the run is named");
  return *row;
}

}  // namespace rigor
