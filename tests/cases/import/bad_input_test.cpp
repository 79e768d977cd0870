// Untrusted input: each file is rejected with its name and line, and no file outside the model's folder is opened.
#include <sys/resource.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>

#include "adapters/engines.h"
#include "cases/import/memory_limit.h"
#include "core/base/json.h"
#include "tests/cases/cli/program.h"
#include "tests/cases/import/imported.h"

using namespace rigor;
using namespace rigor::test;

namespace cases_import_bad_input {

struct Bad {
  std::string name, text, says;
};

std::string robot(const std::string& inside) { return "<robot name='r'>\n" + inside + "\n</robot>"; }
std::string link(const std::string& name) {
  return "<link name='" + name +
         "'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link>";
}
std::string joint(const std::string& name, const std::string& parent, const std::string& child,
                  const std::string& more = "") {
  return "<joint name='" + name + "' type='continuous'><parent link='" + parent + "'/><child link='" + child + "'/>" +
         more + "</joint>";
}
std::string sdf(const std::string& inside) {
  return "<sdf version='1.7'>\n<model name='m'>" + inside + "</model></sdf>";
}

std::string repeated(const std::string& part, std::size_t size) {
  std::string text;
  while (text.size() + part.size() <= size) text += part;
  return text;
}

const std::string kBomb = "<!DOCTYPE lolz [<!ENTITY a 'aaaaaaaaaa'><!ENTITY b '&a;&a;&a;&a;&a;&a;&a;&a;'>]>\n";

std::vector<Bad> bad_files() {
  return {
      {"a.urdf", "", "a.urdf:1: "},
      {"a.urdf", "<robot name='r'>\n<link name='a'>\n</robot>", "a.urdf:2: is not XML: mismatched element"},
      {"a.xml", "<mujoco>\n" + repeated("<body>", 6 * 120), "a.xml:2: found elements nested deeper than 100"},
      {"a.urdf", kBomb + robot(link("&b;")), "a.urdf:1: found a document type"},
      {"a.xml", kBomb + "<mujoco/>", "a.xml:1: found a document type"},
      {"a.urdf", robot("") + robot(""), "a second element at the top"},
      {"a.urdf", robot(link("a\xff")), "a.urdf:2: found bytes that are not UTF-8"},
      {"a.urdf", robot(link("a&#7;")), "a.urdf:2: link 'a\a': its name is empty or holds a control character"},
      {"a.xml", "<html/>", "a.xml:1: <html>: found this at the top; allowed: <mujoco>, <robot>, <sdf>"},
      {"a.urdf", robot("<link name='a'><inertial><mas value='1'/></inertial></link>"),
       "<mas> is not of the format (did you mean 'mass'?)"},
      {"a.urdf", robot(link("a") + link("a")), "a.urdf:2: link 'a': another link has this name, too"},
      {"a.urdf", robot(link("a") + link("b") + joint("j", "a", "b") + joint("j", "a", "b")),
       "another joint has this name, too"},
      {"a.urdf", robot(link("a") + link("b") + joint("j", "a", "b") + joint("k", "b", "a")),
       "hang on each other in a circle"},
      {"a.urdf", robot(link("a") + link("b") + joint("j", "a", "b") + joint("k", "a", "b")),
       "link 'b' hangs on two joints"},
      {"a.urdf", robot(link("arm") + joint("j", "armm", "arm")), "there is no link 'armm' (did you mean 'arm'?)"},
      {"a.urdf",
       robot("<link name='a'><inertial><mass value='-1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' "
             "iyz='0'/></inertial></link>"),
       "a.urdf:2: link 'a': <mass>: the mass is -1"},
      {"a.urdf",
       robot("<link name='a'><inertial><mass value='1'/><inertia ixx='-1' iyy='1' izz='1' ixy='0' ixz='0' "
             "iyz='0'/></inertial></link>"),
       "no body has this inertia"},
      {"a.urdf",
       robot("<link name='a'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='3' ixy='0' ixz='0' "
             "iyz='0'/></inertial></link>"),
       "none may be greater than the sum of the other two"},
      {"a.urdf",
       robot("<link name='a'><inertial><mass value='nan'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' "
             "iyz='0'/></inertial></link>"),
       "value: found 'nan'; allowed: a finite number"},
      {"a.urdf", robot("<link name='a'><inertial><mass value='1' value='2'/></inertial></link>"), "a.urdf:2: "},
      {"a.urdf", robot(link("a") + link("b") + joint("j", "a", "b", "<axis xyz='0 0 0'/>")), "the axis has no length"},
      {"a.urdf", robot(link("a") + link("b") + joint("j", "a", "b", "<axis xyz='0 0'/>")),
       "xyz: found 2 numbers; allowed: 3"},
      {"a.urdf",
       robot(link("a") + "<link name='b'/>" + link("c") + link("d") + joint("j", "a", "b") + joint("k", "b", "c") +
             joint("l", "b", "d")),
       "link 'b': there is no <inertial>, and it moves"},
      {"a.urdf",
       robot("<link name='a'><inertial><mass value='${m}'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' "
             "iyz='0'/></inertial></link>"),
       "an expression of xacro; expand it first: xacro a.urdf > robot.urdf"},
      {"a.urdf", robot(link("a") + link("b") + joint("j", "a", "b", "<mimic joint='k'/>")),
       "a.urdf:2: joint 'j': <mimic>: there is no joint 'k'"},
      {"a.urdf", robot(link("a") + link("b") + joint("j", "a", "b", "<mimic joint='j'/>")), "mimics itself"},
      {"a.urdf", robot("<link name='a'><collision><geometry><mesh filename='none.stl'/></geometry></collision></link>"),
       "a.urdf:2: link 'a': <mesh>: there is no file 'none.stl'"},
      {"a.xml",
       "<mujoco><worldbody><body name='b'><joint name='j'/><geom size='1'/></body></worldbody>\n<keyframe>\n"
       "<key qpos='0 0'/></keyframe></mujoco>",
       "a.xml:3: MuJoCo refuses the model"},
      {"a.urdf", robot("<link name='a'/>"),
       "a.urdf:1: nothing in it moves; allowed: at least one link that has mass and is not held by the world. Without "
       "mass: a"},
      {"a.urdf",
       robot("<link name='world'/>" + link("a") +
             "<joint name='j' type='fixed'><parent link='world'/><child link='a'/></joint>"),
       "a.urdf:1: nothing in it moves; allowed: at least one link that has mass and is not held by the world"},
      {"a.xml",
       "<mujoco><worldbody><body><joint/><geom size='1'/></body></worldbody>\n<actuator>\n<motor joint='j' "
       "ctrlrange='0 1'/></actuator></mujoco>",
       "a.xml:3: MuJoCo refuses the model"},
      {"a.xml",
       "<mujoco><size nstack='250000000'/><worldbody><body><joint/><geom size='1'/></body></worldbody></mujoco>",
       "a.xml:1: takes more than a gigabyte of memory to read"},
      {"a.urdf", robot("<xacro:property name='x'/>"),
       "is a macro of xacro; expand it first: xacro a.urdf > robot.urdf"},
      {"a.urdf",
       robot("<link name='a'><visual><geometry><mesh filename='../../etc/passwd'/></geometry></visual></link>"),
       "leaves the folder of the model"},
      {"a.urdf",
       robot("<link name='a'><collision><geometry><mesh filename='file:///etc/passwd'/></geometry></collision></link>"),
       "leaves the folder of the model"},
      {"a.sdf", sdf("<link name='a'/>\n<include><uri>/etc/passwd</uri></include>"),
       "a.sdf:3: model 'm': <uri>: '/etc/passwd' leaves the folder"},
      {"a.sdf", sdf("<include><uri>model://sun</uri></include>"), "is looked for in folders of this machine"},
      {"a.sdf", sdf("<include><uri>a.sdf</uri></include>"), "deeper than 16"},
      {"a.sdf", sdf("<link name='a'><pose relative_to='b'/></link><link name='b'><pose relative_to='a'/></link>"),
       "in a circle"},
      {"a.sdf", sdf("<link name='a'/><link name='a'/>"), "another one has the name 'a'"},
      {"a.sdf", sdf("<link name='a'><pose relative_to='c'/></link>"), "there is no frame 'm::c'"},
      {"a.sdf", sdf("<link name='a'><pose>1 2 3</pose></link>"), "found 3 numbers; allowed: 6"},
      {"a.sdf", "<sdf version='3'><model name='m'/></sdf>", "version: found '3'; allowed: 1.4 to 1.11"},
      {"a.sdf", sdf("<link name='a'/><joint name='j' type='revolt'><parent>world</parent><child>a</child></joint>"),
       "did you mean 'revolute'?"},
      {"a.xml", "<mujoco>\n<include file='/etc/passwd'/></mujoco>",
       "a.xml:2: <include>: '/etc/passwd' leaves the folder"},
      {"a.xml", "<mujoco>\n<include file='a.xml'/></mujoco>", "a.xml"},
      {"a.xml", "<mujoco><asset>\n<mesh name='m' file='../secret.stl'/></asset></mujoco>",
       "a.xml:2: mesh 'm': '../secret.stl' leaves the folder"},
      {"a.xml", "<mujoco><compiler meshdir='/etc'/><asset><mesh file='passwd'/></asset></mujoco>",
       "'/etc' leaves the folder"},
  };
}

bool is_built(const std::string& engine) {
  const auto& missing = missing_engines();
  return std::none_of(missing.begin(), missing.end(), [&](const MissingEngine& one) { return one.name == engine; });
}

}  // namespace cases_import_bad_input

BOOST_FIXTURE_TEST_SUITE(cases_import_bad_input, Program)

BOOST_AUTO_TEST_CASE(each_bad_file_is_refused_with_its_line) {
  for (const Bad& bad : bad_files()) {
    const std::string says = refusal_of(bad.name, bad.text);
    if (!is_built("mujoco") && says.find("MJCF is read by MuJoCo, without which") != std::string::npos) continue;
    BOOST_TEST(says.find(bad.says) != std::string::npos, bad.text.substr(0, 200) << " -> " << says);
    BOOST_TEST((says.empty() || says.starts_with(bad.name + ":")), says);
  }
}

BOOST_AUTO_TEST_CASE(a_link_of_the_disk_that_leads_out_of_the_folder_is_not_followed) {
  const Folder other;
  other.write("secret.sdf", "<sdf version='1.7'><model name='secret'><link name='l'/></model></sdf>");
  folder.write("w.sdf", sdf("<include><uri>inside.sdf</uri></include>"));
  std::filesystem::create_symlink(other.path / "secret.sdf", folder.path / "inside.sdf");
  const Answer answer = run({"import", "w.sdf"});
  BOOST_TEST(answer.code == 2);
  BOOST_TEST(answer.err.find("'inside.sdf' leaves the folder") != std::string::npos, answer.err);
  BOOST_TEST(answer.out == "");
}

BOOST_AUTO_TEST_CASE(the_program_imports_runs_and_refuses) {
  folder.write("arm.urdf",
               robot("<link name='base'/>" + link("arm") + joint("j", "base", "arm", "<origin xyz='0 0 1'/>")));
  const Answer made = run({"import", "arm.urdf"});
  BOOST_TEST(made.code == 0, made.err);
  BOOST_TEST(made.err.find("assumed where the file leaves it open") != std::string::npos, made.err);
  folder.write("arm.toml", made.out);
  for (const char* file : {"arm.toml", "arm.urdf"}) {
    const Answer ran = run({"run", file, "--engine", "core:rk4", "--dt", "1/30", "--duration", "0.5", "--out", "out"});
    BOOST_TEST(ran.code == 0, ran.err);
  }
  BOOST_TEST(run({"import"}).code == 2);
  BOOST_TEST(run({"import", "none.urdf"}).code == 2);
  BOOST_TEST(run({"run", "none.urdf"}).code == 2);
}

// A link that Gazebo would bolt down: no scene of the same robot can be made of it.
BOOST_AUTO_TEST_CASE(a_robot_that_would_be_another_one_is_refused_until_its_losses_are_accepted) {
  folder.write("arm.urdf", robot("<link name='base'/>" + link("arm") + joint("j", "base", "arm", "<hydraulics/>")));
  for (const char* command : {"import", "run", "gate", "trace", "truth", "export", "tune", "sweep", "diagnose"}) {
    std::vector<std::string> words = {command, "arm.urdf"};
    if (std::string(command) == "trace" || std::string(command) == "diagnose")
      words.insert(words.end(), {"--engine", "core:rk4"});
    if (std::string(command) == "export") words.insert(words.end(), {"--format", "sdf"});
    if (std::string(command) == "sweep") words.insert(words.end(), {"--vary", "dt=1/10"});
    if (std::string(command) == "tune") words.insert(words.end(), {"--engine", "core", "--within", "1mm"});
    const Answer answer = run(words);
    BOOST_TEST(answer.code == 2, command << ": " << answer.err);
    for (const char* part : {"arm.urdf: this would be another robot; 1 kind of physics would be lost",
                             "<hydraulics>: is not of the format (arm.urdf:2: joint 'j')", "--lossy accepts"})
      BOOST_TEST(answer.err.find(part) != std::string::npos, command << ": " << answer.err);
    BOOST_TEST(answer.out == "", command);
  }
  const Answer ran = run({"run", "arm.urdf", "--lossy", "--engine", "core:rk4", "--dt", "1/30", "--duration", "0.5"});
  BOOST_TEST(ran.code == 0, ran.err);
  const std::string says = "arm.urdf: not the same robot: lost <hydraulics>";
  BOOST_TEST(ran.out.starts_with(says), ran.out);
  const std::string first_screen = content("out/report.md").substr(0, 200);
  BOOST_TEST(first_screen.find("arm.urdf: not the same robot: lost") != std::string::npos, first_screen);
  const Json results = Json::parse(content("out/results.json"));
  BOOST_TEST(results.at("not_the_same_robot").at(0).get<std::string>() == says);
  BOOST_TEST(results.at("cases").at(0).at("losses").at(0).at("kind").is_string());
}

// Without --ground the first line says that nothing is there to land on. With it a robot stands on its lowest point.
BOOST_AUTO_TEST_CASE(a_robot_falls_onto_the_ground_and_not_through_it) {
  const std::string model = RIGOR_SOURCE_DIR "/tests/cases/import/models/quadruped.urdf";
  const Answer in_the_air =
      run({"run", model, "--engine", "core", "--dt", "1/30", "--duration", "0.1", "--out", "out"});
  BOOST_TEST(in_the_air.code == 0, in_the_air.err);
  BOOST_TEST(
      in_the_air.err.starts_with("rigor: " + model + ": it stands in empty space, so 'trunk' falls freely; --ground"),
      in_the_air.err);
  const Answer made = run({"import", model, "--ground"});
  BOOST_TEST(made.out.find("type = \"plane\"") != std::string::npos, made.out.substr(0, 300));
  for (const char* engine : {"core:velocity-verlet", "ode", "bullet"}) {
    if (!is_built(std::string(engine).substr(0, std::string(engine).find(':')))) continue;
    const Answer trace = run({"trace", model, "--ground", "--engine", engine, "--dt", "1/240", "--duration", "1"});
    BOOST_TEST(trace.code == 0, trace.err);
    const std::size_t last = trace.out.rfind("\n1,trunk,");
    BOOST_TEST_REQUIRE(last != std::string::npos, engine << ": " << trace.err);
    std::istringstream row(trace.out.substr(last + 9));
    std::string x, y, z;
    std::getline(row, x, ','), std::getline(row, y, ','), std::getline(row, z, ',');
    // The legs' feet begin 0.3 m below the trunk. It lies on the ground at the end, or is still above it.
    BOOST_TEST((std::stod(z) > -0.45 && std::stod(z) < 0.1), engine << ": " << z);
  }
}

// In a process that may have a gigabyte in all.
BOOST_AUTO_TEST_CASE(what_is_huge_is_refused_within_a_gigabyte, *boost::unit_test::enable_if<kMemoryIsCounted>()) {
  std::string links = "<robot name='r'>\n";
  for (int k = 0; k < 1000000; ++k) links += "<link name='l" + std::to_string(k) + "'/>\n";
  folder.write("links.urdf", links + "</robot>");
  folder.write("frames.urdf", links.substr(0, links.rfind('\n', 16'000'000)) + "</robot>");
  folder.write("deep.urdf", "<robot name='r'>" + repeated("<a>", 3'000'000));
  folder.write("wide.urdf", "<robot name='r'>" + repeated("<a/>", 16'000'000) + "</robot>");
  folder.write("grid.xml",
               "<mujoco><worldbody><body><freejoint/><composite type='grid' count='3000 3000 1' "
               "spacing='0.1'/></body></worldbody></mujoco>");
  for (const char* file : {"links.urdf", "frames.urdf", "deep.urdf", "wide.urdf", "grid.xml"}) {
    const std::string command = "cd '" + folder.path.string() +
                                "' && ulimit -v 1200000 && '" RIGOR_PROGRAM "' import " + file + " >stdout 2>stderr";
    const int status = std::system(command.c_str());
    BOOST_TEST((WIFEXITED(status) && WEXITSTATUS(status) == 2), file << " " << content("stderr").substr(0, 300));
    BOOST_TEST(content("stderr").find(std::string(file) + ":") != std::string::npos, content("stderr").substr(0, 300));
  }
}

BOOST_AUTO_TEST_SUITE_END()
