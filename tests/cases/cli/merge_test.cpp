// Shards and what `rigor merge` makes of them, by the program itself.
#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "tests/cases/cli/program.h"
#include "tests/cases/cli/without_timings.h"

using namespace rigor;

namespace cases_cli_merge {

using Json = nlohmann::json;

constexpr const char* kGates = R"([[gate]]
metric = "position_error"
max = 1e-9
engines = ["core:rk4"]
because = "exact for a parabola, up to rounding"
[[gate]]
metric = "position_error"
at_least_order = 0.9
engines = ["ode"]
because = "first order; which no shard can say by itself"
)";

struct Parts : Program {
  Parts() { write("1e-9"); }
  void write(const std::string& limit) {
    std::string text = std::string(kThrown) + kGates;
    text.replace(text.find(R"("1/10")"), 6, R"("1/10", "1/20", "1/40")");
    text.replace(text.find("1e-9"), 4, limit);
    folder.write("suite/air/stone.toml", text);
    folder.write("suite/air/other.toml", text);
  }
  std::vector<std::string> words(const std::string& command, const std::string& out) const {
    return {command, "--engine", "core:rk4", "--engine", "ode", "--jobs", "2", "--suite", "suite", "--out", out};
  }
  Answer part(const std::string& command, int k, int n, const std::string& out) const {
    auto all = words(command, out);
    all.insert(all.end(), {"--shard", std::to_string(k) + "/" + std::to_string(n)});
    return run(all);
  }
};

}  // namespace cases_cli_merge

BOOST_FIXTURE_TEST_SUITE(cases_cli_merge, Parts)

BOOST_AUTO_TEST_CASE(three_shards_make_what_one_run_makes_bit_for_bit) {
  for (const std::string command : {"run", "gate"}) {
    for (const std::string limit : {"1e-9", "1e-30"}) {
      write(limit);
      const Answer whole = run(words(command, "whole"));
      for (int k = 1; k <= 3; ++k) {
        const Answer answer = part(command, k, 3, "part" + std::to_string(k));
        BOOST_TEST(answer.code == 0, answer.err);  // a part is not judged
      }
      const Answer merged = run({"merge", "part3", "part1", "part2", "--out", "merged"});
      BOOST_TEST(merged.code == whole.code, merged.err);
      BOOST_TEST(whole.code == (command == "gate" && limit == "1e-30" ? 1 : 0));
      const Json one = Json::parse(content("whole/results.json")), other = Json::parse(content("merged/results.json"));
      BOOST_TEST(without_timings(one) == without_timings(other));
      BOOST_TEST(one.at("cells").size() == 12u);
      for (const Json& cell : one.at("cells")) {
        const std::string file = "/trajectories/" + cell.at("trajectory").get<std::string>();
        BOOST_TEST(content("whole" + file) == content("merged" + file));
        BOOST_TEST(!content("merged" + file).empty());
      }
    }
  }
}

std::vector<std::string> sweep_words(const std::string& out) {
  return {"sweep",    "stone",        "--vary",   "scene.body.stone.mass=1..9:9",
          "--vary",   "dt=1/10,1/20", "--engine", "ode",
          "--engine", "core:rk4",     "--jobs",   "2",
          "--suite",  "suite",        "--out",    out};
}

BOOST_AUTO_TEST_CASE(shards_of_a_sweep_make_the_very_same_tables) {
  BOOST_TEST(run(sweep_words("whole")).code == 0);
  for (const std::string shard : {"1", "2", "3"}) {
    auto words = sweep_words("part" + shard);
    words.insert(words.end(), {"--shard", shard + "/3"});
    const Answer answer = run(words);
    BOOST_TEST(answer.code == 0, answer.err);
    BOOST_TEST(answer.out.find("one part") != std::string::npos, answer.out);
  }
  const Answer merged = run({"merge", "part2", "part1", "part3", "--out", "merged"});
  BOOST_TEST(merged.code == 0, merged.err);
  for (const std::string file : {"/sweep.csv", "/sweep.jsonl", "/sweep.html"}) {
    BOOST_TEST(!content("whole" + file).empty());
    BOOST_TEST(content("whole" + file) == content("merged" + file), file);
  }
  const Answer partly = run({"merge", "part1", "part3", "--out", "partly"});
  BOOST_TEST(partly.code == 3);
  BOOST_TEST(partly.err.find("shard 2 of 3 is missing") != std::string::npos, partly.err);
  BOOST_TEST(content("partly/sweep.csv").find("its shard is missing") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(parts_of_other_sweeps_are_refused) {
  for (const std::string shard : {"1", "2"}) {
    auto words = sweep_words("part" + shard);
    words.insert(words.end(), {"--shard", shard + "/2"});
    if (shard == "2") words.insert(words.end(), {"--duration", "0.5"});
    run(words);
  }
  const Answer mixed = run({"merge", "part1", "part2", "--out", "merged"});
  BOOST_TEST(mixed.code == 2);
  BOOST_TEST(mixed.err.find("different grids") != std::string::npos, mixed.err);
  write("1e-8");  // the case is another one now
  const Answer changed = run({"merge", "part1", "--out", "merged"});
  BOOST_TEST(changed.code == 2);
  BOOST_TEST(changed.err.find("merge with the cases of then") != std::string::npos, changed.err);
  BOOST_TEST(content("merged/sweep.csv").empty());
}

BOOST_AUTO_TEST_CASE(a_missing_part_is_named_and_never_looks_complete) {
  part("gate", 1, 3, "part1"), part("gate", 3, 3, "part3");
  const Answer merged = run({"merge", "part1", "part3", "--out", "merged"});
  BOOST_TEST(merged.code == 3);
  BOOST_TEST(merged.err.find("shard 2 of 3 is missing") != std::string::npos, merged.err);
  int crashed = 0;
  const Json results = Json::parse(content("merged/results.json"));
  for (const Json& cell : results.at("cells")) {
    if (cell.at("status") != "crashed") continue;
    ++crashed;
    BOOST_TEST(cell.at("reason").get<std::string>().find("shard 2 is missing") != std::string::npos);
  }
  BOOST_TEST(crashed >= 2);
  BOOST_TEST(results.at("cells").size() == 12u);
}

BOOST_AUTO_TEST_CASE(a_part_is_no_result_and_ends_what_stood_there) {
  run(words("run", "out"));
  BOOST_TEST(!content("out/results.json").empty());
  part("run", 1, 2, "out");
  BOOST_TEST(content("out/results.json").empty());
  BOOST_TEST(!content("out/part.journal").empty());
  run(words("run", "out"));
  BOOST_TEST(content("out/part.journal").empty());
}

BOOST_AUTO_TEST_CASE(parts_of_different_grids_are_refused_with_what_differs) {
  part("gate", 1, 2, "part1");
  auto finer = words("gate", "finer");
  finer.insert(finer.end(), {"--shard", "2/2", "--dt", "1/80"});
  run(finer);
  part("gate", 2, 3, "third");
  part("gate", 2, 2, "part2");
  write("1e-8");
  part("gate", 2, 2, "later");
  struct Row {
    std::vector<std::string> parts;
    std::string expected;
  };
  folder.write("none/results.json", "{}");
  std::string damaged = content("part2/part.journal");
  damaged.resize(damaged.size() - 1);
  folder.write("cut/part.journal", damaged);
  damaged = content("part2/part.journal");
  damaged[damaged.size() / 2] ^= 1;
  folder.write("bent/part.journal", damaged);
  const std::vector<Row> rows = {
      {{"part1", "finer"}, "--dt 1/80"},    {{"part1", "third"}, "one of 2 parts and one of 3"},
      {{"part1", "later"}, "air/"},         {{"part1", "part1"}, "both shard 1 of 2"},
      {{"part1", "none"}, "holds no part"}, {{"part1", "nowhere"}, "holds no part"},
      {{"part1", "cut"}, "cut short"},      {{"part1", "bent"}, "damaged"},
      {{}, "folders of all parts"},         {{"part1", "part2"}, "not what the parts were made of"},
  };
  for (const Row& row : rows) {
    std::vector<std::string> merge = {"merge"};
    merge.insert(merge.end(), row.parts.begin(), row.parts.end());
    merge.insert(merge.end(), {"--out", "merged"});
    const Answer answer = run(merge);
    BOOST_TEST(answer.code == 2, row.expected);
    BOOST_TEST(answer.err.find(row.expected) != std::string::npos, answer.err);
    BOOST_TEST(!std::filesystem::exists(path("merged/results.json")), row.expected);
  }
}

BOOST_AUTO_TEST_CASE(a_shard_that_there_is_not_is_refused) {
  for (const std::string shard : {"0/3", "4/3", "1", "1/0", "-1/3", "a/b", "1/3/5", "1.5/3", "1/1000000"}) {
    auto all = words("run", "out");
    all.insert(all.end(), {"--shard", shard});
    const Answer answer = run(all);
    BOOST_TEST(answer.code == 2, shard);
    BOOST_TEST(answer.err.find("--shard: found") != std::string::npos, answer.err);
  }
}

BOOST_AUTO_TEST_SUITE_END()
