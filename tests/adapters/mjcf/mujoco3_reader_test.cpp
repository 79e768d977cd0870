// MJCF as MuJoCo 3 reads it, with the package that the examples of plug-ins install.
#include "adapters/mjcf/mujoco3_reader.h"

#include <boost/test/unit_test.hpp>
#include <cstdlib>

#include "adapters/mjcf/mjcf_import.h"
#include "core/base/error.h"
#include "generated/tests/places.h"
#include "tests/folder.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_mjcf_mujoco3_reader, *boost::unit_test::enable_if<RIGOR_HTML_REPORT>())

namespace {

// One named and one nameless element of each kind; the world is a body of the name "world".
constexpr const char* kModel = R"(<mujoco><worldbody><site name="post" pos="0 0 2"/><site pos="0 0 3"/>
  <body name="arm"><joint name="shoulder" axis="0 1 0"/><geom name="rod" size="0.1"/>
    <body pos="0 0 1"><joint axis="1 0 0" armature="0.25"/><geom size="0.2"/></body></body></worldbody>
  <tendon><spatial name="rope" stiffness="3"><site site="post"/><geom geom="rod"/><site site="post"/></spatial>
    <fixed><joint joint="shoulder" coef="2"/></fixed></tendon>
  <equality><connect name="pin" body1="arm" anchor="0 0 0"/><connect body1="arm" anchor="0 0 1"/></equality>
  <actuator><motor name="drive" joint="shoulder"/><motor joint="shoulder"/></actuator>
  <keyframe><key name="home" qpos="0.5 0.25"/><key qpos="0 0"/></keyframe></mujoco>)";

CompiledMjcf read(const Folder& folder, const std::string& text, const std::string& keyframe = "") {
  setenv("RIGOR_MUJOCO3", RIGOR_BUILD_DIR "/plugins/npm", 1);
  MjcfSource source{folder.write("m.xml", text), keyframe, {}, {}};
  return read_with_mujoco3(source);
}

}  // namespace

// Its function for names gives a nameless element the name "emsc".
BOOST_AUTO_TEST_CASE(nameless_elements_have_no_name) {
  const Folder folder;
  const CompiledMjcf model = read(folder, kModel);
  const std::map<std::string, std::vector<std::string>> due = {
      {"actuator", {"drive", ""}}, {"body", {"world", "arm", ""}}, {"equality", {"pin", ""}}, {"geom", {"rod", ""}},
      {"joint", {"shoulder", ""}}, {"keyframe", {"home", ""}},     {"site", {"post", ""}},    {"tendon", {"rope", ""}}};
  for (const auto& [kind, names] : due)
    BOOST_TEST(model.names.at(kind) == names, kind << ": " << model.names.at(kind).back());
  BOOST_TEST(model.names.size() == due.size());
  BOOST_TEST(model.parser.starts_with("MuJoCo 3."), model.parser);
  BOOST_TEST(model.adds_margins);  // 3.14, as package-lock.json says
}

BOOST_AUTO_TEST_CASE(numbers_are_those_of_the_file_and_of_its_keyframe) {
  const Folder folder;
  const CompiledMjcf start = read(folder, kModel), home = read(folder, kModel, "home");
  BOOST_TEST((start.numbers.at("dof_armature") == std::vector<double>{0, 0.25}));
  BOOST_TEST((start.numbers.at("qpos") == std::vector<double>{0, 0}));
  BOOST_TEST((home.numbers.at("qpos") == std::vector<double>{0.5, 0.25}));
  BOOST_TEST((start.numbers.at("eq_active") == std::vector<double>{1, 1}));
}

// MuJoCo 3 bounds what all drives of a joint or a tendon give together. No scene does.
BOOST_AUTO_TEST_CASE(a_drive_that_its_tendon_or_a_joint_bounds_is_a_loss) {
  const auto losses = [](const std::string& joint, const std::string& tendon, const std::string& drive) {
    const Folder folder;
    const std::string text = R"(<mujoco><worldbody><body><joint name="a" axis="0 1 0" range="-90 90" )" + joint +
                             R"(/><geom size="0.1" pos="0 0 1"/><body pos="0 0 2">
      <joint name="b" axis="0 1 0" range="-90 90"/><geom size="0.1" pos="0 0 1"/></body></body></worldbody><tendon>
      <fixed name="t" )" + tendon +
                             R"(><joint joint="b" coef="2"/><joint joint="a" coef="1"/></fixed></tendon>
      <actuator>)" + drive + "</actuator></mujoco>";
    const MjcfSource source{folder.write("m.xml", text), "", {}, {}};
    return losses_of(links_of_mjcf(source, read(folder, text)).left_out.all(), LossKind::physical).size();
  };
  const std::string servo = R"(<position tendon="t" kp="5"/>)", bounds = R"(actuatorfrcrange="-1 1")";
  BOOST_TEST(losses("", "", servo) == 0u);
  BOOST_TEST(losses(bounds, "", servo) == 1u);
  BOOST_TEST(losses("", bounds, servo) == 1u);
  const std::string push = R"(<general tendon="t" biastype="affine" biasprm="3 0 0"/>)";
  BOOST_TEST(losses("", "", push) == 0u);
  BOOST_TEST(losses(bounds, "", push) == 1u);
  BOOST_TEST(losses("", bounds, push) == 1u);
}

BOOST_AUTO_TEST_CASE(a_model_that_it_refuses_is_refused_with_its_line) {
  const Folder folder;
  BOOST_CHECK_EXCEPTION(
      read(folder, "<mujoco>\n<worldbody>\n<gem/></worldbody></mujoco>"), InputError, [&](const InputError& error) {
        const std::string said = error.what();
        return said.find("m.xml:3: MuJoCo 3.") != std::string::npos && said.find("gem") != std::string::npos;
      });
}

BOOST_AUTO_TEST_SUITE_END()
