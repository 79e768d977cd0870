#include "adapters/plugin/plugin_info.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "adapters/plugin/answer.h"
#include "adapters/plugin/in_quotes.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/near_match.h"
#include "core/engine/run_name.h"

namespace rigor::inline adapters {
namespace {

// A table of the info, and the name by which messages call it: "methods[0]".
class InfoTable {
 public:
  InfoTable(const Json& json, std::string what, std::string path)
      : json_(json), what_(std::move(what)), path_(std::move(path)) {
    if (!json_.is_object()) refuse("", json_, "an object");
  }

  std::string text(const char* key) const {  // must be there
    const Json* found = find(key);
    if (!found || !found->is_string() || found->get<std::string>().empty()) refuse(key, found, "a text");
    return checked(key, found->get<std::string>());
  }
  std::string text(const char* key, const std::string& otherwise) const { return find(key) ? text(key) : otherwise; }
  bool flag(const char* key) const {
    const Json* found = find(key);
    if (found && !found->is_boolean()) refuse(key, found, "true or false");
    return found && found->get<bool>();
  }
  double number(const char* key, double least, double otherwise) const {
    const Json* found = find(key);
    if (!found) return otherwise;
    if (!found->is_number() || found->get<double>() < least)
      refuse(key, found, fmt::format("a number of at least {}", least));
    return found->get<double>();
  }
  std::vector<std::string> texts(const char* key) const {
    std::vector<std::string> out;
    for (const Json* item : list(key)) {
      if (!item->is_string()) refuse(key, item, "a list of texts");
      out.push_back(checked(key, item->get<std::string>()));
    }
    return out;
  }
  std::vector<InfoTable> tables(const char* key) const {
    std::vector<InfoTable> out;
    for (const Json* item : list(key)) out.emplace_back(*item, what_, fmt::format("{}[{}]", name_of(key), out.size()));
    return out;
  }
  // A part of a run's name: nothing in it by which such a name is taken apart.
  std::string name(const char* key) const {
    const std::string text_found = text(key);
    const auto is_plain = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' ||
             c == '.';
    };
    if (text_found.size() > 64 || !std::all_of(text_found.begin(), text_found.end(), is_plain))
      refuse(key, find(key), "up to 64 letters, digits, '-', '_' and '.'");
    return text_found;
  }
  [[noreturn]] void refuse(const char* key, const Json* found, const std::string& allowed) const {
    const std::string shown =
        found ? in_quotes(found->dump(-1, ' ', false, Json::error_handler_t::replace)) : std::string("nothing");
    throw InputError(
        fmt::format("{}: its info is not one: {}: found {}; allowed: {}", what_, name_of(key), shown, allowed));
  }
  [[noreturn]] void refuse(const char* key, const Json& found, const std::string& allowed) const {
    refuse(key, &found, allowed);
  }
  // What is null is not there.
  const Json* find(const char* key) const {
    const auto found = json_.find(key);
    return found == json_.end() || found->is_null() ? nullptr : &*found;
  }

 private:
  std::string name_of(const char* key) const {
    const std::string name = !*key ? path_ : path_.empty() ? key : path_ + "." + key;
    return name.empty() ? "the answer" : name;
  }
  std::vector<const Json*> list(const char* key) const {
    const Json* found = find(key);
    if (found && !found->is_array()) refuse(key, found, "a list");
    std::vector<const Json*> items;
    for (std::size_t n = 0; found && n < found->size(); ++n) items.push_back(&(*found)[n]);
    return items;
  }
  // It ends up in tables and file names.
  std::string checked(const char* key, const std::string& text_found) const {
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; };
    if (text_found.size() > 4096 || std::any_of(text_found.begin(), text_found.end(), is_control))
      refuse(key, find(key), "texts of one line");
    return text_found;
  }

  const Json& json_;
  std::string what_, path_;
};

// A choice, or a number in the range. A text in place of a number is a rule.
OptionDefault read_default(const InfoTable& table, const char* key, const OptionInfo& option) {
  const Json* found = table.find(key);
  if (!option.choices.empty()) {
    const std::string word = table.text(key);
    if (std::find(option.choices.begin(), option.choices.end(), word) == option.choices.end())
      table.refuse(key, found, listed(option.choices));
    return word;
  }
  if (found->is_string()) return DefaultRule{table.text(key)};
  const double number = table.number(key, option.min, 0);
  if (number > option.max || (option.whole && number != std::floor(number)))
    table.refuse(key, found,
                 fmt::format("a {} from {} to {}", option.whole ? "whole number" : "number", option.min, option.max));
  return number;
}

OptionInfo read_option(const InfoTable& table) {
  OptionInfo option{.name = table.name("name"), .meaning = table.text("meaning", "")};
  option.choices = table.texts("choices");
  if (option.choices.empty()) {
    constexpr double kMost = 1e300;
    option.min = table.number("min", -kMost, -kMost), option.max = table.number("max", -kMost, kMost);
    option.whole = table.flag("whole");
    if (option.max < option.min) table.refuse("max", table.find("max"), "no less than min");
  }
  if (table.find("default")) option.by_default = read_default(table, "default", option);
  if (table.find("stock_default")) option.as_shipped = read_default(table, "stock_default", option);
  return option;
}

MethodInfo read_method(const InfoTable& table) {
  MethodInfo method{.name = table.name("name"), .summary = table.text("summary", "as its author made it")};
  const double order = table.number("order", 1, 1);
  if (order != static_cast<int>(order) || order > 20)
    table.refuse("order", table.find("order"), "a whole number from 1 to 20");
  method.order = static_cast<int>(order);
  method.symplectic = table.flag("symplectic"), method.symmetric = table.flag("symmetric");
  method.adaptive = table.flag("adaptive");
  method.leapfrog_stagger = table.number("leapfrog_stagger", 0, 0);
  if (method.leapfrog_stagger > 1)
    table.refuse("leapfrog_stagger", table.find("leapfrog_stagger"), "a number from 0 to 1");
  for (const InfoTable& option : table.tables("options")) method.options.push_back(read_option(option));
  return method;
}

std::vector<MethodInfo> read_methods(const InfoTable& table) {
  std::vector<MethodInfo> methods;
  for (const InfoTable& row : table.tables("methods")) {
    methods.push_back(read_method(row));
    const auto is_same = [&](const MethodInfo& other) { return other.name == methods.back().name; };
    if (std::count_if(methods.begin(), methods.end(), is_same) > 1)
      row.refuse("name", row.find("name"), "a name that no other method has");
  }
  if (methods.empty()) table.refuse("methods", table.find("methods"), "a list of at least one method");
  return methods;
}

// The two shapes of a contact may come in either order.
std::optional<Feature> declared_feature(const std::string& word) {
  const std::string start = "contact:";
  const std::size_t hyphen = word.find('-');
  if (!word.starts_with(start) || hyphen == std::string::npos) return feature_of(word);
  const std::string first = word.substr(start.size(), hyphen - start.size()), second = word.substr(hyphen + 1);
  return feature_of(start + std::min(first, second) + "-" + std::max(first, second));
}

// Forces and torques on the bodies are all that these need. An engine that computes springs itself says whether it
// knows those whose stiffness grows.
Features with_wrenches(Features features) {
  if (!features.contains(Feature::wrench)) return features;
  if (!features.contains(Feature::spring) && !features.contains(Feature::joint_spring))
    features.insert(Feature::quadratic_spring);
  features.insert({Feature::spring, Feature::timed_force});
  if (std::any_of(features.begin(), features.end(), is_joint))
    features.insert({Feature::joint_damper, Feature::joint_spring, Feature::joints_with_dampers, Feature::motor_effort,
                     Feature::motor_servo, Feature::motor_servo_of_several_joints, Feature::motor_table});
  return features;
}

Json answer_to_info(const std::string& line, const std::string& what) {
  try {
    return parsed_answer(line, {what, "info"});
  } catch (const EngineFailure& failure) {
    throw InputError(failure.what());
  }
}

}  // namespace

PluginInfo read_plugin_info(const std::string& line, const std::string& what) {
  const Json answer = answer_to_info(line, what);
  const InfoTable table(answer, what, "");
  if (table.number("rigor", 0, kProtocolVersion) != kProtocolVersion)
    table.refuse("rigor", table.find("rigor"), fmt::format("{}, the version of the protocol", kProtocolVersion));
  PluginInfo info;
  info.engine.name = table.name("name"), info.engine.version = table.text("version");
  info.engine.precision = table.text("precision");
  if (info.engine.precision != "double" && info.engine.precision != "single")
    table.refuse("precision", table.find("precision"), "\"double\" or \"single\"");
  for (const std::string& word : table.texts("features")) {
    if (const auto feature = declared_feature(word))
      info.declared.insert(*feature);
    else
      info.engine.unknown_features.push_back(word);
  }
  info.engine.features = with_wrenches(info.declared);
  info.engine.methods = read_methods(table);
  const std::vector<std::string> calls = table.texts("calls");
  const auto answers = [&](const char* call) { return std::find(calls.begin(), calls.end(), call) != calls.end(); };
  info.can_run = answers("run"), info.has_contacts = answers("contacts");
  info.has_reactions = answers("reactions");
  info.has_state = answers("save") && answers("restore");
  info.has_columns = table.find("columns") != nullptr;
  if (info.has_columns && table.text("columns") != "f64le")
    table.refuse("columns", table.find("columns"), "\"f64le\", or no such key");
  return info;
}

Scene loads_left_to_rigor(Scene scene, const PluginInfo& info) {
  const auto does = [&](Feature feature) { return info.declared.contains(feature); };
  const bool gets_wrenches = does(Feature::wrench);
  if (does(Feature::spring) || !gets_wrenches) scene.springs.clear();
  if (does(Feature::timed_force) || !gets_wrenches) scene.forces.clear();
  std::erase_if(scene.motors, [&](const Motor& motor) { return !gets_wrenches || does(feature_of(motor)); });
  for (Joint& joint : scene.joints) {
    if (does(Feature::joint_spring) || !gets_wrenches) joint.stiffness = joint.quadratic_stiffness = 0;
    if (does(Feature::joint_damper) || !gets_wrenches) joint.damping = 0;
  }
  return scene;
}

std::string settings_json(const PluginInfo& info, const Settings& settings) {
  Json json = {{"method", settings.method},
               {"track", settings.track == Track::matched ? "matched" : "stock"},
               {"options", Json::object()}};
  for (const OptionInfo& option : method_of(info.engine, settings).options) {
    const auto value = settings.options.find(option.name);
    if (value == settings.options.end()) continue;
    const bool is_number = option.choices.empty();
    json["options"][option.name] = is_number ? Json(std::strtod(value->second.c_str(), nullptr)) : Json(value->second);
  }
  return json.dump();
}

}  // namespace rigor::inline adapters
