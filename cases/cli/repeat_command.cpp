// rigor repeat: says which changes, that should not matter, change the bits of a run.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>

#include "cases/analysis/repeats/hash_record.h"
#include "cases/analysis/repeats/repeats.h"
#include "cases/cli/chosen_cases.h"
#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "cases/cli/progress/progress.h"
#include "cases/cli/vocabulary.h"
#include "cases/report/json/pairs/repeats_json.h"
#include "cases/report/wording/printed_command.h"
#include "cases/report/wording/repeats.h"
#include "cases/runner/grid.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/near_match.h"

namespace rigor::inline cli {
namespace {

// A file of this process alone, removed at the end.
class ScratchFile {
 public:
  ScratchFile() {
    std::string pattern = (std::filesystem::temp_directory_path() / "rigor-repeat-XXXXXX").string();
    const int descriptor = mkstemp(pattern.data());
    if (descriptor < 0) throw std::runtime_error(fmt::format("cannot create '{}'", pattern));
    close(descriptor);
    path_ = pattern;
  }
  ~ScratchFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

class RepeatCommand : public Command {
 public:
  void declare(Options& options) override {
    cases_.declare(options), engine_.declare(options), steps_.declare(options), duration_.declare(options);
    jobs_.declare(options), json_.declare(options), timeout_.declare(options);
    options.add({"--change", "NAME", "only this change: " + listed(change_names()) + "; may be repeated"}, changes_);
    options.add({"--record", "FILE", "write the hashes of each step to a file, and make no table"}, record_);
    options.add({"--against", "FILE", "compare with the hashes of --record, from another machine, and make no table"},
                against_);
  }

  int run(const Invocation& invocation) override {
    if (!record_.empty() && !against_.empty())
      throw InputError("rigor repeat: --record and --against exclude each other");
    check_changes();
    const EngineTable engines = engine_.outside.table(timeout_.seconds);
    const RunName name = run_asked_for(engine_, invocation.command, engines);
    if (steps_.dt.size() > 1) throw InputError("rigor repeat: takes at most one --dt");
    if (cases_.words.empty()) throw InputError("rigor repeat: takes at least one case; see rigor list cases");
    std::vector<Case> cases = chosen_cases(cases_, invocation, vocabulary_of(engines.infos()));
    for (Case& definition : cases) {
      override_run(definition, {steps_.dt, duration_.seconds});
      definition.dt.resize(1);
    }
    if (!record_.empty()) return record(cases, name, engines);
    if (!against_.empty()) return compare(cases, name, engines);
    return make_table(cases, name, engines);
  }

 private:
  void check_changes() const {
    const std::vector<std::string> known = change_names();
    for (const std::string& name : changes_) {
      if (std::find(known.begin(), known.end(), name) == known.end())
        throw InputError(
            fmt::format("--change: found '{}'{}; allowed: {}", name, did_you_mean(name, known), listed(known)));
    }
    if (!changes_.empty() && !(record_.empty() && against_.empty()))
      throw InputError("rigor repeat: --change belongs to the table, which --record and --against do not make");
  }

  // Why the engine cannot run a case; empty if it can.
  using Lacks = std::function<std::string(const Case&)>;
  static Lacks what_lacks(const RunName& name, const EngineTable& engines) {
    return [&](const Case& definition) {
      return why_unsupported(engines.info_of(name.engine), name.settings, definition.scene,
                             definition.dt.front().seconds);
    };
  }

  // Does the work for each case. Several cases go on where the engine lacks something for one, or where one fails. All
  // such cases are named on stderr. The exit code is that of the failures.
  static int for_each(const std::vector<Case>& cases, const Lacks& lacks,
                      const std::function<void(const Case&)>& work) {
    if (cases.size() == 1) return work(cases.front()), kGood;
    int code = kGood;
    std::size_t tried = 0;
    for (const Case& definition : cases) {
      if (const std::string why = lacks(definition); !why.empty()) {
        say(fmt::format("leaves out {}: unsupported: {}", definition.id, why));
        continue;
      }
      ++tried;
      try {
        work(definition);
      } catch (const InputError& error) {
        say(fmt::format("{}: {}", definition.id, error.what()));
        code = kBadInput;
      }
    }
    if (tried == 0)
      throw InputError(fmt::format("rigor repeat: the engine can run none of the {} cases", cases.size()));
    return code;
  }

  HashRecord recorded_run(const Case& definition, const RunName& name, const EngineTable& engines) const {
    const RecordedStates states = base_states(engines, definition, name, definition.dt.front(), timeout_.seconds);
    return hash_record(definition, name, engines.info_of(name.engine), definition.dt.front(), hashes_of(states));
  }

  int record(const std::vector<Case>& cases, const RunName& name, const EngineTable& engines) const {
    std::string text;
    const int code = for_each(cases, what_lacks(name, engines), [&](const Case& definition) {
      text += line_of(recorded_run(definition, name, engines));
    });
    std::ofstream file(record_, std::ios::binary);
    file << text << std::flush;
    if (!file) throw InputError(fmt::format("--record: cannot write '{}'", record_));
    return code;
  }

  int compare(const std::vector<Case>& cases, const RunName& name, const EngineTable& engines) const {
    const std::vector<HashRecord> records = read_hash_records(against_);
    // A cell that ran when the hashes were made must run here, too.
    const Lacks lacks = [&, engine_lacks = what_lacks(name, engines)](const Case& definition) {
      const bool has_run = std::any_of(records.begin(), records.end(),
                                       [&](const HashRecord& one) { return one.case_id == definition.id; });
      return has_run ? std::string() : engine_lacks(definition);
    };
    int code = kGood;
    std::string text;
    const int failed = for_each(cases, lacks, [&](const Case& definition) {
      const HashRecord own = recorded_run(definition, name, engines);
      const std::vector<std::uint64_t>& due = matching_record(records, own, against_).hashes;
      const auto at = std::mismatch(due.begin(), due.end(), own.hashes.begin()).first;
      const bool is_same = at == due.end();
      text += fmt::format("{}: {} at {} s: {}\n", own.case_id, name.text, own.dt,
                          is_same ? fmt::format("same bits in {} steps", due.size() - 1)
                                  : fmt::format("DIFFERS from step {} on", at - due.begin()));
      if (!is_same) code = kGateFailed;
    });
    print_table(text);
    return std::max(code, failed);
  }

  int make_table(const std::vector<Case>& cases, const RunName& name, const EngineTable& engines) const {
    Json all = Json::array();
    int code = kGood;
    const int failed = for_each(cases, what_lacks(name, engines), [&](const Case& definition) {
      const RepeatReport report = watched_repeat(engines, definition, name);
      if (!report.repeats()) code = kGateFailed;
      if (json_.is_on) {
        all.push_back(repeats_json(report));
      } else {
        print_table(text_of(report));
      }
    });
    if (json_.is_on) print(all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    return std::max(code, failed);
  }

  RepeatReport watched_repeat(const EngineTable& engines, const Case& definition, const RunName& name) const {
    Progress progress("changes");
    RepeatOptions options{
        jobs_.count, timeout_.seconds,
        [&](const std::string& environment) { return hashes_elsewhere(definition, name, environment); },
        [&](std::size_t done, std::size_t all) { progress.show(done, all); }, changes_};
    return repeat(engines, definition, name, definition.dt.front(), options);
  }

  // By this program, started anew.
  std::vector<std::uint64_t> hashes_elsewhere(const Case& definition, const RunName& name,
                                              const std::string& environment) const {
    const ScratchFile file;
    std::vector<std::string> words = {std::filesystem::read_symlink("/proc/self/exe").string(),
                                      "repeat",
                                      definition.id,
                                      "--engine",
                                      name.text,
                                      "--dt",
                                      definition.dt.front().text,
                                      "--duration",
                                      fmt::format("{:.17g}", definition.duration),
                                      "--timeout",
                                      fmt::format("{}", timeout_.seconds),
                                      "--record",
                                      file.path()};
    const std::vector<std::string> from = where_from(name.text);
    words.insert(words.end(), from.begin(), from.end());
    if (std::system((environment + " " + pasted(words) + " >/dev/null").c_str()) != 0)
      throw std::runtime_error(fmt::format("{}: a new process could not repeat the run", name.text));
    return read_hash_records(file.path()).front().hashes;
  }

  CaseWords cases_;
  EngineOptions engine_;
  StepOption steps_;
  DurationOption duration_;
  JobsOption jobs_;
  JsonOption json_;
  TimeoutOption timeout_;
  std::vector<std::string> changes_;
  std::string record_, against_;
};

}  // namespace

CommandRow repeat_row() {
  return {
      "repeat",
      "say which changes, that should not matter, change the bits of a run",
      "CASE",
      kCases,
      {{"rigor repeat contact/stack-of-ten --engine ode --dt 1/240", "the table of changes"},
       {"rigor repeat springs --engine core:rk4 --change lanes", "one change alone: each instruction set of the core"},
       {"rigor repeat springs --engine core:rk4 --record here.jsonl", "hashes to compare on another machine"},
       {"rigor repeat springs --engine core:rk4 --against here.jsonl", "exit code 1 if a bit differs"}},
      make_command<RepeatCommand>};
}

}  // namespace rigor::inline cli
