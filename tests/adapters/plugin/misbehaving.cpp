// A shared library that does one thing wrong, as RIGOR_MISBEHAVES says. It is built for the tests and is no test
// itself.
#include <unistd.h>

#include <csignal>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "adapters/plugin/rigor_engine.h"

namespace {

bool is(const char* mode) {
  const char* asked = std::getenv("RIGOR_MISBEHAVES");
  return asked && std::strcmp(asked, mode) == 0;
}

rigor_status say(rigor_text text, rigor_status status, const char* what) {
  std::snprintf(text.data, text.room, "%s", what);
  return status;
}

// When the library is loaded, before anybody has called it.
const int kOnLoad = [] {
  if (is("load-crashes")) std::raise(SIGSEGV);
  if (is("load-exits")) std::exit(5);
  if (is("load-hangs")) sleep(1000);
  return 0;
}();

rigor_status info(rigor_text text) {
  if (is("info-throws")) throw std::runtime_error("no");
  if (is("info-garbage")) return say(text, RIGOR_OK, "hello");
  if (is("info-fails")) return say(text, RIGOR_FAILED, "no licence");
  return say(
      text, RIGOR_OK,
      R"({"ok":true,"name":"bad-so","version":"1","precision":"double","features":[],"methods":[{"name":"m"}]})");
}

struct Still {
  double time = 0;
  int steps = 0;
  std::vector<char> hoard;
};

rigor_status load(const char*, const char*, rigor_world** world, rigor_text text) {
  if (is("unsupported")) return say(text, RIGOR_UNSUPPORTED, "no such thing");
  if (is("no-world")) return RIGOR_OK;
  *world = reinterpret_cast<rigor_world*>(new Still);
  return RIGOR_OK;
}

rigor_status step(rigor_world* world, double dt, const double*, rigor_text text) {
  auto* still = reinterpret_cast<Still*>(world);
  still->time += dt;
  if (++still->steps < 3) return RIGOR_OK;
  if (is("throws")) throw std::runtime_error("out of cheese");
  if (is("exits")) std::exit(0);
  if (is("memory")) still->hoard.resize(std::size_t{5} << 30);
  if (is("segfaults")) std::raise(SIGSEGV);
  if (is("fails")) return say(text, RIGOR_FAILED, "lost it");
  if (is("diverges")) return say(text, RIGOR_DIVERGED, "too fast");
  if (is("status")) return 17;
  if (is("long-text")) std::memset(text.data, 'x', text.room + 1);
  return RIGOR_OK;
}

rigor_status read_state(rigor_world* world, double* time, double* const columns[RIGOR_COLUMNS], rigor_text) {
  auto* still = reinterpret_cast<Still*>(world);
  *time = is("late") && still->steps >= 3 ? 0 : still->time;
  for (int c = 0; c < RIGOR_COLUMNS; ++c) {
    if (is("leaves-out") && c == 5) continue;
    columns[c][0] = c == 3;
  }
  if (still->steps < 3) return RIGOR_OK;
  if (is("overruns")) columns[7][1] = 0;
  if (is("underruns")) columns[7][-1] = 0;
  if (is("nan")) columns[2][0] = 0.0 / still->steps * (still->steps - still->steps) / 0.0;
  return RIGOR_OK;
}

// As many points as there are in 300 contacts, of 1 N each.
rigor_status contacts(rigor_world*, rigor_contact* into, size_t room, size_t* count, rigor_text text) {
  if (is("contacts-fail")) return say(text, RIGOR_FAILED, "no memory for them");
  *count = is("contacts-crowd") ? 5'000'000 : 300;
  const std::size_t written = is("contacts-overrun") ? room + 1 : room < 300 ? room : 300;
  for (std::size_t k = 0; k < written; ++k)
    into[k] = {0, 1, {double(k), 0, 0}, {0, 0, 1}, -1e-3, {0, 0, is("contacts-nan") ? 0.0 / double(k) : 1}};
  return RIGOR_OK;
}

// The time, in as many bytes as the mode asks for.
rigor_status save(rigor_world* world, unsigned char* bytes, size_t room, size_t* size, rigor_text text) {
  if (is("save-fails")) return say(text, RIGOR_FAILED, "no room for it");
  *size = is("save-crowds") ? 2'000'000'000 : is("save-grows") ? 2 * room : 10'000;
  if (is("save-overruns")) bytes[room] = 1;
  if (*size > room) return RIGOR_OK;
  std::memset(bytes, 0, *size);
  std::memcpy(bytes, &reinterpret_cast<Still*>(world)->time, sizeof(double));
  return RIGOR_OK;
}

rigor_status restore(rigor_world* world, const unsigned char* bytes, size_t size, rigor_text text) {
  if (size != 10'000 || is("save-unread")) return say(text, RIGOR_FAILED, "that is none of mine");
  std::memcpy(&reinterpret_cast<Still*>(world)->time, bytes, sizeof(double));
  return RIGOR_OK;
}

rigor_status unload(rigor_world* world, rigor_text) {
  delete reinterpret_cast<Still*>(world);
  return RIGOR_OK;
}

}  // namespace

extern "C" const rigor_engine_v1* rigor_engine_entry(uint32_t abi_major) {
  static rigor_engine_v1 engine = {
      sizeof(rigor_engine_v1), info, load, step, read_state, unload, nullptr, nullptr, nullptr};
  if (abi_major != RIGOR_ENGINE_ABI_MAJOR || is("other-abi")) return nullptr;
  if (std::getenv("RIGOR_MISBEHAVES") && std::strncmp(std::getenv("RIGOR_MISBEHAVES"), "contacts", 8) == 0)
    engine.contacts = contacts;
  if (is("contacts-old-struct")) engine.struct_size = offsetof(rigor_engine_v1, contacts);
  const bool saves = std::getenv("RIGOR_MISBEHAVES") && std::strncmp(std::getenv("RIGOR_MISBEHAVES"), "save", 4) == 0;
  if (saves) engine.save = save, engine.restore = restore;
  if (is("save-alone")) engine.restore = nullptr;
  if (is("save-old-struct")) engine.struct_size = offsetof(rigor_engine_v1, restore);
  if (is("small-struct")) engine.struct_size = 16;
  if (is("no-step")) engine.step = nullptr;
  return &engine;
}
