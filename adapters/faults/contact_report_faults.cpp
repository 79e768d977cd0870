// Wrong reports of the contact forces of a correct step, as they are seen in bindings and recorders.
#include "adapters/faults/faults.h"

namespace rigor::inline adapters {
namespace {

template <typename F>
Fault on_each(const std::string& name, F change) {
  Fault fault{name};
  fault.contacts = [=](std::vector<ReportedContact>& contacts) {
    for (ReportedContact& contact : contacts) change(contact);
  };
  return fault;
}

}  // namespace

const std::vector<Fault>& contact_report_faults() {
  static const std::vector<Fault> table = [] {
    std::vector<Fault> faults = {
        on_each("contact force on a in place of b", [](ReportedContact& c) { c.force *= -1; }),
        on_each("contact force in the contact's frame",
                [](ReportedContact& c) {
                  const Vec3 t = c.normal.unitOrthogonal();
                  c.force = Vec3(c.normal.dot(c.force), t.dot(c.force), c.normal.cross(t).dot(c.force));
                }),
        on_each("contact force of a sub-step, not of the step", [](ReportedContact& c) { c.force *= 0.25; }),
        on_each("contact force without friction",
                [](ReportedContact& c) { c.force = c.force.dot(c.normal) * c.normal; }),
        on_each("contact gap with the wrong sign", [](ReportedContact& c) { c.gap *= -1; }),
        on_each("contact normal from b to a", [](ReportedContact& c) { c.normal *= -1; }),
        on_each("contact normal not unit", [](ReportedContact& c) { c.normal *= 2; }),
    };
    Fault twice{"each contact reported twice"};
    twice.contacts = [](std::vector<ReportedContact>& contacts) {
      const std::vector<ReportedContact> once = contacts;
      contacts.insert(contacts.end(), once.begin(), once.end());
    };
    faults.push_back(twice);
    return faults;
  }();
  return table;
}

}  // namespace rigor::inline adapters
