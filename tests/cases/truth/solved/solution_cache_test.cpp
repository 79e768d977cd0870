#include "cases/truth/solved/solution_cache.h"

#include <boost/test/unit_test.hpp>
#include <cstdlib>
#include <iterator>
#include <set>

#include "tests/cases/judged.h"
#include "tests/folder.h"

using namespace rigor;

namespace cases_truth_solved_solution_cache {

namespace fs = std::filesystem;

// The three variables that say where the cache is; as they were, afterwards.
struct CacheFolder : Folder {
  std::vector<std::pair<const char*, std::optional<std::string>>> before;
  CacheFolder() {
    for (const char* name : {"RIGOR_CACHE_DIR", "XDG_CACHE_HOME", "HOME"}) {
      const char* value = std::getenv(name);
      before.emplace_back(name, value ? std::optional<std::string>(value) : std::nullopt);
      ::unsetenv(name);
    }
    set("RIGOR_CACHE_DIR", path / "cache");
  }
  ~CacheFolder() {
    for (const auto& [name, value] : before) value ? ::setenv(name, value->c_str(), 1) : ::unsetenv(name);
  }
  static void set(const char* name, const fs::path& value) { ::setenv(name, value.c_str(), 1); }

  // But that which says when the folder was last tidied.
  std::vector<fs::path> files() const {
    std::vector<fs::path> found;
    for (const auto& entry : fs::recursive_directory_iterator(path)) {
      if (entry.is_regular_file() && entry.path().filename() != "last-tidied") found.push_back(entry.path());
    }
    return found;
  }
};

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

bool same(const ReferenceSolution& a, const ReferenceSolution& b) {
  return a.dimension == b.dimension && a.times == b.times && a.states == b.states && a.error_times == b.error_times &&
         a.errors == b.errors && a.complete == b.complete && a.phases.times == b.phases.times &&
         a.phases.modes == b.phases.modes;
}

const Scene kScene = test::coupled_bodies(0.5);
const std::string kContent = reference_content(kScene, 1);

}  // namespace cases_truth_solved_solution_cache

BOOST_FIXTURE_TEST_SUITE(cases_truth_solved_solution_cache, CacheFolder)

BOOST_AUTO_TEST_CASE(a_solution_comes_back_bit_by_bit) {
  const ReferenceSolution solution = solve_reference(kScene, 1);
  BOOST_TEST(!kept_solution(kContent).has_value());
  keep_solution(kContent, solution);
  BOOST_TEST_REQUIRE(kept_solution(kContent).has_value());
  BOOST_TEST(same(*kept_solution(kContent), solution));
  BOOST_TEST(files().size() == 1);  // no draft is left
}

BOOST_AUTO_TEST_CASE(a_truth_is_the_same_with_the_cache_and_without) {
  make_truth("reference", kScene, 1);
  const auto kept = make_truth("reference", kScene, 1);
  BOOST_TEST(files().size() == 1);
  set("RIGOR_CACHE_DIR", "");
  const auto solved = make_truth("reference", kScene, 1);
  for (const double t : {0.0, 0.37, 1.0}) {
    const BodyTable a = test::truth_at(*kept, t, 2), b = test::truth_at(*solved, t, 2);
    for (int c = 0; c < 13; ++c) BOOST_TEST(a.columns().column(c)[1] == b.columns().column(c)[1]);
    BOOST_TEST(kept->error(t) == solved->error(t));
  }
}

BOOST_AUTO_TEST_CASE(what_is_kept_is_what_is_used) {
  ReferenceSolution marked = solve_reference(kScene, 1);
  for (double& error : marked.errors) error = 0.125;
  keep_solution(kContent, marked);
  BOOST_TEST(make_truth("reference", kScene, 1)->error(0.5) == 0.125);
}

BOOST_AUTO_TEST_CASE(the_folder_is_the_first_of_three_that_is_named) {
  const ReferenceSolution solution = solve_reference(kScene, 1);
  set("XDG_CACHE_HOME", path / "xdg"), set("HOME", path / "home");
  const auto kept_in = [&] {
    keep_solution(kContent, solution);
    const fs::path folder = files().at(0).parent_path();
    fs::remove_all(path), fs::create_directory(path);
    return fs::relative(folder, path).string();
  };
  BOOST_TEST(kept_in() == "cache");
  ::unsetenv("RIGOR_CACHE_DIR");
  BOOST_TEST(kept_in() == "xdg/rigor");
  ::unsetenv("XDG_CACHE_HOME");
  BOOST_TEST(kept_in() == "home/.cache/rigor");
  ::unsetenv("HOME");
  keep_solution(kContent, solution);
  BOOST_TEST(files().empty());
}

BOOST_AUTO_TEST_CASE(every_number_of_the_motion_counts_and_no_name) {
  const auto changed = [](auto change) {
    Scene scene = kScene;
    change(scene);
    return reference_content(scene, 1) != kContent;
  };
  const auto next = [](double& number) { number = std::nextafter(number, 1e300); };  // by its last bit
  BOOST_TEST(reference_content(kScene, std::nextafter(1, 2)) != kContent);
  BOOST_TEST(changed([&](Scene& s) { next(s.gravity.z()); }));
  BOOST_TEST(changed([&](Scene& s) { next(s.bodies[1].mass); }));
  BOOST_TEST(changed([&](Scene& s) { next(s.bodies[1].inertia(0, 1)); }));
  BOOST_TEST(changed([&](Scene& s) { next(s.bodies[1].position.y()); }));
  BOOST_TEST(changed([&](Scene& s) { next(s.bodies[1].orientation.w()); }));
  BOOST_TEST(changed([&](Scene& s) { next(s.bodies[1].velocity.x()); }));
  BOOST_TEST(changed([&](Scene& s) { next(s.bodies[1].angular_velocity.z()); }));
  BOOST_TEST(changed([&](Scene& s) { s.bodies[1].fixed = true; }));
  BOOST_TEST(changed([&](Scene& s) { next(s.springs[1].stiffness); }));
  BOOST_TEST(changed([&](Scene& s) { next(s.springs[1].damping); }));
  BOOST_TEST(changed([&](Scene& s) { next(s.springs[1].rest_length); }));
  BOOST_TEST(changed([&](Scene& s) { next(s.springs[1].point_a.x()); }));
  BOOST_TEST(changed([&](Scene& s) { next(s.springs[1].point_b.x()); }));
  BOOST_TEST(changed([&](Scene& s) { s.springs[1].a = kWorld; }));
  BOOST_TEST(changed([&](Scene& s) { next(s.forces[0].force.x()); }));
  BOOST_TEST(changed([&](Scene& s) { next(s.forces[0].torque.x()); }));
  BOOST_TEST(changed([&](Scene& s) { next(s.forces[0].point.x()); }));
  BOOST_TEST(changed([&](Scene& s) { next(s.forces[0].from); }));
  BOOST_TEST(changed([&](Scene& s) { s.forces[0].until = 3; }));
  BOOST_TEST(!changed([&](Scene& s) { s.bodies[0].name = "another"; }));
}

// A hinge at whose limit its body is struck, by a motor too.
Scene stopped() {
  Scene scene;
  scene.bodies = {test::body("arm", 1, {1, 1, 1}, {0, 0, 0})};
  scene.joints.push_back({kWorld, 0, HingeJoint{Vec3::Zero(), Vec3::UnitZ()}});
  scene.joints[0].upper = 1, scene.joints[0].restitution = 0.5;
  scene.motors.push_back({.joint = 0, .speed = 2.0, .most = 3});
  return scene;
}

BOOST_AUTO_TEST_CASE(every_number_of_limits_and_motors_counts) {
  const auto changed = [](auto change) {
    Scene scene = stopped();
    change(scene);
    return reference_content(scene, 1) != reference_content(stopped(), 1);
  };
  BOOST_TEST(!changed([](Scene&) {}));
  BOOST_TEST(changed([](Scene& s) { s.joints[0].upper = 2; }));
  BOOST_TEST(changed([](Scene& s) { s.joints[0].lower = -1; }));
  BOOST_TEST(changed([](Scene& s) { s.joints[0].restitution = 0; }));
  BOOST_TEST(changed([](Scene& s) { s.motors[0].speed = 1; }));
  BOOST_TEST(changed([](Scene& s) { s.motors[0].speed.reset(); }));
  BOOST_TEST(changed([](Scene& s) { s.motors[0].most = 1; }));
}

// Two joints of one kind between the same bodies, which differ in where or how they lie, make other motions.
BOOST_AUTO_TEST_CASE(where_each_kind_of_joint_lies_counts) {
  const auto with = [](const auto& type) {
    Scene scene = stopped();
    scene.joints[0].type = type;
    return reference_content(scene, 1);
  };
  const Vec3 o = Vec3::Zero(), x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  const std::vector<std::string> contents = {with(BallJoint{o}),
                                             with(BallJoint{x}),
                                             with(CylindricalJoint{o, z}),
                                             with(CylindricalJoint{x, z}),
                                             with(CylindricalJoint{o, x}),
                                             with(HingeJoint{o, z}),
                                             with(HingeJoint{x, z}),
                                             with(HingeJoint{o, x}),
                                             with(SliderJoint{z}),
                                             with(SliderJoint{x}),
                                             with(FixedJoint{}),
                                             with(DistanceJoint{o, x}),
                                             with(DistanceJoint{y, x}),
                                             with(DistanceJoint{o, y}),
                                             with(UniversalJoint{o, x, y}),
                                             with(UniversalJoint{z, x, y}),
                                             with(UniversalJoint{o, z, y}),
                                             with(UniversalJoint{o, x, z})};
  BOOST_TEST(std::set<std::string>(contents.begin(), contents.end()).size() == contents.size());
  Scene other = stopped();
  other.joints[0].stiffness = 1;
  BOOST_TEST(reference_content(other, 1) != reference_content(stopped(), 1));
  other.joints[0].stiffness = 0, other.joints[0].damping = 1;
  BOOST_TEST(reference_content(other, 1) != reference_content(stopped(), 1));
  other.joints[0].stiffness = 1;
  Scene at_rest_elsewhere = other;
  at_rest_elsewhere.joints[0].rest = 1;
  BOOST_TEST(reference_content(at_rest_elsewhere, 1) != reference_content(other, 1));
}

// Bodies that differ in shape or size alone touch elsewhere.
BOOST_AUTO_TEST_CASE(the_shape_of_what_touches_counts) {
  const auto with = [](const Shape& shape) {
    Scene scene = test::dropped_sphere(0.5);
    scene.bodies[std::holds_alternative<Plane>(shape) ? 1 : 0].shape = shape;
    return events_content(scene, 1);
  };
  const std::vector<std::string> contents = {with(Sphere{0.1}),
                                             with(Sphere{0.2}),
                                             with(Box{{1, 1, 1}}),
                                             with(Box{{2, 1, 1}}),
                                             with(Box{{1, 2, 1}}),
                                             with(Box{{1, 1, 2}}),
                                             with(Capsule{0.1, 1}),
                                             with(Capsule{0.2, 1}),
                                             with(Capsule{0.1, 2}),
                                             with(Plane{Vec3::UnitY(), 0.5}),
                                             with(Plane{Vec3::UnitY(), 0.25}),
                                             with(Plane{Vec3::UnitX(), 0.5})};
  BOOST_TEST(std::set<std::string>(contents.begin(), contents.end()).size() == contents.size());
}

BOOST_AUTO_TEST_CASE(a_solution_in_phases_comes_back_with_them) {
  const std::string content = reference_content(stopped(), 2);
  const ReferenceSolution solution = solve_reference(stopped(), 2);
  BOOST_TEST(solution.phases.times.size() > 2);
  keep_solution(content, solution);
  const auto kept = kept_solution(content);
  BOOST_REQUIRE(kept.has_value());
  BOOST_TEST(same(*kept, solution));
}

BOOST_AUTO_TEST_CASE(what_another_solver_kept_is_not_taken) {
  const ReferenceSolution solution = solve_reference(kScene, 1);
  const auto check = [&](const auto& content) {
    keep_solution(content(kScene, 1, "an older solver"), solution);
    BOOST_TEST(kept_solution(content(kScene, 1, "an older solver")).has_value());
    BOOST_TEST(!kept_solution(content(kScene, 1, "another")).has_value());
  };
  check([](const auto&... of) { return reference_content(of...); });
  check([](const auto&... of) { return events_content(of...); });
  BOOST_TEST(!kept_solution(kContent).has_value());
  BOOST_TEST(!kept_solution(events_content(kScene, 1)).has_value());
}

BOOST_AUTO_TEST_CASE(a_damaged_cut_or_foreign_file_is_as_if_it_were_not_there) {
  keep_solution(kContent, solve_reference(kScene, 1));
  const fs::path file = files().at(0);
  const std::string good = bytes_of(file);
  std::vector<std::string> bad = {"",
                                  "x",
                                  good + "x",
                                  good.substr(0, good.size() - 1),
                                  good.substr(0, good.size() / 2),
                                  good.substr(0, 40),
                                  std::string(good.size(), '\0')};
  for (const std::size_t place :
       {std::size_t{3}, std::size_t{60}, kContent.size() + 60, good.size() / 2, good.size() - 9, good.size() - 1}) {
    bad.push_back(good);
    bad.back()[place] ^= 4;
  }
  for (const std::string& bytes : bad) {
    std::ofstream(file, std::ios::binary) << bytes;
    BOOST_TEST(!kept_solution(kContent).has_value());
  }
  // A scene whose hash were the same finds another one's content at the head, and its own is computed again.
  std::ofstream(file, std::ios::binary) << good;
  BOOST_TEST(kept_solution(kContent).has_value());
  make_truth("reference", kScene, 1);
  fs::remove(file), fs::create_directory(file);
  BOOST_TEST(!kept_solution(kContent).has_value());
  BOOST_TEST(make_truth("reference", kScene, 1)->error(1) < 1e-12);
}

BOOST_AUTO_TEST_CASE(a_folder_that_cannot_be_written_is_silently_left) {
  const ReferenceSolution solution = solve_reference(kScene, 1);
  for (const fs::path& folder : {fs::path("/proc/no/such/folder"), fs::path(write("file", "not a folder"))}) {
    set("RIGOR_CACHE_DIR", folder);
    BOOST_CHECK_NO_THROW(keep_solution(kContent, solution));
    BOOST_TEST(!kept_solution(kContent).has_value());
    BOOST_CHECK_NO_THROW(make_truth("reference", kScene, 1));
  }
}

BOOST_AUTO_TEST_CASE(what_was_not_used_for_a_month_is_dropped_and_nothing_else) {
  const ReferenceSolution solution = solve_reference(kScene, 1);
  keep_solution(kContent, solution);
  BOOST_REQUIRE_EQUAL(files().size(), 1);
  const fs::path used = files().front(), folder = used.parent_path(), unused = folder / "reference-of-another-program",
                 strange = folder / "notes";
  const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(31 * 24);
  for (const fs::path& file : {unused, strange}) std::ofstream(file) << "x";
  for (const fs::path& file : {used, unused, strange}) fs::last_write_time(file, long_ago);
  BOOST_TEST(kept_solution(kContent).has_value());  // and so it is in use
  keep_solution(reference_content(kScene, 2), solution);
  BOOST_TEST(fs::exists(unused));  // the folder was gone through a moment ago
  fs::last_write_time(folder / "last-tidied", long_ago);
  keep_solution(reference_content(kScene, 3), solution);
  BOOST_TEST(fs::exists(used));
  BOOST_TEST(!fs::exists(unused));
  BOOST_TEST(fs::exists(strange));
}

BOOST_AUTO_TEST_CASE(what_was_unused_for_longest_goes_where_all_take_too_much) {
  const ReferenceSolution solution = solve_reference(kScene, 1);
  keep_solution(kContent, solution);
  const fs::path folder = files().front().parent_path();
  const auto now = fs::file_time_type::clock::now();
  const std::vector<fs::path> large{folder / "reference-an-hour-ago", folder / "reference-two-hours-ago"};
  for (int k = 0; k < 2; ++k) {
    std::ofstream(large[k]) << "x";
    fs::resize_file(large[k], 1'200'000'000);  // takes no room on the disk
    fs::last_write_time(large[k], now - std::chrono::hours(k + 1));
  }
  fs::last_write_time(folder / "last-tidied", now - std::chrono::hours(1));
  keep_solution(reference_content(kScene, 2), solution);
  BOOST_TEST(fs::exists(large[0]));
  BOOST_TEST(!fs::exists(large[1]));
  BOOST_TEST(kept_solution(kContent).has_value());
}

BOOST_AUTO_TEST_SUITE_END()
