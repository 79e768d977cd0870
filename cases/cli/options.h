// Declares the words and options of a command. Help, completions, the manual and the reference show what is declared.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace rigor::inline cli {

struct OptionFact {
  std::string name;  // "--dt"
  std::string type;  // "DT"; empty for a flag
  std::string meaning;
  std::vector<std::string> choices = {};  // for completions; empty: any text
};

// A command declares each option with the place of its value. Values are read once the whole line is known to be good.
class Options {
 public:
  enum class Repeats { no, yes };
  struct Row {
    OptionFact fact;
    Repeats repeats;
    std::function<void(const std::string& text)> read;  // called for each value; for a flag with ""
  };

  explicit Options(int default_jobs) : default_jobs_(default_jobs) {}

  void add_words(std::vector<std::string>& words) { words_ = &words; }
  void add_flag(const std::string& name, const std::string& meaning, bool& value);
  void add(const OptionFact& fact, std::string& value);
  void add(OptionFact fact, std::vector<std::string>& values);  // may be repeated
  void add(OptionFact fact, std::function<void(const std::string&)> read, Repeats repeats = Repeats::no);
  // For what follows from several values, as a default folder that must not stop --help.
  void after_reading(std::function<void()> act) { after_reading_.push_back(std::move(act)); }
  // Not called for a command line that is only read, as `rigor merge` reads that of its parts.
  void before_run(std::function<void()> act) { before_run_.push_back(std::move(act)); }

  int default_jobs() const { return default_jobs_; }
  std::vector<std::string>* words() const { return words_; }
  const std::vector<Row>& rows() const { return rows_; }
  void end_reading() const;
  void prepare_run() const;

 private:
  int default_jobs_;
  std::vector<std::string>* words_ = nullptr;
  std::vector<Row> rows_;
  std::vector<std::function<void()>> after_reading_, before_run_;
};

// Reads a whole number from 1 on. Throws InputError, which names the option.
int parse_count(const std::string& text, const std::string& option, int most = 100000);

// "a, b or c".
std::string either_of(const std::vector<std::string>& names);

}  // namespace rigor::inline cli
