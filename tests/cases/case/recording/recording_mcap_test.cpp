// Recordings in MCAP: those that `rigor trace` writes come back, and files that say something else are refused.
#include <zlib.h>

#include <boost/test/unit_test.hpp>

#include "cases/case/case_reader.h"
#include "cases/case/recording/recording.h"
#include "cases/report/trace/mcap_file.h"
#include "cases/report/trace/trace_formats.h"
#include "tests/cases/recorded_case.h"
#include "tests/core/scene/toml/refusal.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_case_recording_recording_mcap)

namespace {

const std::string kPath = "run.mcap";

struct Traced {
  Case definition = read_case_text(test::sliding_scene(0.3), "made.toml", "made", test::words());
  Simulation run =
      simulate(find_engine(engines(), "core"), parse_run_name("core:velocity-verlet", test::words().engines).settings,
               definition.scene, 0.005, 0.2, {});
  std::string file() const {
    const auto writer = mcap_trace(definition.scene, false);
    std::string bytes = writer->begin(run.trajectory.samples.size());
    for (const Sample& sample : run.trajectory.samples) bytes += writer->add(sample);
    return bytes + writer->end();
  }
};

std::vector<RecordedTrial> trials_in(const std::string& file, const Scene& scene, const std::string& group = "") {
  return read_mcap_trials(file, kPath, group, scene);
}

Scene one_cube() {
  Scene scene;
  scene.bodies = {test::body("cube", 1, {1, 1, 1})};
  return scene;
}

std::string transforms(double time, const std::string& child, const std::string& parent = "world",
                       const std::string& rotation = R"({"x":0,"y":0,"z":0,"w":1})") {
  return fmt::format(R"({{"transforms":[{{"timestamp":{{"sec":{},"nsec":{}}},"parent_frame_id":"{}","child_frame_id":)"
                     R"("{}","translation":{{"x":1,"y":2,"z":3}},"rotation":{}}}]}})",
                     static_cast<int>(time), std::llround(1e9 * (time - std::floor(time))), parent, child, rotation);
}

std::string file_of(const std::vector<std::string>& messages, const std::string& topic = "/tf",
                    const std::string& schema = "foxglove.FrameTransforms") {
  McapFile file;
  const auto channel = file.add_channel(topic, schema, "{}");
  std::string bytes = file.begin();
  for (std::size_t n = 0; n < messages.size(); ++n) bytes += file.add(channel, n, messages[n]);
  return bytes + file.end();
}

std::string refusal(const std::string& file, const std::string& group = "") {
  return refusal_of([&] { trials_in(file, one_cube(), group); });
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

BOOST_AUTO_TEST_CASE(a_traced_run_comes_back_to_the_last_digit) {
  const Traced traced;
  const auto trials = trials_in(traced.file(), traced.definition.scene);
  BOOST_TEST_REQUIRE(trials.size() == 1u);
  BOOST_TEST_REQUIRE(trials[0].bodies.size() == 2u);  // the ground has a frame, too
  const RecordedBody& block = trials[0].bodies[0];
  BOOST_TEST_REQUIRE(block.times.size() == traced.run.trajectory.samples.size());
  BOOST_TEST(block.velocities.empty());
  for (std::size_t n = 0; n < block.times.size(); ++n) {
    const BodyState due = traced.run.trajectory.samples[n].bodies.columns().body(0);
    BOOST_TEST(std::abs(block.times[n] - traced.run.trajectory.samples[n].time) <= 1e-9);  // whole nanoseconds
    BOOST_TEST((block.positions[n] == due.position));
    // Normalised once more.
    BOOST_TEST((block.orientations[n].coeffs() - due.orientation.coeffs()).norm() < 1e-15);
  }
}

BOOST_AUTO_TEST_CASE(a_case_names_it_like_a_csv_file) {
  const Folder folder;
  folder.write("run.mcap", Traced().file());
  const std::string text = test::sliding_scene(0.3) +
                           "[truth]\nkind = \"recording\"\nfile = \"run.mcap\"\nposition_noise = 1e-4\n"
                           "orientation_noise = 1e-3\n";
  BOOST_TEST(
      holds(refusal_of([&] { read_case(folder.write("none.toml", text), "none", test::words()); }), "truth.start_fit"));
  const Case found = read_case(folder.write("case.toml", text + "start_fit = 8\n"), "case", test::words());
  BOOST_TEST_REQUIRE(found.recording != nullptr);
  // The parabola of the first samples is the motion itself: 1 m/s, and no turn.
  BOOST_TEST((found.scene.bodies[0].velocity - Vec3(1, 0, 0)).norm() < 1e-6);
}

BOOST_AUTO_TEST_CASE(a_file_that_is_cut_off_anywhere_is_refused) {
  const Scene scene = one_cube();
  const std::string whole = file_of({transforms(0, "cube"), transforms(0.1, "cube"), transforms(0.2, "cube")});
  BOOST_TEST(trials_in(whole, scene)[0].bodies[0].times.size() == 3u);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::string found = refusal(whole.substr(0, size));
    BOOST_TEST(found.starts_with(kPath), size << ": " << found);
    BOOST_TEST(holds(found, "allowed: "), size << ": " << found);
  }
}

// Samples of two topics are two motions.
BOOST_AUTO_TEST_CASE(transforms_of_the_usual_topic_replace_those_of_another_one_before) {
  McapFile file;
  std::string bytes = file.begin();
  double time = 0;
  for (const char* topic : {"/camera", "/tf"}) {
    const auto channel = file.add_channel(topic, "foxglove.FrameTransforms", "{}");
    for (int n = 0; n < 2; ++n, time += 0.1) bytes += file.add(channel, 0, transforms(time, "cube"));
  }
  const auto trials = trials_in(bytes + file.end(), one_cube());
  BOOST_TEST(trials[0].bodies[0].times.size() == 2u);
}

// A chunk's header: opcode 6 and its length, two times, the size, the checksum, then the compression's name.
BOOST_AUTO_TEST_CASE(compressed_and_damaged_chunks_are_refused) {
  const std::string whole = file_of({transforms(0, "cube"), transforms(0.1, "cube")});
  const std::size_t chunk = 8 + 9 + 4 + 4 + 5;  // behind the magic bytes and the header
  BOOST_TEST_REQUIRE(whole[chunk] == 6);
  const std::size_t name = chunk + 9 + 8 + 8 + 8 + 4;
  std::string packed = whole;
  packed[chunk + 1] = static_cast<char>(packed[chunk + 1] + 4);  // four bytes longer
  packed[name] = 4;
  packed.insert(name + 4, "zstd");
  const std::string found = refusal(packed);
  BOOST_TEST(holds(found, "compressed with 'zstd'; allowed: no compression"), found);

  std::string damaged = whole;
  damaged[name - 4] = 1;  // a checksum that cannot be right
  BOOST_TEST(holds(refusal(damaged), "checksum"));
  const std::size_t records = name + 4 + 8;
  std::string nested = whole;
  nested[records] = 6;
  BOOST_TEST(holds(refusal(nested), "a chunk lies in another one"));
  std::size_t length = 0;
  for (std::size_t i = 8; i > 0; --i) length = length << 8 | static_cast<unsigned char>(whole[name + 4 + i - 1]);
  const auto sum = crc32(0, reinterpret_cast<const Bytef*>(&whole[records]), static_cast<uInt>(length));
  std::string checked = whole;
  for (std::size_t i = 0; i < 4; ++i) checked[name - 4 + i] = static_cast<char>(sum >> (8 * i) & 0xff);
  BOOST_TEST(trials_in(checked, one_cube()).size() == 1u);
}

BOOST_AUTO_TEST_CASE(files_that_say_something_else_are_refused_with_what_is_allowed) {
  const std::string good = transforms(0, "cube"), later = transforms(0.1, "cube");
  BOOST_TEST(holds(refusal("time,px\n"), "is no MCAP file"));
  BOOST_TEST(holds(refusal(file_of({good, later}, "/tf", "foxglove.Log")),
                   "no channel has foxglove.FrameTransforms as JSON; it has: /tf (foxglove.Log, json)"));
  BOOST_TEST(holds(refusal(file_of({})), "has no transform"));
  BOOST_TEST(holds(refusal(file_of({good})), "one sample of 'cube'"));
  BOOST_TEST(holds(refusal(file_of({transforms(0, "cub")})), "no body 'cub' (did you mean 'cube'?); it has: cube"),
             refusal(file_of({transforms(0, "cub")})));
  BOOST_TEST(holds(refusal(file_of({transforms(0, "cube", "hand")})), "in the frame 'hand'; allowed: 'world'"));
  BOOST_TEST(holds(refusal(file_of({later, good})), "times that rise"));
  BOOST_TEST(holds(refusal(file_of({good, good})), "times that rise"));
  BOOST_TEST(holds(refusal(file_of({transforms(0, "cube", "world", R"({"x":0,"y":0,"z":0,"w":2})")})), "length 2"));
  BOOST_TEST(holds(refusal(file_of({transforms(0, "cube", "world", R"({"x":0,"y":0,"z":0})")})), "'w' is no finite"));
  BOOST_TEST(holds(refusal(file_of({"{}"})), "no list 'transforms'"));
  BOOST_TEST(holds(refusal(file_of({"{"})), "no JSON"));
  BOOST_TEST(holds(refusal(file_of({good, later}), "toss"), "an MCAP file has no columns"));
}

BOOST_AUTO_TEST_SUITE_END()
