#include "cases/import/sdf/sdf_coordinate.h"

#include <fmt/format.h>

#include <cmath>

#include "cases/import/model_elements.h"

namespace rigor {
namespace {

constexpr double kUnlimited = 1e16;  // of a joint's limits, as the format has it

}  // namespace

void leave_out_sdf_coordinate(const XmlElement& axis, LeftOut& left_out) {
  for (const char* word : {"limit", "dynamics"}) {
    if (axis.child(word))
      left_out.add(axis.place(), fmt::format("<{}>", word),
                   "a scene's joint of two axes has no limits, springs or dampers");
  }
}

void read_sdf_coordinate(const XmlElement& axis, const std::string& type, Joint& joint, LeftOut& left_out) {
  if (const auto limit = axis.child("limit")) {
    limit->check({{},
                  {"lower", "upper"},
                  {{"effort", kBoundsADrive},
                   {"velocity", kBoundsADrive},
                   {"stiffness", "makes a limit soft; a scene's limits are hard"},
                   {"dissipation", "makes a limit soft; a scene's limits are hard"}}},
                 left_out);
    const auto bound = [&](const char* word, double otherwise) {
      const auto found = limit->child(word);
      if (!found) return otherwise;
      for (const char* infinite : {"inf", "-inf", "+inf", "infinity", "-infinity"}) {
        if (found->text() == infinite) return otherwise;
      }
      const double value = found->number_of_text();
      return std::abs(value) >= kUnlimited ? otherwise : value;
    };
    if (type != "continuous") joint.lower = bound("lower", joint.lower), joint.upper = bound("upper", joint.upper);
    if (!(joint.lower < joint.upper))
      limit->refuse(fmt::format("lower is {} and upper {}; allowed: limits of which the upper is greater", joint.lower,
                                joint.upper));
  }
  const auto dynamics = axis.child("dynamics");
  if (!dynamics) return;
  dynamics->check({{}, {"damping", "friction", "spring_reference", "spring_stiffness"}}, left_out);
  const auto value = [&](const char* word) {
    const auto found = dynamics->child(word);
    return found ? found->number_of_text() : 0;
  };
  joint.damping = not_negative(value("damping"), "damping", *dynamics);
  joint.stiffness = not_negative(value("spring_stiffness"), "spring_stiffness", *dynamics);
  joint.rest = value("spring_reference");
  if (value("friction") != 0) left_out.add(dynamics->place(), "<friction>", kDryFriction);
}

}  // namespace rigor
