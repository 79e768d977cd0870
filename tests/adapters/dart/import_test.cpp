// DART's own loaders of URDF and SDF against our imports of the same files.
#include <boost/test/unit_test.hpp>
#include <dart/simulation/World.hpp>
#include <dart/utils/sdf/SdfParser.hpp>
#include <dart/utils/urdf/DartLoader.hpp>

#include "generated/tests/places.h"
#include "tests/adapters/loaded_alike.h"
#include "tests/cases/import/imported.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(adapters_dart_import)

namespace {

const std::string kModels = RIGOR_SOURCE_DIR "/tests/cases/import/models/";

// DART's loader reads the file, without limits and contacts.
struct Own {
  dart::simulation::WorldPtr world;

  explicit Own(const std::string& path) {
    if (path.ends_with(".urdf")) {
      world = dart::simulation::World::create();
      // DART's default is a floating root, and 1 kg for a link without mass. Here, and in MuJoCo, the root is fixed and
      // the link has no mass.
      dart::utils::DartLoader::Options options;
      options.mDefaultRootJointType = dart::utils::DartLoader::RootJointType::FIXED;
      options.mDefaultInertia = dart::dynamics::Inertia(1e-14, Vec3::Zero(), 1e-14 * Mat3::Identity());
      world->addSkeleton(dart::utils::DartLoader(options).parseSkeleton(path));
    } else {
      world = dart::utils::SdfParser::readWorld(path);
    }
    BOOST_TEST_REQUIRE((world && world->getNumSkeletons() > 0 && world->getSkeleton(0)), path);
    world->setGravity({0, 0, -9.81});
    world->setTimeStep(kLoadedStep);
    for (std::size_t i = 0; i < world->getNumSkeletons(); ++i) {
      const auto skeleton = world->getSkeleton(i);
      for (const auto& joint : skeleton->getJoints()) joint->setLimitEnforcement(false);
      for (const auto& body : skeleton->getBodyNodes()) body->setCollidable(false);
    }
  }
  void step() { world->step(); }
  void place() const {}
  // SDF's links have their model before them here, and do not there.
  const dart::dynamics::BodyNode* body(const std::string& name) const {
    const std::size_t colons = name.rfind("::");
    const std::string link = colons == std::string::npos ? name : name.substr(colons + 2);
    for (std::size_t i = 0; i < world->getNumSkeletons(); ++i) {
      if (const auto* found = world->getSkeleton(i)->getBodyNode(link)) return found;
    }
    return nullptr;
  }
  bool has(const std::string& name) const { return body(name); }
  Vec3 centre(const std::string& name) const { return body(name)->getCOM(); }
  Quat turn(const std::string& name) const { return Quat(body(name)->getWorldTransform().linear()); }
};

}  // namespace

// Its reader of SDF does not turn an inertia by the pose of <inertial>, which its reader of URDF does.
BOOST_AUTO_TEST_CASE(its_own_loaders_and_our_imports_move_alike) {
  for (const char* file : {"arm.urdf", "double_pendulum.urdf", "double_pendulum_poses.sdf"}) {
    Own own(kModels + file);
    Scene scene = without_limits(scene_of_file(kModels + file));
    for (Body& body : scene.bodies) body.collides = false;  // links of one skeleton do not collide in DART's loaders
    check_alike(file, apart_after(own, "dart", scene, 1));
  }
}

BOOST_AUTO_TEST_SUITE_END()
