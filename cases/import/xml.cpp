#include "cases/import/xml.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "core/base/error.h"
#include "core/base/near_match.h"
#include "core/scene/toml/file_reader.h"

namespace rigor::inline imports {
namespace {

constexpr const char* kWhite = " \t\r\n";
// Nobody knows what an unknown element means, so it may change the motion.
const Reason kNotOfFormat = lost("is not of the format");

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(kWhite);
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(kWhite) - first + 1);
}

// Turns "XML_ERROR_MISMATCHED_ELEMENT" into words.
std::string error_in_words(std::string name) {
  for (const char* start : {"XML_ERROR_", "XML_"}) {
    if (name.starts_with(start)) name = name.substr(std::string(start).size());
  }
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c == '_' ? ' ' : static_cast<char>(std::tolower(c)); });
  return name;
}

// Returns the line of the first byte that is no UTF-8, or 0. The library does not check, and no case file may hold one.
long line_of_bad_utf8(const std::string& text) {
  long line = 1;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    line += byte == '\n';
    if (byte < 0x80) continue;
    const std::size_t more = byte >= 0xc2 && byte < 0xe0   ? 1
                             : (byte & 0xf0) == 0xe0       ? 2
                             : byte >= 0xf0 && byte < 0xf5 ? 3
                                                           : 0;
    if (more == 0 || i + more >= text.size()) return line;
    for (std::size_t k = 1; k <= more; ++k) {
      if ((static_cast<unsigned char>(text[i + k]) & 0xc0) != 0x80) return line;
    }
    const auto second = static_cast<unsigned char>(text[i + 1]);  // too long a form, a surrogate, beyond U+10FFFF
    if ((byte == 0xe0 && second < 0xa0) || (byte == 0xed && second > 0x9f) || (byte == 0xf0 && second < 0x90) ||
        (byte == 0xf4 && second > 0x8f))
      return line;
    i += more;
  }
  return 0;
}

const Reason* why_left_out(const XmlKnown& known, const std::string& word) {
  for (const auto& [name, why] : known.left_out) {
    if (name == word) return &why;
  }
  return nullptr;
}

bool is_one_of(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace

std::string XmlElement::name() const { return element_->Name(); }

std::string XmlElement::where() const { return fmt::format("{}:{}", *file_, element_->GetLineNum()); }

std::string XmlElement::described() const {
  if (const char* own = element_->Attribute("name")) return fmt::format("{} '{}'", name(), own);
  const tinyxml2::XMLNode* above = element_->Parent();
  for (; above && above->ToElement(); above = above->Parent()) {
    const tinyxml2::XMLElement* of = above->ToElement();
    if (const char* its = of->Attribute("name")) return fmt::format("{} '{}': <{}>", of->Name(), its, name());
  }
  return fmt::format("<{}>", name());
}

std::string XmlElement::place() const { return where() + ": " + described(); }

void XmlElement::refuse(const std::string& what) const { throw InputError(place() + ": " + what); }

std::optional<std::string> XmlElement::find(const std::string& attribute) const {
  const char* value = element_->Attribute(attribute.c_str());
  return value ? std::optional<std::string>(value) : std::nullopt;
}

std::string XmlElement::at(const std::string& attribute) const {
  const auto value = find(attribute);
  if (!value) refuse(fmt::format("there is no attribute '{}'", attribute));
  return *value;
}

std::string XmlElement::name_attribute() const {
  const std::string name = at("name");
  const bool is_bad =
      std::any_of(name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; });
  if (trimmed(name).empty() || is_bad) refuse("its name is empty or holds a control character");
  return name;
}

double XmlElement::one_number(const std::string& text, const std::string& what) const {
  const std::string word = trimmed(text);
  const char* first = word.data() + (word.starts_with('+') ? 1 : 0);
  double value = 0;
  const auto [end, error] = std::from_chars(first, word.data() + word.size(), value);
  const bool is_whole = end == word.data() + word.size() && error == std::errc();
  if (word.find("${") != std::string::npos)
    refuse(fmt::format("{}: found '{}', an expression of xacro; expand it first: xacro {} > robot.urdf", what, word,
                       std::filesystem::path(*file_).filename().string()));
  // from_chars also refuses numbers too small for a double; they count as 0.
  if (error == std::errc::result_out_of_range && std::abs(std::strtod(word.c_str(), nullptr)) < 1) return 0;
  if (!is_whole || !std::isfinite(value)) refuse(fmt::format("{}: found '{}'; allowed: a finite number", what, word));
  return value;
}

std::vector<double> XmlElement::numbers(const std::string& text, std::size_t count, const std::string& what) const {
  std::vector<double> values;
  for (std::size_t at = text.find_first_not_of(kWhite); at != std::string::npos;
       at = text.find_first_not_of(kWhite, at)) {
    const std::size_t end = std::min(text.find_first_of(kWhite, at), text.size());
    if (values.size() == count) refuse(fmt::format("{}: found more than {} numbers", what, count));
    values.push_back(one_number(text.substr(at, end - at), what));
    at = end;
  }
  if (values.size() != count) refuse(fmt::format("{}: found {} numbers; allowed: {}", what, values.size(), count));
  return values;
}

std::optional<double> XmlElement::find_number(const std::string& attribute) const {
  const auto value = find(attribute);
  return value ? std::optional<double>(one_number(*value, attribute)) : std::nullopt;
}

double XmlElement::number(const std::string& attribute) const { return one_number(at(attribute), attribute); }

std::vector<double> XmlElement::find_numbers(const std::string& attribute, std::size_t count) const {
  const auto value = find(attribute);
  return value ? numbers(*value, count, attribute) : std::vector<double>();
}

std::string XmlElement::text() const {
  const char* text = element_->GetText();
  return text ? trimmed(text) : "";
}

double XmlElement::number_of_text() const { return one_number(text(), "its text"); }

std::vector<double> XmlElement::numbers_of_text(std::size_t count) const { return numbers(text(), count, "its text"); }

bool XmlElement::flag_of_text() const {
  const std::string word = text();
  if (word == "true" || word == "1") return true;
  if (word == "false" || word == "0") return false;
  refuse(fmt::format("found '{}'; allowed: true, false", word));
}

std::vector<XmlElement> XmlElement::children() const {
  std::vector<XmlElement> all;
  for (const auto* child = element_->FirstChildElement(); child; child = child->NextSiblingElement())
    all.emplace_back(child, file_);
  return all;
}

std::vector<XmlElement> XmlElement::children(const std::string& name) const {
  std::vector<XmlElement> all;
  for (const auto* child = element_->FirstChildElement(name.c_str()); child;
       child = child->NextSiblingElement(name.c_str()))
    all.emplace_back(child, file_);
  return all;
}

std::optional<XmlElement> XmlElement::child(const std::string& name) const {
  const auto all = children(name);
  if (all.size() > 1) all[1].refuse(fmt::format("there is a second <{}>; allowed: one", name));
  return all.empty() ? std::nullopt : std::optional<XmlElement>(all.front());
}

XmlElement XmlElement::only(const std::string& name) const {
  const auto found = child(name);
  if (!found) refuse(fmt::format("there is no <{}>", name));
  return *found;
}

std::vector<std::pair<std::string, std::string>> XmlElement::attributes() const {
  std::vector<std::pair<std::string, std::string>> all;
  for (const auto* attribute = element_->FirstAttribute(); attribute; attribute = attribute->Next())
    all.emplace_back(attribute->Name(), attribute->Value());
  return all;
}

// `place` is that of the attribute or element. Returns false for an unknown word.
bool XmlElement::check_word(const std::string& word, const std::string& place, const std::string& what,
                            const std::vector<std::string>& words, const XmlKnown& known, LeftOut& left_out) const {
  if (const Reason* why = why_left_out(known, word)) return left_out.add(place, what, *why), true;
  if (word.starts_with("xacro:"))
    throw InputError(fmt::format("{}: <{}> is a macro of xacro; expand it first: xacro {} > robot.urdf", place, word,
                                 std::filesystem::path(*file_).filename().string()));
  if (word.starts_with("xmlns")) return true;
  if (word.find(':') != std::string::npos)
    return left_out.add(place, what, lost("belongs to an extension of the format")), true;
  std::vector<std::string> all = words;
  for (const auto& row : known.left_out) all.push_back(row.first);
  const std::string meant = did_you_mean(word, all);
  if (!meant.empty()) throw InputError(fmt::format("{}: {} is not of the format{}", place, what, meant));
  left_out.add(place, what, kNotOfFormat);
  return false;
}

void XmlElement::check(const XmlKnown& known, LeftOut& left_out) const {
  std::vector<std::string> met;
  for (const auto& [word, value] : attributes()) {
    if (is_one_of(met, word)) refuse(fmt::format("the attribute '{}' is given twice", word));
    met.push_back(word);
    if (!is_one_of(known.attributes, word))
      check_word(word, place(), "attribute '" + word + "'", known.attributes, known, left_out);
  }
  std::string unknown;  // the last unknown element: a million of the same need no search each
  for (const XmlElement& child : children()) {
    const std::string word = child.name();
    if (is_one_of(known.elements, word)) continue;
    const std::string of = child.where() + ": " + described(), what = "<" + word + ">";
    if (word == unknown) {
      left_out.add(of, what, kNotOfFormat);
    } else if (!check_word(word, of, what, known.elements, known, left_out)) {
      unknown = word;
    }
  }
}

XmlFile::XmlFile(const std::string& path) : path_(path), document_(std::make_unique<tinyxml2::XMLDocument>()) {
  const std::string text = read_text_file(path);
  size_ = text.size();
  if (size_ > kLargestModel)
    throw InputError(
        fmt::format("{}:1: is larger than {} MiB, the largest model that is read", path, kLargestModel >> 20));
  if (const long line = line_of_bad_utf8(text))
    throw InputError(fmt::format("{}:{}: found bytes that are not UTF-8", path, line));
  if (const std::size_t at = text.find('\0'); at != std::string::npos)
    throw InputError(fmt::format("{}:{}: found a zero byte", path,
                                 1 + std::count(text.begin(), text.begin() + static_cast<long>(at), '\n')));
  const tinyxml2::XMLError found = document_->Parse(text.data(), text.size());
  if (found == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED)
    throw InputError(fmt::format("{}:{}: found elements nested deeper than {}, which is as deep as any is read", path,
                                 std::max(1, document_->ErrorLineNum()), TINYXML2_MAX_ELEMENT_DEPTH));
  if (found != tinyxml2::XML_SUCCESS) {
    throw InputError(fmt::format("{}:{}: is not XML: {}", path, std::max(1, document_->ErrorLineNum()),
                                 error_in_words(document_->ErrorName())));
  }
  const tinyxml2::XMLElement* root = nullptr;
  for (const auto* node = document_->FirstChild(); node; node = node->NextSibling()) {
    if (node->ToUnknown())
      throw InputError(fmt::format("{}:{}: found a document type; allowed: none, for it may define entities", path,
                                   node->GetLineNum()));
    if (node->ToElement() && root)
      throw InputError(fmt::format("{}:{}: found a second element at the top; allowed: one", path, node->GetLineNum()));
    if (node->ToElement()) root = node->ToElement();
  }
  if (!root) throw InputError(fmt::format("{}:1: there is no element in it", path));
}

XmlFile::~XmlFile() = default;

XmlElement XmlFile::root() const { return {document_->RootElement(), &path_}; }

}  // namespace rigor::inline imports
