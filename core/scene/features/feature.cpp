#include "core/scene/features/feature.h"

#include <fmt/format.h>

#include <cassert>

namespace rigor::inline scene {
namespace {

const FeatureWord kPlainWords[] = {
    {Feature::armature, "armature"},
    {Feature::contact_filter, "contact-filter"},
    {Feature::coupling, "coupling"},
    {Feature::coupling_of_several_joints, "coupling:several-joints"},
    {Feature::fixed_body, "fixed-body"},
    {Feature::friction_coulomb, "friction:coulomb"},
    {Feature::friction_infinite, "friction:infinite"},
    {Feature::friction_none, "friction:none"},
    {Feature::hunt_crossley, "hunt-crossley"},
    {Feature::joint_damper, "joint-damper"},
    {Feature::joint_friction, "joint-friction"},
    {Feature::joint_limit, "joint-limit"},
    {Feature::joint_limit_beyond_half_turn, "joint-limit:beyond-half-turn"},
    {Feature::joint_limit_of_compound_slider, "joint-limit:compound-slider"},
    {Feature::joint_limit_that_bounces, "joint-limit-that-bounces"},
    {Feature::joint_loop, "joint-loop"},
    {Feature::joint_spring, "joint-spring"},
    {Feature::joints_with_contacts, "joints-with-contacts"},
    {Feature::joints_with_dampers, "joints-with-dampers"},
    {Feature::motor_effort, "motor:effort"},
    {Feature::motor_servo, "motor:servo"},
    {Feature::motor_servo_of_several_joints, "motor:servo-of-several-joints"},
    {Feature::motor_speed, "motor:speed"},
    {Feature::motor_table, "motor:table"},
    {Feature::placed_shapes, "placed-shapes"},
    {Feature::quadratic_spring, "quadratic-spring"},
    {Feature::restitution, "restitution"},
    {Feature::rolling_friction, "rolling-friction"},
    {Feature::soft_contact, "soft-contact"},
    {Feature::speed_motor_with_limits, "speed-motor-with-limits"},
    {Feature::spring, "spring"},
    {Feature::static_friction, "static-friction"},
    {Feature::timed_force, "timed-force"},
    {Feature::torsional_friction, "torsional-friction"},
    {Feature::two_speeds_at_once, "two-speeds-at-once"},
    {Feature::wrench, "wrench"},
};
static_assert(std::size(kPlainWords) == static_cast<std::size_t>(Feature::first_joint), "each feature has its word");

constexpr int kShapes = static_cast<int>(std::variant_size_v<Shape>);

// Calls visitor(a, b) for each pair of indices in Shape that can meet; of a compound, its parts do.
template <typename Visitor>
void for_each_pair(const Visitor& visitor) {
  constexpr const Shape* shapes = nullptr;
  constexpr int compound = index_among<Compound>(shapes);
  for (int b = 0; b < kShapes; ++b) {
    for (int a = 0; a <= b; ++a)
      if (a != compound && b != compound && can_meet(a, b)) visitor(a, b);
  }
}

std::vector<FeatureWord> all_words() {
  std::vector<FeatureWord> rows(std::begin(kPlainWords), std::end(kPlainWords));
  for (const JointTypeInfo& type : joint_types())
    if (type.is_whole) rows.push_back({joint_feature(type.prototype), "joint:" + type.word});
  for_each_pair([&](int a, int b) {
    const auto& table = shape_types();
    const auto [first, second] =
        std::minmax(table[static_cast<std::size_t>(a)].word, table[static_cast<std::size_t>(b)].word);
    rows.push_back({contact_feature(a, b), fmt::format("contact:{}-{}", first, second)});
  });
  return rows;
}

}  // namespace

const std::vector<FeatureWord>& feature_words() {
  static const std::vector<FeatureWord> rows = all_words();
  return rows;
}

const std::string& word_of(Feature feature) {
  const auto& rows = feature_words();
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const FeatureWord& r) { return r.feature == feature; });
  assert(row != rows.end() && "each feature has its word");
  return row->word;
}

std::optional<Feature> feature_of(std::string_view word) {
  const auto& rows = feature_words();
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const FeatureWord& r) { return r.word == word; });
  return row == rows.end() ? std::nullopt : std::optional(row->feature);
}

Features contacts_of_all_shapes() {
  Features contacts;
  for_each_pair([&](int a, int b) { contacts.insert(contact_feature(a, b)); });
  return contacts;
}

Features joints_of_all_types() {
  Features joints;
  for (const JointTypeInfo& type : joint_types())
    if (type.is_whole) joints.insert(joint_feature(type.prototype));
  return joints;
}

Features joined(Features a, const Features& b) {
  a.insert(b.begin(), b.end());
  return a;
}

}  // namespace rigor::inline scene
