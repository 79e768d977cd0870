#include "adapters/plugin/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "adapters/plugin/in_quotes.h"
#include "core/base/json.h"

namespace rigor::inline adapters {
namespace {

std::string dumped(const Json& value) { return value.dump(-1, ' ', false, Json::error_handler_t::replace); }

// The message's own words, whatever the engine wrote there.
std::string text_of(const Json& answer, const char* key, const std::string& otherwise) {
  const auto found = answer.find(key);
  return found != answer.end() && found->is_string() ? found->get<std::string>() : otherwise;
}

std::string said_at(const Json& answer) {
  const auto time = answer.find("time");
  return time != answer.end() && time->is_number() ? fmt::format(" at {:.6g} s", time->get<double>()) : "";
}

[[noreturn]] void report_refusal(const Json& answer, const Question& asked) {
  const std::string status = text_of(answer, "status", ""),
                    why = in_quotes(text_of(answer, "why", "no reason given"), 400);
  if (status == "unsupported")
    throw EngineFailure(FailureKind::unsupported, fmt::format("{} says so itself: {}", asked.engine, why));
  if (status == "failed")
    throw EngineFailure(FailureKind::crashed,
                        fmt::format("{} says that '{}' failed{}: {}", asked.engine, asked.call, said_at(answer), why));
  if (status == "diverged") {
    const auto body = answer.find("body");
    throw EngineDiverged(fmt::format("{} says that it diverged{}: {}", asked.engine, said_at(answer), why),
                         body != answer.end() && body->is_number_unsigned() ? body->get<int>() : 0);
  }
  refuse_answer(asked, fmt::format("its status is {}; allowed: unsupported, diverged, failed", in_quotes(status)));
}

// A key that an answer need not carry, but not with another value than the request's.
void check_echo(const Json& answer, const char* key, const Json& due, const Question& asked) {
  const auto found = answer.find(key);
  if (found != answer.end() && *found != due)
    refuse_answer(asked, fmt::format("its {} is {}, and {} was asked", key, in_quotes(dumped(*found)), dumped(due)));
}

// One of a list that an answer holds. `what`: how messages call it.
struct ListEntry {
  const Json& json;
  std::string what;
  const Question& asked;

  [[noreturn]] void refuse(const char* key, const char* due) const {
    refuse_answer(asked, fmt::format("{} of {} is {}; {} is due", key, what,
                                     find(key) ? in_quotes(dumped(*find(key))) : "not there", due));
  }
  const Json* find(const char* key) const {
    const auto found = json.find(key);
    return json.is_object() && found != json.end() ? &*found : nullptr;
  }
  int body(const char* key) const {
    const Json* found = find(key);
    if (!found || !found->is_number_integer()) refuse(key, "the number of a body");
    return found->get<int>();
  }
  double number(const char* key) const {
    const Json* found = find(key);
    if (!found || !found->is_number()) refuse(key, "a finite number");
    return found->get<double>();
  }
  Vec3 vector(const char* key) const {
    const Json* found = find(key);
    const bool is_vector = found && found->is_array() && found->size() == 3 && (*found)[0].is_number() &&
                           (*found)[1].is_number() && (*found)[2].is_number();
    if (!is_vector) refuse(key, "a list of three finite numbers");
    return {(*found)[0].get<double>(), (*found)[1].get<double>(), (*found)[2].get<double>()};
  }
};

const Json& list_in(const Json& answer, const char* key, const Question& asked) {
  const auto list = answer.find(key);
  if (list == answer.end() || !list->is_array()) refuse_answer(asked, fmt::format("its {} are no list", key));
  return *list;
}

}  // namespace

void refuse_answer(const Question& asked, const std::string& fault) {
  throw EngineFailure(FailureKind::invalid,
                      fmt::format("{} gave no answer to '{}': {}", asked.engine, asked.call, fault));
}

Json parsed_answer(const std::string& line, const Question& asked) {
  Json answer;
  try {
    answer = parse_json(line);
  } catch (const Json::exception&) {
    refuse_answer(asked, fmt::format("the line {} is not JSON", in_quotes(line)));
  }
  if (!answer.is_object()) refuse_answer(asked, fmt::format("the line {} is not an object", in_quotes(line)));
  const auto ok = answer.find("ok");
  if (ok == answer.end() || !ok->is_boolean())
    refuse_answer(asked, fmt::format("the line {} has no \"ok\" that is true or false", in_quotes(line)));
  if (asked.world) check_echo(answer, "world", *asked.world, asked);
  check_echo(answer, "call", asked.call, asked);
  if (!ok->get<bool>()) report_refusal(answer, asked);
  return answer;
}

void read_bodies(const Json& answer, const Question& asked, MutableBodyColumns into) {
  const auto bodies = answer.find("bodies");
  if (bodies == answer.end() || !bodies->is_array() || bodies->size() != into.size()) {
    refuse_answer(asked, fmt::format("its bodies are {}; a list of {} is due, in the scene's order",
                                     bodies == answer.end() ? "not there"
                                     : bodies->is_array()   ? fmt::format("{}", bodies->size())
                                                            : in_quotes(dumped(*bodies)),
                                     into.size()));
  }
  for (std::size_t i = 0; i < into.size(); ++i) {
    const Json& row = (*bodies)[i];
    if (!row.is_array() || row.size() != kColumnNames.size())
      refuse_answer(asked, fmt::format("body {} is {}; thirteen numbers are due", i, in_quotes(dumped(row))));
    for (int c = 0; c < 13; ++c) {
      const Json& number = row[static_cast<std::size_t>(c)];
      if (!number.is_number())
        refuse_answer(asked, fmt::format("{} of body {} is {}; a finite number is due", kColumnNames[c], i,
                                         in_quotes(dumped(number))));
      into.column(c)[i] = number.get<double>();
    }
  }
}

std::vector<ReportedContact> read_contacts(const Json& answer, const Question& asked) {
  std::vector<ReportedContact> contacts;
  for (const Json& json : list_in(answer, "contacts", asked)) {
    const ListEntry entry{json, fmt::format("contact {}", contacts.size()), asked};
    contacts.push_back({entry.body("a"), entry.body("b"), entry.vector("point"), entry.vector("normal"),
                        entry.number("gap"), entry.vector("force")});
  }
  return contacts;
}

std::vector<ReportedReaction> read_reactions(const Json& answer, const Question& asked, std::size_t joints,
                                             std::size_t bodies) {
  const Json& list = list_in(answer, "reactions", asked);
  if (list.size() != joints)
    refuse_answer(asked, fmt::format("its reactions are {}; one for each of {} joints is due", list.size(), joints));
  std::vector<ReportedReaction> reactions;
  for (const Json& json : list) {
    const ListEntry entry{json, fmt::format("reaction {}", reactions.size()), asked};
    reactions.push_back({entry.body("body"), entry.vector("force"), entry.vector("torque")});
    const int body = reactions.back().body;
    if (body < 0 || static_cast<std::size_t>(body) >= bodies) entry.refuse("body", "the number of a body");
  }
  return reactions;
}

void check_time(const Json& answer, const Question& asked, double due, double dt) {
  const auto time = answer.find("time");
  if (time == answer.end() || !time->is_number())
    refuse_answer(asked, fmt::format("its time is {}; a finite number is due",
                                     time == answer.end() ? "not there" : in_quotes(dumped(*time))));
  check_time(time->get<double>(), asked, due, dt);
}

bool is_time(double time, double due, double dt) {
  // A clock that adds up steps in single precision is a few parts in a million off, an answer to another request a
  // step.
  constexpr double kOfSinglePrecision = 1e-5, kOfAStep = 1e-3;
  return std::abs(time - due) <= kOfAStep * dt + kOfSinglePrecision * due;
}

void check_time(double time, const Question& asked, double due, double dt) {
  if (is_time(time, due, dt)) return;
  refuse_answer(asked,
                fmt::format("its time is {:.17g} s; after the steps that it was asked for it is {:.17g} s", time, due));
}

}  // namespace rigor::inline adapters
