// Motors in time, servos and friction in a case file: what is read, what is refused, and what is written again.
#include <boost/test/unit_test.hpp>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "core/scene/features/features.h"
#include "core/scene/toml/writing/scene_writer.h"
#include "tests/core/scene/scene_of.h"
#include "tests/core/scene/toml/refusal.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(core_scene_toml_drive_reader)

namespace {

// Lines 1 to 11. The motor's first key is on line 12.
const std::string kWheel = R"([scene]
body = [ { name = "wheel", mass = 1, inertia = [1, 1, 1], position = [0, 0, 0] } ]
[[scene.joint]]
name = 'axle'
type = 'hinge'
a = 'world'
b = 'wheel'
anchor = [0, 0, 0]
axis = [0, 0, 1]
[[scene.motor]]
joint = 'axle'
)";

const std::vector<Refusal> kBadDrives = {
    {"torque = [[0, 1], [0, 2]]", "12:19: scene.motor.torque[1]: ", {"the time 0 after 0", "rise"}},
    {"torque = [[0, 1], [1, 2, 3]]", "12:19: scene.motor.torque[1]: ", {"an array of 3"}},
    {"torque = [[0, nan]]", "12:15: scene.motor.torque[0][1]: ", {"nan", "finite"}},
    {"torque = []", "12:10: scene.motor.torque: ", {}},
    {"torque = [[0, 1], [1, 2]]\ninterpolate = 'linaer'", "13:15: scene.motor.interpolate: ", {"'linear'"}},
    {"torque = 1\ninterpolate = 'linear'", "13:15: scene.motor.interpolate: ", {"torque is a number"}},
    {"torque = 1\nfile = 'x.csv'\ncolumn = 'torque'", "13:8: scene.motor.file: ", {"a second time"}},
    {"file = '../x.csv'\ncolumn = 'torque'", "12:8: scene.motor.file: ", {"in the case file's folder"}},
    {"file = '/etc/passwd'\ncolumn = 'torque'", "12:8: scene.motor.file: ", {"in the case file's folder"}},
    {"column = 'torque'\ntorque = 1", "12:10: scene.motor.column: ", {"no file"}},
    {"kp = -1\ntarget = 1", "12:6: scene.motor.kp: ", {"found -1", "0 or greater"}},
    {"kp = 1\ntarget = 1\nkd = -1", "14:6: scene.motor.kd: ", {"found -1"}},
    {"kp = 1", "10:1: scene.motor: ", {"no target"}},
    {"kd = 1\ntarget = 1", "13:10: scene.motor.target: ", {"kp"}},
    {"kp = 1\ntarget = 1\ntarget_speed = 1", "14:16: scene.motor.target_speed: ", {"kd"}},
    {"kp = 1\ntarget = 1\nperiod = 0", "14:10: scene.motor.period: ", {"found 0"}},
    {"kp = 1\ntarget = 1\nmost = 0", "14:8: scene.motor.most: ", {"found 0"}},
    {"kp = 1\ntarget = 1\ntorque = 1", "10:1: scene.motor: ", {"more than one drive"}},
    {"target = 1", "10:1: scene.motor: ", {"neither kp nor kd"}},
    {"speed = 1\nmost = 1\ninterpolate = 'linear'", "14:15: scene.motor.interpolate: ", {"no such key"}},
    {"kp = 1\ntarget = 1\n[[scene.motor]]\njoint = 'axle'\nkp = 2\ntarget = 1",
     "16:6: scene.motor.kp: ",
     {"another servo"}},
};

// A case file in a folder of its own.
class CaseFolder {
 public:
  CaseFolder() : path_(std::filesystem::temp_directory_path() / "rigor-drive-reader-test") {
    std::filesystem::create_directories(path_);
  }
  ~CaseFolder() { std::filesystem::remove_all(path_); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path_ / name) << text; }
  std::string path(const std::string& name) const { return (path_ / name).string(); }
  Scene read(const std::string& motor) const {
    const TomlFile file = TomlFile::parse(kWheel + motor, path("s.toml"));
    return read_scene(file.root({"scene"}).at("scene"));
  }

 private:
  std::filesystem::path path_;
};

std::set<std::string> features_of(const Scene& scene) {
  std::set<std::string> features;
  for (const Need& need : needs_of(scene)) features.insert(word_of(need.feature));
  return features;
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_drive_that_cannot_be_is_refused) {
  for (const Refusal& row : kBadDrives) check_refusal(row, "s.toml", [&] { scene_of(kWheel + row.text); });
}

BOOST_AUTO_TEST_CASE(a_table_is_linear_or_keeps_the_previous_value) {
  const std::string rows = "torque = [[1, 2], [3, 6]]\n";
  const Motor linear = scene_of(kWheel + rows).motors.at(0),
              previous = scene_of(kWheel + rows + "interpolate = 'previous'").motors.at(0);
  BOOST_TEST(linear.efforts->at(0) == 2);
  BOOST_TEST(linear.efforts->at(2) == 4);
  BOOST_TEST(linear.efforts->at(9) == 6);
  BOOST_TEST(previous.efforts->at(2.99) == 2);
  BOOST_TEST(previous.efforts->at(3) == 6);
  BOOST_TEST(linear.mean_effort(0, 4) == (2 + 8 + 6) / 4.0);
  BOOST_TEST(previous.mean_effort(4, -4) == (2 + 4 + 6) / 4.0);
  BOOST_TEST(linear.next_switch(0, 10) == 1);
  BOOST_TEST(linear.next_switch(1, 10) == 3);
  BOOST_TEST(linear.next_switch(3, 10) == 10);
  BOOST_TEST(linear.next_switch(10, 0) == 3);
  BOOST_TEST((features_of(scene_of(kWheel + rows)) == std::set<std::string>{"joint:hinge", "motor:table"}));
}

BOOST_AUTO_TEST_CASE(a_column_of_a_file_beside_the_case_is_a_table) {
  const CaseFolder folder;
  folder.write("x.csv", "time,left, torque\r\n0,1,2\r\n0.5,3,4\r\n\r\n");
  const Motor motor = folder.read("file = 'x.csv'\ncolumn = 'torque'").motors.at(0);
  BOOST_TEST(motor.efforts->times == (std::vector<double>{0, 0.5}), boost::test_tools::per_element());
  BOOST_TEST(motor.efforts->values == (std::vector<double>{2, 4}), boost::test_tools::per_element());
  BOOST_TEST(folder.read("kp = 2\nfile = 'x.csv'\ncolumn = 'left'").motors.at(0).servo->target.at(0.25) == 2);
}

BOOST_AUTO_TEST_CASE(a_file_that_is_no_table_is_refused_at_its_place) {
  const CaseFolder folder;
  folder.write("x.csv", "time,torque\n0,1\n0,2\n");
  folder.write("nan.csv", "time,torque\n0, nan\n");
  folder.write("short.csv", "time,torque\n0\n");
  folder.write("late.csv", "t,torque\n0,1\n");
  folder.write("empty.csv", "time,torque\n");
  const struct {
    std::string motor, message;
  } rows[] = {{"file = 'x.csv'\ncolumn = 'torque'", folder.path("x.csv") + ":3:1: found the time 0 after 0"},
              {"file = 'nan.csv'\ncolumn = 'torque'", folder.path("nan.csv") + ":2:4: found 'nan'"},
              {"file = 'short.csv'\ncolumn = 'torque'", folder.path("short.csv") + ":2:2: found 1 columns"},
              {"file = 'late.csv'\ncolumn = 'torque'", folder.path("late.csv") + ":1:1: the first column is 't'"},
              {"file = 'empty.csv'\ncolumn = 'torque'", folder.path("empty.csv") + ":1:1: there is no row"},
              {"file = 'x.csv'\ncolumn = 'torqe'", folder.path("s.toml") + ":13:10: scene.motor.column: "},
              {"file = 'none.csv'\ncolumn = 'torque'", folder.path("none.csv")}};
  for (const auto& row : rows) {
    const std::string message = refusal_of([&] { folder.read(row.motor); });
    BOOST_TEST_CONTEXT(message) BOOST_TEST(message.substr(0, row.message.size()) == row.message);
  }
}

BOOST_AUTO_TEST_CASE(a_link_out_of_the_folder_is_refused) {
  const CaseFolder folder;
  std::filesystem::create_symlink("/etc/hostname", folder.path("x.csv"));
  const std::string message = refusal_of([&] { folder.read("file = 'x.csv'\ncolumn = 'torque'"); });
  BOOST_TEST(message.find("in the case file's folder") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(servos_tables_and_friction_are_written_as_they_are_read) {
  const std::string drives[] = {
      "torque = [[0, 1], [2, 3]]\ninterpolate = 'previous'",
      "kp = 2\nkd = 3\ntarget = [[0, 1], [2, 3]]\ntarget_speed = 4\nmost = 5\nperiod = 0.5\nfrom = 1\nuntil = 7",
      "kd = 3",
  };
  for (const std::string& drive : drives) {
    const std::string text = kWheel + drive;
    const Scene scene = scene_of(text), again = scene_of(scene_toml(scene));
    BOOST_TEST_CONTEXT(scene_toml(scene)) BOOST_TEST(scene_json(again) == scene_json(scene));
  }
  std::string text = kWheel;
  text.replace(text.find("[[scene.motor]]"), std::string::npos, "friction = 0.5");
  const Scene scene = scene_of(text), again = scene_of(scene_toml(scene));
  BOOST_TEST(scene.motors.at(0).is_friction);
  BOOST_TEST(scene.motors.at(0).most == 0.5);
  BOOST_TEST(again.motors.size() == 1u);
  BOOST_TEST(scene_json(again) == scene_json(scene));
  BOOST_TEST(scene_json(scene).find("\"friction\":0.5") != std::string::npos);
  BOOST_TEST((features_of(scene) == std::set<std::string>{"joint:hinge", "joint-friction"}));
}

BOOST_AUTO_TEST_CASE(a_servo_needs_its_feature_and_a_continuous_one_with_kd_is_a_damper) {
  BOOST_TEST((features_of(scene_of(kWheel + "kp = 1\nkd = 1\ntarget = 1\nperiod = 0.1")) ==
              std::set<std::string>{"joint:hinge", "motor:servo"}));
  BOOST_TEST((features_of(scene_of(kWheel + "kp = 1\nkd = 1\ntarget = 1")) ==
              std::set<std::string>{"joint:hinge", "joints-with-dampers", "motor:servo"}));
}

BOOST_AUTO_TEST_SUITE_END()
