// Models read as a test needs them: the scene that the case file of an import says.
#pragma once

#include "cases/case/case_reader.h"
#include "cases/import/import.h"
#include "core/base/error.h"
#include "tests/cases/vocabulary.h"
#include "tests/folder.h"

namespace rigor::test {

inline Scene scene_of_file(const std::string& path) {
  return read_case_text(case_text_of(import_model(path)), path, path, words()).scene;
}

inline Scene scene_of_text(const std::string& name, const std::string& text) {
  const Folder folder;
  return scene_of_file(folder.write(name, text));
}

// "file:line: element: what: why" for each place.
inline std::vector<std::string> sentences_of(const std::vector<Loss>& losses) {
  std::vector<std::string> all;
  for (const Loss& loss : losses) {
    for (const std::string& place : loss.places) all.push_back(place + ": " + loss.what + ": " + loss.why);
  }
  return all;
}

inline std::vector<std::string> left_out_of_model(const std::string& name, const std::string& text) {
  const Folder folder;
  return sentences_of(import_model(folder.write(name, text)).losses);
}

// The losses of physics alone.
inline std::vector<std::string> physics_lost(const std::string& name, const std::string& text) {
  const Folder folder;
  return sentences_of(losses_of(import_model(folder.write(name, text)).losses, LossKind::physical));
}

// The message without the folder's path; "" where it is taken.
inline std::string refusal_of(const std::string& name, const std::string& text) {
  const Folder folder;
  try {
    import_model(folder.write(name, text));
  } catch (const InputError& error) {
    std::string what = error.what();
    for (std::size_t at; (at = what.find(folder.path.string() + "/")) != std::string::npos;)
      what.erase(at, folder.path.string().size() + 1);
    return what;
  }
  return "";
}

inline bool some_has(const std::vector<std::string>& sentences, const std::string& part) {
  return std::any_of(sentences.begin(), sentences.end(),
                     [&](const std::string& s) { return s.find(part) != std::string::npos; });
}

inline const Body& body_named(const Scene& scene, const std::string& name) {
  for (const Body& body : scene.bodies) {
    if (body.name == name) return body;
  }
  throw std::runtime_error("no body is called " + name);
}

inline const Joint& joint_named(const Scene& scene, const std::string& name) {
  for (const Joint& joint : scene.joints) {
    if (joint.name == name) return joint;
  }
  throw std::runtime_error("no joint is called " + name);
}

}  // namespace rigor::test
