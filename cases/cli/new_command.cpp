// rigor new: writes a case file that runs, with a comment on each line.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "cases/report/wording/printed_command.h"
#include "core/base/error.h"

namespace rigor::inline cli {
namespace {

constexpr const char* kCase =
    R"(# A case: a scene, how to run it, what is true of it, and what a run must keep. SI units; every key is explained in
# cases/README.md and, where an editor knows TOML's schemas, in cases/case/case.schema.json.
title  = "{}: a weight on a spring"
source = "where the case comes from: a book, a paper, a measurement"

[scene]
gravity = [0, -9.81, 0]       # m/s²

[[scene.body]]
name = "weight"
mass = 2                      # kg
shape = {{ type = "box", size = [0.1, 0.1, 0.1] }}   # m; also sphere {{ radius }}, capsule {{ radius, length }}, plane {{ normal, offset }}
collides = false              # nothing here to touch
position = [0, -0.5, 0]       # m, of its centre of mass
# velocity = [0, 0, 0]        # m/s
# angular_velocity = [0, 0, 0]   # rad/s

[[scene.spring]]
a = "world"                   # or a body's name
point_a = [0, 0, 0]           # m, in a's frame
b = "weight"
stiffness = 200               # N/m
# damping = 1                 # N s/m
rest_length = 0.4             # m

[run]
duration = 5                  # s
dt = ["1/30", "1/240", "1/1000"]   # s

[truth]
kind = "reference"            # rigor list truths; without this table only conservation is judged

[[gate]]                      # what `rigor gate` holds runs to; any number of them
metric  = "position_error"    # rigor list metrics; m
engines = ["core:rk4"]        # absent: every engine that can express the scene
dt      = ["1/240"]           # absent: every dt of the run
max     = 1e-6
because = "why this bound: what was measured or derived, and the margin"
)";

std::string file_of(const std::string& name) { return name.ends_with(".toml") ? name : name + ".toml"; }

// Returns the last part of a path without its ending.
std::string title_of(const std::string& file) {
  const std::string last = file.substr(file.rfind('/') + 1);
  return last.substr(0, last.size() - std::strlen(".toml"));
}

void check_name(const std::string& title) {
  const bool is_bad = title.empty() || title.find_first_of("\"\\\n\r\t") != std::string::npos;
  if (is_bad) throw InputError("rigor new: the name is empty or holds a quote, a backslash or a control character");
}

class NewCommand : public Command {
 public:
  void declare(Options& options) override { options.add_words(words_); }

  int run(const Invocation&) override {
    if (words_.size() != 1) throw InputError("rigor new: takes one name, as my-case, for the file my-case.toml");
    const std::string file = file_of(words_.front()), title = title_of(file);
    check_name(title);
    // Never overwrites a file.
    const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0)
      throw InputError(fmt::format("rigor new: {}: {}; give another name", file, std::strerror(errno)));
    const std::string text = fmt::format(kCase, title);
    const ssize_t written = write(descriptor, text.data(), text.size());
    const int failure = errno;
    if (close(descriptor) != 0 || written != static_cast<ssize_t>(text.size()))
      throw std::runtime_error(fmt::format("{} was not written whole: {}", file, std::strerror(failure)));
    const std::string next =
        pasted({"rigor", "run", file, "--engine", "ode", "--engine", "bullet", "--engine", "core:rk4"});
    say(fmt::format("{} is written; next: {}", file, next));
    return kGood;
  }

 private:
  std::vector<std::string> words_;
};

}  // namespace

CommandRow new_row() {
  return {"new",
          "write a case file that runs, with a comment on each line",
          "NAME",
          "name of the case, as my-case",
          {{"rigor new my-case", "write my-case.toml"}, {"rigor new cases/pendulum", "write cases/pendulum.toml"}},
          make_command<NewCommand>};
}

}  // namespace rigor::inline cli
