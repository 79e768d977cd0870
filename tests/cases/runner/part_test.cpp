// Parts of a grid as files, and what merging makes of parts that are damaged, of other grids, or not all there.
#include "cases/runner/shards/part.h"

#include <fmt/format.h>
#include <boost/test/unit_test.hpp>

#include "cases/results/result_json.h"
#include "cases/results/spread.h"
#include "cases/runner/case_process.h"
#include "cases/runner/journal/case_journal.h"
#include "core/base/error.h"
#include "tests/cases/judged.h"
#include "tests/cases/runner/faulty_engine.h"
#include "tests/folder.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_runner_part)

namespace {

EngineTable two_engines() {
  EngineTable table;
  for (const char* name : {"one", "other"}) table.add(std::make_unique<FaultyEngine>(name, [](double&) {}));
  return table;
}

// Two cases, two runs and two steps: in each case the cells 0 and 2 are of the same step, and 1 and 3.
Results planned() {
  const EngineTable table = two_engines();
  const auto infos = infos_of(table);
  return plan_grid({drifting_body("a"), drifting_body("b")},
                   {parse_run_name("one", infos), parse_run_name("other", infos)}, table, {true});
}

PartTitle title_of(int index, int count) {
  PartTitle title;
  title.shard = {index, count}, title.version = "1", title.build = "b", title.arguments = {"run", "a"};
  title.suite = "/suite", title.adapters = "/adapters", title.plans = {{"a", "1"}, {"b", "2"}};
  title.wall_seconds = 3;
  return title;
}

// Alone of a grid that is not cut, if not said otherwise.
Part part_of(const std::vector<Part::Answer>& answers, const std::string& folder = "folder", int index = 1,
             int count = 1) {
  return {folder, title_of(index, count), answers};
}

std::string truth_of(double horizon) { return message_of_truth({1e-12, horizon, 2, 3}); }

Part::Answer passing(std::size_t of, std::size_t cell, const Results& grid) {
  Cell done = grid.cases[of].cells[cell];
  done.status = Status::pass, done.reason.clear();
  return {of, {message_of_cell(cell, done, grid.cases[of].definition.scene), ""}};
}

Part::Answer stable(std::size_t of, std::size_t run) {
  return {of, {message_of_stable_step(run, {Status::pass, "", {0.125, false, false, ""}}), ""}};
}

// All answers of both cases.
std::vector<Part::Answer> all_answers(const Results& grid) {
  std::vector<Part::Answer> answers;
  for (const std::size_t of : {0u, 1u}) {
    answers.push_back({of, {truth_of(7), ""}});
    for (const std::size_t cell : {0u, 1u, 2u, 3u}) answers.push_back(passing(of, cell, grid));
    for (const std::size_t run : {0u, 1u}) answers.push_back(stable(of, run));
  }
  return answers;
}

auto is_input_error(const std::string& part) {
  return [part](const InputError& error) { return test::says(part)(error); };
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_part_is_read_as_it_was_written) {
  const Folder folder;
  const std::string bytes("\0\n\xff", 3);
  folder.write(kPartFile, part_head(title_of(2, 3), 2) + framed(1, {"message", bytes}) + framed(0, {"", ""}));
  const Part part = read_part(folder.path.string());
  BOOST_TEST(part.folder == folder.path.string());
  BOOST_TEST((part.title.shard == Shard{2, 3}));
  BOOST_TEST(part.title.version == "1");
  BOOST_TEST(part.title.build == "b");
  BOOST_TEST((part.title.arguments == std::vector<std::string>{"run", "a"}));
  BOOST_TEST(part.title.suite == "/suite");
  BOOST_TEST(part.title.adapters == "/adapters");
  BOOST_TEST((part.title.plans == title_of(2, 3).plans));
  BOOST_TEST(part.title.wall_seconds == 3);
  BOOST_TEST_REQUIRE(part.answers.size() == 2u);
  BOOST_TEST(part.answers[0].of == 1u);
  BOOST_TEST(part.answers[0].record.message == "message");
  BOOST_TEST(part.answers[0].record.path == bytes);
  BOOST_TEST(part.answers[1].of == 0u);
  BOOST_TEST(part.answers[1].record.message == "");
}

BOOST_AUTO_TEST_CASE(what_is_no_part_or_a_damaged_one_is_refused) {
  const Folder folder;
  const auto refuses = [&](const std::string& text, const std::string& why) {
    folder.write(kPartFile, text);
    BOOST_CHECK_EXCEPTION(read_part(folder.path.string()), InputError, is_input_error(why));
  };
  BOOST_CHECK_EXCEPTION(read_part((folder.path / "none").string()), InputError, is_input_error("holds no part"));
  const std::string head = part_head(title_of(1, 2), 1), record = framed(0, {"message", "path"});
  folder.write(kPartFile, head + record);
  BOOST_CHECK_NO_THROW(read_part(folder.path.string()));
  const std::string cut = "it is cut short, or bytes of it have changed";
  refuses(head, cut);
  refuses(head.substr(0, head.size() - 1), cut);
  refuses(head + record.substr(0, record.size() - 1), cut);
  refuses(head + record + "x", cut);
  refuses(head + record + record, cut);
  refuses(part_head(title_of(1, 2), 0) + record, cut);
  std::string other = head + record;
  other.back() = '?';
  refuses(other, cut);
  other = head + record;
  const std::string form = "\"rigor_part\":1";
  other.replace(other.find(form), form.size(), "\"rigor_part\":2");
  refuses(other, "it is of another form");
  refuses(part_head(title_of(3, 2), 1) + record, "its shard: found '3/2'");
  refuses("no JSON\n", "is no part of a grid, or a damaged one");
  refuses("", "is no part of a grid, or a damaged one");
}

BOOST_AUTO_TEST_CASE(parts_of_different_grids_are_told_apart_by_what_differs) {
  const auto differs = [](const auto& change, const std::string& why) {
    Part other = part_of({}, "two", 2, 2);
    change(other.title);
    const std::string all = "one and two are parts of different grids: " + why;
    BOOST_CHECK_EXCEPTION(check_same_grid({part_of({}, "one", 1, 2), other}), InputError, [&](const InputError& error) {
      BOOST_TEST(error.what() == all);
      return true;
    });
  };
  BOOST_CHECK_NO_THROW(check_same_grid({part_of({}, "one", 1, 2), part_of({}, "two", 2, 2)}));
  differs([](PartTitle& t) { t.version = "2"; }, "version 1 and 2");
  differs([](PartTitle& t) { t.build = "c"; }, "made by different builds of rigor or of an engine");
  differs([](PartTitle& t) { t.shard.count = 3; }, "one of 2 parts and one of 3");
  differs([](PartTitle& t) { t.arguments = {"gate"}, t.plans = {{"c", "1"}}; }, "'rigor run a' and 'rigor gate'");
  differs([](PartTitle& t) { t.plans[0].first = "c"; }, "the case 'a' and 'c'");
  differs([](PartTitle& t) { t.plans[1].second = "3"; }, "the case 'b' is not the same in both");
  differs([](PartTitle& t) { t.plans.pop_back(); }, "2 cases and 1");
  differs([](PartTitle& t) { t.plans.push_back({"c", "3"}); }, "2 cases and 3");
  // Words that make the same grid are the same.
  Part same = part_of({}, "two", 2, 2);
  same.title.arguments = {"run", "a", "b"};
  BOOST_CHECK_NO_THROW(check_same_grid({part_of({}, "one", 1, 2), same}));
  BOOST_CHECK_EXCEPTION(check_same_grid({part_of({}, "one", 2, 3), part_of({}, "two", 2, 3)}), InputError,
                        is_input_error("one and two are both shard 2 of 3; give each part once"));
}

BOOST_AUTO_TEST_CASE(shards_that_are_missing_are_named_from_the_first_to_the_last) {
  BOOST_TEST((missing_shards({part_of({}, "f", 2, 3)}) ==
              std::vector<std::string>{"shard 1 of 3 is missing", "shard 3 of 3 is missing"}));
  BOOST_TEST(missing_shards({part_of({}, "f", 1, 2), part_of({}, "g", 2, 2)}).empty());
}

BOOST_AUTO_TEST_CASE(a_grid_is_filled_in_with_all_that_its_parts_say) {
  const Results plan = planned();
  Results grid = plan;
  std::vector<Part::Answer> answers = all_answers(plan);
  for (const std::size_t cell : {0u, 2u}) {  // paths that are 0.25 m apart
    Path path;
    path.bodies = 1;
    for (const double t : {0.0, 0.5})
      path.times.push_back(t), path.poses.push_back({cell == 0 ? 0.0 : 0.25, 0, 0, 1, 0, 0, 0});
    answers[1 + cell].record.path = packed(path);
  }
  std::vector<Part::Answer> first(answers.begin(), answers.begin() + 7), second(answers.begin() + 7, answers.end());
  second.push_back({0, {truth_of(7), ""}});
  const Merged merged = fill_in(grid, {part_of(first, "f"), part_of(second, "g")});
  BOOST_TEST(merged.missing.empty());
  BOOST_TEST(merged.remarks.empty());
  BOOST_TEST(grid.wall_seconds == 6);
  BOOST_TEST(merged.trajectories.size() == 8u);
  for (const std::size_t c : {0u, 1u}) {
    const CaseResult& result = grid.cases[c];
    BOOST_TEST(result.error == "");
    BOOST_TEST(result.truth.value().horizon == 7);
    for (const Cell& cell : result.cells) {
      BOOST_TEST((cell.status == Status::pass));
      BOOST_TEST(merged.trajectories.at(cell.trajectory) == (c == 0 ? "f" : "g"));
    }
    for (const StableStepResult& found : result.stable_steps)
      BOOST_TEST((found.status == Status::pass && found.step.dt == 0.125));
    BOOST_TEST(result.spreads.size() == (c == 0 ? 1u : 0u));
  }
  BOOST_TEST(grid.cases[0].spreads[0].distance.value == 0.25);
}

BOOST_AUTO_TEST_CASE(truths_that_differ_are_remarked_on_and_the_first_counts) {
  const Results plan = planned();
  Results grid = plan;
  std::vector<Part::Answer> answers = all_answers(plan);
  const Merged merged = fill_in(grid, {part_of(answers, "f"), part_of({{1, {truth_of(8), ""}}}, "g")});
  BOOST_TEST_REQUIRE(merged.remarks.size() == 1u);
  BOOST_TEST(merged.remarks[0] == "the truth of b is not the same in f and g: their machines compute differently");
  BOOST_TEST(grid.cases[1].truth.value().horizon == 7);
}

BOOST_AUTO_TEST_CASE(what_a_part_should_have_said_is_counted_and_named) {
  const Results plan = planned();
  Results grid = plan;
  std::vector<Part::Answer> answers = all_answers(plan);
  answers.erase(answers.begin() + 12, answers.begin() + 14);  // of the second case both stable steps
  answers.erase(answers.begin() + 8);                         // and its first cell
  const Merged merged = fill_in(grid, {part_of(answers)});
  BOOST_TEST_REQUIRE(merged.missing.size() == 1u);
  BOOST_TEST(merged.missing[0] == "b: 3 cells that the parts should have");
  const Cell& lost = grid.cases[1].cells[0];
  BOOST_TEST((lost.status == Status::crashed && lost.reason == "it did not run" && lost.trajectory.empty()));
  BOOST_TEST(!grid.cases[1].cells[1].trajectory.empty());
  BOOST_TEST(grid.cases[1].stable_steps[0].reason == "it did not run");
}

// A cell that no engine can run is not missing.
BOOST_AUTO_TEST_CASE(of_a_shard_that_is_missing_all_say_so_and_nothing_is_counted_as_lost) {
  Results plan = planned();
  plan.cases[1].cells[3].status = Status::unsupported, plan.cases[1].cells[3].reason = "cannot";
  const Results share = share_of(plan, {1, 2});
  std::vector<Part::Answer> answers;
  for (const CaseResult& result : share.cases) {
    const std::size_t of = result.definition.id == "b";
    answers.push_back({of, {truth_of(7), ""}});
    for (std::size_t i = 0; i < result.cells.size(); ++i) {
      if (result.cells[i].status == Status::crashed) answers.push_back(passing(of, i, plan));
    }
    for (std::size_t i = 0; i < result.stable_steps.size(); ++i) {
      if (result.stable_steps[i].status == Status::crashed) answers.push_back(stable(of, i));
    }
  }
  Results grid = plan;
  const Merged merged = fill_in(grid, {part_of(answers, "f", 1, 2)});
  BOOST_TEST((merged.missing == std::vector<std::string>{"shard 2 of 2 is missing"}));
  const Cell& last = grid.cases[1].cells[2];
  BOOST_TEST(last.reason == "it did not run: shard 2 is missing");
  BOOST_TEST((last.status == Status::crashed && last.trajectory.empty()));
  BOOST_TEST(grid.cases[1].stable_steps[1].reason == "it did not run: shard 2 is missing");
  BOOST_TEST(grid.cases[1].cells[3].reason == "cannot");
  BOOST_TEST((grid.cases[0].cells[0].status == Status::pass));
}

BOOST_AUTO_TEST_CASE(a_case_without_a_truth_or_with_an_error_says_why) {
  const Results plan = planned();
  Results grid = plan;
  fill_in(grid, {part_of({})});
  BOOST_TEST(grid.cases[0].error == "no part has come as far as its truth");
  // As a part is written: the error of a case that its process could not judge.
  const Folder folder;
  const EngineTable table = two_engines();
  GridOptions options;
  Results done = plan;
  done.cases[0].error = "no such truth", done.cases[0].error_is_input = true;
  done.cases[1].truth = TruthFacts{1e-12, 7, 2, 3};
  folder.write(kPartFile, part_text(title_of(1, 1), plan, done, table, options));
  Part part = read_part(folder.path.string());
  Results other = plan;
  fill_in(other, {part, part_of({{0, {"{\"error\":\"another\",\"is_input\":false}", ""}}}, "g")});
  BOOST_TEST(other.cases[0].error == "no such truth");  // the first that is heard
  BOOST_TEST(other.cases[0].error_is_input);
  BOOST_TEST(other.cases[1].error == "");
  BOOST_TEST(other.cases[1].truth.value().horizon == 7);
}

BOOST_AUTO_TEST_CASE(an_answer_that_is_none_is_named_with_its_case) {
  const Results plan = planned();
  const auto refuses = [&](const Part::Answer& answer, const std::string& why) {
    Results grid = plan;
    BOOST_CHECK_EXCEPTION(fill_in(grid, {part_of({answer})}), InputError, is_input_error(why));
  };
  Part::Answer renamed = passing(0, 0, plan);
  const std::size_t at = renamed.record.message.find("one--1-10.csv");
  BOOST_TEST_REQUIRE(at != std::string::npos);
  renamed.record.message.replace(at, 3, "two");
  refuses(renamed, "folder: is damaged: an answer of 'a' cannot be read: it names another trajectory");
  refuses({1, {message_of_spreads({}), ""}}, "an answer of 'b' cannot be read: it is about no cell");
  refuses({2, {truth_of(7), ""}}, "an answer of 'no case' cannot be read");
  refuses({0, {"{}", ""}}, "an answer of 'a' cannot be read");
}

// Journals hold what came to an end, with paths; what failed is in the results alone. Both are in the part, once.
BOOST_AUTO_TEST_CASE(a_part_holds_what_journals_kept_and_what_failed_and_each_once) {
  const Folder journals, folder;
  const EngineTable table = two_engines();
  const Results plan = planned();
  GridOptions options;
  options.journals = journals.path.string();
  {
    const CaseResult& of = plan.cases[0];
    Journal journal(journal_of(of, plan, 0, options), plan_of(plan, of, table, options));
    journal.add(Journal::kTruth, {truth_of(7), ""});
    journal.add(1, {passing(0, 1, plan).record.message, "its path"});
    journal.add(5, {stable(0, 1).record.message, ""});
  }
  Results done = plan;
  done.cases[0].truth = TruthFacts{1e-12, 7, 2, 3};
  for (CaseResult& result : done.cases) {
    for (Cell& cell : result.cells) cell.reason = "it fell over";
    for (StableStepResult& step : result.stable_steps) step.reason = "it fell over";
  }
  done.cases[1].cells[0].status = Status::unsupported;
  done.cases[1].stable_steps[0].status = Status::unsupported;
  folder.write(kPartFile, part_text(title_of(1, 1), plan, done, table, options));
  const Part part = read_part(folder.path.string());
  Results seen = plan;
  std::map<std::string, int> times;
  for (const Part::Answer& answer : part.answers) {
    const MessageSubject subject = apply_message(seen.cases[answer.of], answer.record.message);
    ++times[fmt::format("{} {} {}", answer.of, static_cast<int>(subject.part), subject.index)];
    const bool is_of_journal = answer.of == 0 && subject == MessageSubject{MessageSubject::Part::cell, 1};
    BOOST_TEST(answer.record.path == (is_of_journal ? "its path" : ""));
  }
  BOOST_TEST(times.size() == 1u + 6u + 4u);
  for (const auto& [what, count] : times) BOOST_TEST(count == 1, what);
  BOOST_TEST((seen.cases[0].cells[1].status == Status::pass));
  BOOST_TEST((seen.cases[0].stable_steps[1].status == Status::pass));
  BOOST_TEST(seen.cases[0].cells[0].reason == "it fell over");
  BOOST_TEST(seen.cases[1].stable_steps[1].reason == "it fell over");
}

BOOST_AUTO_TEST_SUITE_END()
