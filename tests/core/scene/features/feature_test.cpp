#include "core/scene/features/feature.h"

#include <boost/test/unit_test.hpp>

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_scene_features_feature)

// The words are a contract with plug-ins and with files: each names one feature and is found again.
BOOST_AUTO_TEST_CASE(each_feature_has_one_word) {
  std::set<std::string> words;
  Features features;
  for (const FeatureWord& row : feature_words()) {
    words.insert(row.word), features.insert(row.feature);
    BOOST_TEST((feature_of(row.word) == row.feature), row.word);
    BOOST_TEST(word_of(row.feature) == row.word);
  }
  BOOST_TEST(words.size() == feature_words().size());
  BOOST_TEST(features.size() == feature_words().size());
  for (int k = 0; k < static_cast<int>(Feature::first_joint); ++k) BOOST_TEST(features.contains(Feature(k)), k);
  BOOST_TEST(words.contains("joint-limit:beyond-half-turn"));
  BOOST_TEST(!feature_of("contact:plane-plane").has_value());
}

BOOST_AUTO_TEST_CASE(a_pair_of_shapes_has_one_feature_in_either_order) {
  const Shape box = Box{{1, 1, 1}}, plane = Plane{{0, 0, 1}, 0};
  BOOST_TEST(word_of(contact_feature(plane, box)) == "contact:box-plane");
  BOOST_TEST((contact_feature(box, plane) == contact_feature<Plane, Box>()));
  BOOST_TEST((contact_feature<Box, Box>() != contact_feature<Box, Plane>()));
  BOOST_TEST((joint_feature(JointType(HingeJoint{Vec3::Zero(), Vec3::UnitZ()})) == joint_feature<HingeJoint>()));
  BOOST_TEST(word_of(joint_feature<HingeJoint>()) == "joint:hinge");
}

BOOST_AUTO_TEST_CASE(contacts_and_joints_are_told_apart) {
  for (const FeatureWord& row : feature_words()) {
    BOOST_TEST(is_contact(row.feature) == row.word.starts_with("contact:"), row.word);
    BOOST_TEST(is_joint(row.feature) == row.word.starts_with("joint:"), row.word);
  }
}

BOOST_AUTO_TEST_SUITE_END()
