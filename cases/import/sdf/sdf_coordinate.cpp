#include "cases/import/sdf/sdf_coordinate.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "cases/import/model_elements.h"

namespace rigor::inline imports {
namespace {

constexpr double kUnlimited = 1e16;  // of a joint's limits, as the format has it
constexpr double kInfinite = std::numeric_limits<double>::infinity();

}  // namespace

void read_sdf_coordinate(const XmlElement& axis, const std::string& type, LinkJoint& row, LeftOut& left_out) {
  Joint& joint = row.joint;
  if (const auto limit = axis.child("limit")) {
    limit->check({{},
                  {"lower", "upper"},
                  {{"effort", kBoundsADrive},
                   {"velocity", kBoundsADrive},
                   {"stiffness", assumed("makes a limit soft; a scene's limits are hard")},
                   {"dissipation", assumed("makes a limit soft; a scene's limits are hard")}}},
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
    if (joint.lower == joint.upper && joint.lower == 0) {  // between equal limits nothing moves
      joint.type = FixedJoint{}, joint.lower = -kInfinite, joint.upper = kInfinite;
      return left_out.add(axis.place(), "equal limits", no_motion("hold the joint: it becomes a fixed one"));
    }
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
  row.friction = not_negative(value("friction"), "friction", *dynamics);
}

}  // namespace rigor::inline imports
