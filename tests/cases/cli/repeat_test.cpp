// rigor repeat, by the program itself: a new process, hashes in a file, exit codes.
#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "tests/cases/cli/program.h"

using namespace rigor;

namespace cases_cli_repeat {

using Json = nlohmann::json;

struct RepeatFixture : Program {
  RepeatFixture() { folder.write("cube.toml", kSprungCube); }
};

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace cases_cli_repeat

BOOST_FIXTURE_TEST_SUITE(cases_cli_repeat, RepeatFixture)

BOOST_AUTO_TEST_CASE(the_core_repeats_also_in_a_new_process) {
  const Answer answer = run({"repeat", "cube.toml", "--engine", "core:rk4", "--json"});
  BOOST_TEST_REQUIRE(answer.code == 0, answer.out + answer.err);
  const Json report = Json::parse(answer.out)[0];
  BOOST_TEST(report.at("repeats") == true);
  std::string ran;
  for (const Json& change : report.at("changes")) {
    if (change.at("status") == "same-bits") ran += change.at("change").get<std::string>() + " ";
  }
  BOOST_TEST(holds(ran, "again new-process after-another beside-another restored restored "), ran);
  BOOST_TEST(holds(ran, "restored threads threads threads lanes "), ran);
  BOOST_TEST(holds(ran, "copies"), ran);
}

BOOST_AUTO_TEST_CASE(one_change_can_be_tried_alone) {
  const auto changes_of = [&](const std::vector<std::string>& names) {
    std::vector<std::string> words = {"repeat", "cube.toml", "--engine", "core:rk4", "--json"};
    for (const std::string& name : names) words.insert(words.end(), {"--change", name});
    const Answer answer = run(words);
    BOOST_TEST_REQUIRE(answer.code == 0, answer.out + answer.err);
    std::string said;
    const Json report = Json::parse(answer.out);
    for (const Json& change : report[0].at("changes")) {
      const std::string name = change.at("change");
      if (!said.ends_with(name + " ")) said += name + " ";
    }
    return said;
  };
  BOOST_TEST(changes_of({"lanes"}) == "lanes ");
  BOOST_TEST(changes_of({"new-process"}) == "new-process ");
  BOOST_TEST(changes_of({"order", "new-process", "again"}) == "again new-process order ");
  const Answer typo = run({"repeat", "cube.toml", "--engine", "core:rk4", "--change", "lane"});
  BOOST_TEST(typo.code == 2);
  BOOST_TEST(holds(typo.err, "found 'lane' (did you mean 'lanes'?)"), typo.err);
  const Answer both = run({"repeat", "cube.toml", "--engine", "core:rk4", "--change", "lanes", "--record", "a"});
  BOOST_TEST(both.code == 2);
  BOOST_TEST(holds(both.err, "--change"), both.err);
}

// The toy, and copies of it that save too little or no text.
BOOST_AUTO_TEST_CASE(a_plugin_that_restores_less_than_it_had_does_not_repeat) {
  const std::string toy = RIGOR_SOURCE_DIR "/adapters/plugin/examples/toy.py";
  folder.write("stone.toml", kThrown);
  const auto answer_of = [&](const std::string& file) {
    return run({"repeat", "stone.toml", "--plugin", "python3 " + file, "--engine", "toy-py", "--json"});
  };
  const auto restored = [](const Answer& answer) {
    std::string said;
    const Json report = Json::parse(answer.out);
    for (const Json& change : report[0].at("changes")) {
      if (change.at("change") == "restored") said += change.at("status").get<std::string>() + " ";
    }
    return said;
  };
  const Answer whole = answer_of(toy);
  BOOST_TEST_REQUIRE(whole.code == 0, whole.out + whole.err);
  BOOST_TEST(restored(whole) == "same-bits same-bits same-bits same-bits same-bits same-bits same-bits same-bits ");

  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = content(toy);
    const std::size_t at = text.find(from);
    BOOST_TEST_REQUIRE(at != std::string::npos);
    folder.write("wrong.py", text.replace(at, from.size(), to));
    return answer_of("wrong.py");
  };
  const Answer forgetful = with("body.x, body.q, body.v, body.w = state", "body.x, body.q, _, body.w = state");
  BOOST_TEST(forgetful.code == 1, forgetful.out + forgetful.err);
  BOOST_TEST(!holds(restored(forgetful), "same-bits"), restored(forgetful));
  const Answer wordless = with("\"snapshot\": world.save()", "\"snapshot\": 1");
  BOOST_TEST(wordless.code != 0, wordless.out);
  BOOST_TEST(holds(wordless.out + wordless.err, "its snapshot is no text"), wordless.out + wordless.err);
}

BOOST_AUTO_TEST_CASE(of_several_cases_those_are_left_out_that_the_engine_cannot_run) {
  folder.write("top.toml", tumbling_top("top"));
  const std::string held =
      "[[scene.joint]]\ntype = \"compound\"\na = \"world\"\nb = \"top\"\naxes = [{ type = \"slider\", axis = [1, 0, 0] "
      "}, "
      "{ type = \"slider\", axis = [0, 1, 0] }, { type = \"slider\", axis = [0, 0, 1] }, "
      "{ type = \"hinge\", anchor = [0, 0, 0], axis = [0, 0, 1] }, { type = \"hinge\", anchor = [0, 0, 0], axis = [1, "
      "0, 0] }, "
      "{ type = \"hinge\", anchor = [0, 0, 0], axis = [0, 1, 0] }]\n";
  std::string text = content("top.toml");
  folder.write("held.toml", text.insert(text.find("[run]"), held));
  const Answer answer = run({"repeat", "top.toml", "held.toml", "--engine", "ode", "--change", "again"});
  BOOST_TEST(answer.code == 0, answer.out + answer.err);
  BOOST_TEST(holds(answer.out, "top.toml: ode at"), answer.out);
  BOOST_TEST(holds(answer.err, "leaves out held.toml: unsupported: ode has no joint:compound"), answer.err);
  const Answer alone = run({"repeat", "held.toml", "--engine", "ode", "--change", "again"});
  BOOST_TEST(alone.code == 2, alone.out + alone.err);
  BOOST_TEST(run({"repeat", "top.toml", "held.toml", "--engine", "ode", "--record", "two.jsonl"}).code == 0);
  const Answer against = run({"repeat", "top.toml", "held.toml", "--engine", "ode", "--against", "two.jsonl"});
  BOOST_TEST(against.code == 0, against.out + against.err);
  BOOST_TEST(holds(against.out, "top.toml: ode at"), against.out);
  // Where the hashes say that it ran, a case that cannot run is no success. The other one is still compared.
  std::string hashes = content("two.jsonl");
  const std::string name = "\"top.toml\"";
  BOOST_TEST_REQUIRE(hashes.find(name) != std::string::npos, hashes);
  folder.write("both.jsonl", hashes + std::string(hashes).replace(hashes.find(name), name.size(), "\"held.toml\""));
  const Answer lost = run({"repeat", "top.toml", "held.toml", "--engine", "ode", "--against", "both.jsonl"});
  BOOST_TEST(lost.code == 2, lost.out + lost.err);
  BOOST_TEST(holds(lost.out, "same bits"), lost.out);
  BOOST_TEST(holds(lost.err, "held.toml: ode: unsupported: ode has no joint:compound"), lost.err);
}

// The toy, with sines in its motion. On a processor with AVX2 and FMA some sines of glibc differ in the last bit from
// those of an older processor: 1 of 2000, of which this takes 60000.
BOOST_AUTO_TEST_CASE(an_engine_that_takes_sines_from_the_c_library_depends_on_the_processor) {
  std::string text = content(RIGOR_SOURCE_DIR "/adapters/plugin/examples/toy.py");
  const std::string step = "self.x = [x + dt * v for x, v in zip(self.x, self.v)]";
  const std::size_t at = text.find(step);
  BOOST_TEST_REQUIRE(at != std::string::npos);
  text.replace(at, step.size(),
               step +
                   "\n        sines = [math.sin(k + self.x[0]) for k in range(400)]\n"
                   "        self.x[0] += sum(1e6 * (s - round(s, 12)) for s in sines)");
  folder.write("sines.py", text), folder.write("stone.toml", kThrown);
  const auto answer_of = [&](const std::string& file) {
    return run({"repeat", "stone.toml", "--plugin", "python3 " + file, "--engine", "toy-py", "--duration", "1", "--dt",
                "1/150", "--change", "c-library", "--json"});
  };
  const auto status = [](const Answer& answer) {
    return Json::parse(answer.out)[0].at("changes")[0].at("status").get<std::string>();
  };
  const Answer found = answer_of("sines.py");
  BOOST_TEST_REQUIRE(found.code == 0, found.out + found.err);
#if defined(__GLIBC__) && defined(__x86_64__)
  const bool is_newer = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  BOOST_TEST(status(found) == (is_newer ? "differs" : "not-applicable"), found.out);
#else
  BOOST_TEST(status(found) == "not-applicable", found.out);
#endif
}

BOOST_AUTO_TEST_CASE(hashes_agree_with_themselves_and_not_with_another_motion) {
  BOOST_TEST(run({"repeat", "cube.toml", "--engine", "core:rk4", "--record", "a.jsonl"}).code == 0);
  const Answer same = run({"repeat", "cube.toml", "--engine", "core:rk4", "--against", "a.jsonl"});
  BOOST_TEST(same.code == 0, same.err);
  BOOST_TEST(holds(same.out, "same bits in 150 steps"), same.out);
  BOOST_TEST(run({"repeat", "cube.toml", "--engine", "ode", "--against", "a.jsonl"}).code == 2);
  std::string text = content("a.jsonl");
  const std::size_t digit = text.find("\"hashes\":\"") + 10 + 16 * 7;
  text[digit] = text[digit] == '0' ? '1' : '0';
  folder.write("b.jsonl", text);
  const Answer other = run({"repeat", "cube.toml", "--engine", "core:rk4", "--against", "b.jsonl"});
  BOOST_TEST(other.code == 1, other.out);
  BOOST_TEST(holds(other.out, "DIFFERS from step 7 on"), other.out);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_repeated_is_refused) {
  BOOST_TEST(run({"repeat", "--engine", "ode"}).code == 2);
  BOOST_TEST(run({"repeat", "cube.toml", "--engine", "ode", "--record", "a", "--against", "b"}).code == 2);
  BOOST_TEST(run({"repeat", "cube.toml", "--engine", "ode", "--against", "absent.jsonl"}).code == 2);
  folder.write("no.jsonl", "no record");
  const Answer answer = run({"repeat", "cube.toml", "--engine", "ode", "--against", "no.jsonl"});
  BOOST_TEST(answer.code == 2);
  BOOST_TEST(holds(answer.err, "no.jsonl:1: not a record of hashes"), answer.err);
}

BOOST_AUTO_TEST_SUITE_END()
