// The laboratory's calls: JSON in, JSON and columns of numbers out. They know no browser: a page calls them in
// WebAssembly, a test natively.
//
//   {"call":"engine","command":C,"info":{…}}   adds an engine from outside, a process C; without "info" it is asked
//   {"call":"methods"}                         the core's methods and the engines from outside, with options
//   {"call":"read","path":P,"text":T}          what a case file holds: scene, duration, knobs, what methods lack
//   {"call":"import","path":P,"ground":B}      a robot's file as the text of a case file, and the notes of the import
//   {"call":"load", …,"run":R,"dt":D}          makes the run of this instance anew; its settings
//   {"call":"step","count":N}                  numbers: a reading for each step, then the poses after the last
//   {"call":"readings","from":K}               numbers: all readings from step K on
//   {"call":"truth", …,"dt":D}                 numbers: the truth's table; with "provisional":true the stand-in
//   {"call":"compare", header of "truth"}      takes that table from the room for numbers
//   {"call":"judge","brief":B}                 verdict and metrics of the run so far; B: without what takes seconds
//   {"call":"explain", …,"dt":D,"runs":[…]}    sentences on the runs, of which each has its answer of "judge"
//   {"call":"hashes", …,"run":R,"dt":D,"steps":N}   the hash of each state, as `rigor repeat --record` writes it
//
// … stands for "path", "text" and the optional "knobs":{…}. D is written as in case files: "1/30". Every answer has
// "ok"; a false one has "why".
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/engines.h"
#include "core/base/json_fwd.h"

namespace rigor::inline laboratory {

class Experiment;

class LaboratoryCalls {
 public:
  LaboratoryCalls();
  ~LaboratoryCalls();

  // Never throws.
  std::string answer(std::string_view request);
  // Of the last answer; also the room for those of the next call.
  std::vector<double>& numbers() { return numbers_; }

 private:
  struct Request;
  Json answer_to(const Request& request);
  Json compare(const Request& request);
  Json engine(const Request& request);
  Json explain(const Request& request);
  Json hashes(const Request& request);
  Json import(const Request& request);
  Json judge(const Request& request);
  Json load(const Request& request);
  Json methods(const Request& request);
  Json read(const Request& request);
  Json readings(const Request& request);
  Json step(const Request& request);
  Json truth(const Request& request);
  Experiment& loaded() const;  // throws InputError before the first "load"

  EngineTable engines_ = built_in_engines();
  std::unique_ptr<Experiment> experiment_;
  std::vector<double> numbers_, given_;  // of the answer, and of the request
};

}  // namespace rigor::inline laboratory
