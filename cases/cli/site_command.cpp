// rigor site: turns the results of runs into a static web site.
#include <fmt/format.h>

#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "cases/report/site/site.h"
#include "core/base/error.h"

namespace rigor::inline cli {
namespace {

class SiteCommand : public Command {
 public:
  void declare(Options& options) override {
    options.add_words(inputs_);
    options.add({"--out", "DIR", "the folder of the site, which is replaced as a whole; default: site"}, out_);
  }

  int run(const Invocation&) override {
    if (inputs_.empty())
      throw InputError("rigor site: takes the folders that 'rigor run' or 'rigor gate' wrote, the oldest first");
    return write();
  }

 private:
#if RIGOR_HTML_REPORT
  int write() const {
    std::vector<std::string> notes;
    const std::vector<SiteFile> files = site_files(inputs_, notes);
    write_site(out_, files);
    for (const std::string& note : notes) say(note);
    std::size_t bytes = 0;
    for (const SiteFile& file : files) bytes += file.text.size();
    say(fmt::format("{} files of {:.1f} MB are in {}; open {}/index.html", files.size(),
                    1e-6 * static_cast<double>(bytes), out_, out_));
    return kGood;
  }
#else
  int write() const {
    throw InputError(
        "rigor site: this build has no HTML report, whose page the site shows; configure with -DRIGOR_HTML_REPORT=ON");
  }
#endif

  std::vector<std::string> inputs_;
  std::string out_ = "site";
};

}  // namespace

CommandRow site_row() {
  return {"site",
          "make a static web site of results: engines by families, pages, badges and JSON",
          "DIR",
          "folders of 'rigor run' or 'rigor gate', the oldest first, and files of 'rigor history'",
          {{"rigor site out --out site", "the site of one run"},
           {"rigor site history.jsonl out", "with the history of its engines"},
           {"rigor site old new", "two versions of an engine; the steps of its errors are marked"}},
          make_command<SiteCommand>};
}

}  // namespace rigor::inline cli
