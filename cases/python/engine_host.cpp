// An engine of Python as a shared library behind rigor_engine.h. Python runs inside the cell's process. The library is
// copied once for each engine; the file of the same name that ends in .json says which class it loads (engines.py).
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <pybind11/embed.h>
#include <pybind11/numpy.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <atomic>
#include <cfenv>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>

#include "adapters/plugin/rigor_engine.h"

#ifdef __SSE__
#include <xmmintrin.h>
#endif

namespace py = pybind11;

// The engine's world, and what a call of it needs. Its objects are touched only with Python's lock.
struct rigor_world {
  py::object host_world, step, read, check_state, contacts;
  std::size_t bodies = 0;
  double begin = 0, dt = 0;  // [s]: since `begin`, `count` steps of dt
  long count = 0;
  std::atomic_flag is_busy = ATOMIC_FLAG_INIT;

  double time() const { return begin + static_cast<double>(count) * dt; }
};

namespace rigor::python {
namespace {

constexpr int kExitOfFork = 70;

void write(rigor_text text, const std::string& what) {
  if (text.room > 0) std::snprintf(text.data, text.room, "%s", what.c_str());
}

std::string path_of_library() {
  Dl_info info{};
  if (!dladdr(reinterpret_cast<const void*>(&rigor_engine_entry), &info) || !info.dli_fname) return "";
  return info.dli_fname;
}

std::string path_of_specification() {
  const std::string path = path_of_library();
  return path.substr(0, path.rfind(".so")) + ".json";
}

std::string text_of_specification() {
  std::ifstream file(path_of_specification());
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

// The interpreter whose prefix and modules are used. The first python3 of PATH may be another.
std::string interpreter() {
  const std::string text = text_of_specification(), key = "\"executable\": \"";
  const std::size_t at = text.find(key);
  if (at == std::string::npos) return "";
  const std::size_t begin = at + key.size();
  return text.substr(begin, text.find('"', begin) - begin);
}

bool is_copy = false;    // this process is one that the engine forked
bool has_moved = false;  // the engine changed the current folder

int hear(const char* event, PyObject*, void*) {
  if (std::strcmp(event, "os.chdir") == 0) has_moved = true;  // of os.fchdir, too
  return 0;
}

// Starts Python once. Extension modules look for Python's symbols in the global scope, and Rigor opens plug-ins
// locally.
bool start_python() {
  static const bool is_there = [] {
    if (Py_IsInitialized()) return true;
    if (!dlopen(RIGOR_PYTHON_LIBRARY, RTLD_NOW | RTLD_GLOBAL)) return false;
    PyConfig config;
    PyConfig_InitPythonConfig(&config);
    config.install_signal_handlers = 0;  // they stay with the program
    PyStatus status = PyConfig_SetBytesString(&config, &config.program_name, interpreter().c_str());
    if (!PyStatus_Exception(status)) status = Py_InitializeFromConfig(&config);
    PyConfig_Clear(&config);
    if (PyStatus_Exception(status)) return false;
    // A process that the engine forks ends with the cell.
    pthread_atfork(nullptr, nullptr, [] { is_copy = true, prctl(PR_SET_PDEATHSIG, SIGKILL); });
    PySys_AddAuditHook(hear, nullptr);
    PyEval_SaveThread();  // each call takes the lock itself
    return true;
  }();
  return is_there;
}

// The object of _host.py that holds the engine.
py::object& host() {
  static auto* made = new py::object([] {
    const py::object specification =
        py::module_::import("json").attr("load")(py::module_::import("builtins").attr("open")(path_of_specification()));
    py::module_::import("sys").attr("path") = specification["sys_path"];
    return py::module_::import("rigor._host").attr("Host")(specification);
  }());
  return *made;
}

rigor_status failure(py::error_already_set& error, rigor_text text) {
  try {
    error.restore();
    PyObject *type = nullptr, *value = nullptr, *trace = nullptr;
    PyErr_Fetch(&type, &value, &trace);
    PyErr_NormalizeException(&type, &value, &trace);
    if (trace) PyException_SetTraceback(value, trace);
    const auto raised = py::reinterpret_steal<py::object>(value);
    Py_XDECREF(type), Py_XDECREF(trace);
    const py::tuple told = py::module_::import("rigor._guard").attr("failure")(raised);
    write(text, told[1].cast<std::string>());
    const auto status = told[0].cast<std::string>();
    return status == "unsupported" ? RIGOR_UNSUPPORTED : status == "diverged" ? RIGOR_DIVERGED : RIGOR_FAILED;
  } catch (...) {
    write(text, "the package rigor cannot be loaded in Python; see the messages of the cell");
    return RIGOR_FAILED;
  }
}

// How this thread rounds, and whether it flushes denormal numbers to zero.
class Arithmetic {
 public:
  void restore() const {
    if (std::fegetround() != rounding_) std::fesetround(rounding_);
    if (flags_now() != flags_) set_flags(flags_);
  }

 private:
#ifdef __SSE__
  static constexpr unsigned kRaised = 0x3f;  // the exceptions so far, which change with each number
  static unsigned flags_now() { return _mm_getcsr() & ~kRaised; }
  static void set_flags(unsigned flags) { _mm_setcsr(flags); }
#else
  static unsigned flags_now() { return 0; }
  static void set_flags(unsigned) {}
#endif

  int rounding_ = std::fegetround();
  unsigned flags_ = flags_now();
};

thread_local Arithmetic engines_arithmetic;

// Keeps the engine's arithmetic and its current folder apart from Rigor's, which judges the run in the same process.
class Apart {
 public:
  Apart() { engines_arithmetic.restore(); }
  ~Apart() {
    engines_arithmetic = Arithmetic();
    rigors_.restore();
    // An engine that also closed the descriptor loses the cell's reports, and the cell says so.
    if (has_moved && fchdir(folder_) == 0) has_moved = false;
  }
  Apart(const Apart&) = delete;
  Apart& operator=(const Apart&) = delete;

 private:
  const Arithmetic rigors_;
  static inline const int folder_ = open(".", O_PATH | O_DIRECTORY | O_CLOEXEC);
};

// Runs `work` with Python's lock. A copy of the process that an engine forked ends here.
template <typename Work>
rigor_status with_python(rigor_text text, const Work& work) {
  const Apart apart;
  if (!start_python()) {
    write(text, "Python cannot be started from " RIGOR_PYTHON_LIBRARY);
    return RIGOR_FAILED;
  }
  const PyGILState_STATE lock = PyGILState_Ensure();
  rigor_status status = RIGOR_FAILED;
  try {
    status = work();
  } catch (py::error_already_set& error) {
    if (is_copy) _exit(kExitOfFork);
    status = failure(error, text);
  } catch (const std::exception& error) {
    write(text, error.what());
  }
  if (is_copy) _exit(kExitOfFork);
  PyGILState_Release(lock);
  return status;
}

// A world belongs to one thread.
template <typename Work>
rigor_status with_world(rigor_world* world, rigor_text text, const Work& work) {
  if (world->is_busy.test_and_set()) {
    write(text, "two threads call one world at a time; a world belongs to one thread");
    return RIGOR_FAILED;
  }
  const rigor_status status = with_python(text, work);
  world->is_busy.clear();
  return status;
}

rigor_status info(rigor_text text) {
  return with_python(text, [&] {
    const auto told = host().attr("info")().cast<std::string>();
    if (told.size() >= text.room) throw std::runtime_error("the engine's description is too long");
    write(text, told);
    return RIGOR_OK;
  });
}

rigor_status load(const char* scene, const char* settings, rigor_world** world, rigor_text text) {
  return with_python(text, [&] {
    auto made = std::make_unique<rigor_world>();
    made->host_world = host().attr("load")(py::str(scene), py::str(settings));
    made->step = made->host_world.attr("step"), made->read = made->host_world.attr("read");
    made->check_state = made->host_world.attr("check_state"), made->contacts = made->host_world.attr("contacts");
    made->bodies = made->host_world.attr("bodies").cast<std::size_t>();
    write(text, made->host_world.attr("settings").cast<std::string>());
    *world = made.release();
    return RIGOR_OK;
  });
}

rigor_status step(rigor_world* world, double dt, const double* wrenches, rigor_text text) {
  return with_world(world, text, [&] {
    if (dt != world->dt) world->begin = world->time(), world->dt = dt, world->count = 0;
    py::object answer;
    if (wrenches) {
      const auto n = static_cast<py::ssize_t>(world->bodies);
      answer = world->step(dt, py::array_t<double>({n, py::ssize_t{6}}, wrenches));
    } else {
      answer = world->step(dt);
    }
    if (!answer.is_none()) world->host_world.attr("refuse_answer_of_step")(answer);
    ++world->count;
    return RIGOR_OK;
  });
}

// Copies the rows of any strides. Returns the first body whose numbers are not finite, or -1.
py::ssize_t copy(const py::array& state, double* const columns[RIGOR_COLUMNS]) {
  const char* from = static_cast<const char*>(state.data());
  const py::ssize_t n = state.shape(0), row = state.strides(0), column = state.strides(1);
  py::ssize_t lost = -1;
  for (py::ssize_t c = 0; c < RIGOR_COLUMNS; ++c) {
    const char* at = from + c * column;
    double* to = columns[c];
    bool is_finite = true;
    for (py::ssize_t i = 0; i < n; ++i, at += row) {
      std::memcpy(&to[i], at, sizeof(double));
      is_finite &= std::isfinite(to[i]);
    }
    for (py::ssize_t i = 0; !is_finite && i < n && lost < 0; ++i) lost = std::isfinite(to[i]) ? -1 : i;
  }
  return lost;
}

rigor_status read(rigor_world* world, double* time, double* const columns[RIGOR_COLUMNS], rigor_text text) {
  return with_world(world, text, [&] {
    py::object answer = world->read();
    const auto bodies = static_cast<py::ssize_t>(world->bodies);
    // A masked array is one of NumPy's too, and what it masks is no state.
    const bool is_plain = Py_IS_TYPE(answer.ptr(), py::detail::npy_api::get().PyArray_Type_);
    const auto is_due = [&](const py::array& array) {
      return array.dtype().is(py::dtype::of<double>()) && array.ndim() == 2 && array.shape(0) == bodies &&
             array.shape(1) == RIGOR_COLUMNS;
    };
    if (!is_plain || !is_due(py::reinterpret_borrow<py::array>(answer))) answer = world->check_state(answer);
    if (const py::ssize_t lost = copy(py::reinterpret_borrow<py::array>(answer), columns); lost >= 0) {
      write(text, world->host_world.attr("lost")(lost).cast<std::string>());
      return RIGOR_DIVERGED;
    }
    *time = world->time();
    return RIGOR_OK;
  });
}

rigor_status unload(rigor_world* world, rigor_text text) {
  return with_python(text, [&] {
    delete world;
    return RIGOR_OK;
  });
}

rigor_status contacts(rigor_world* world, rigor_contact* to, size_t room, size_t* count, rigor_text text) {
  return with_world(world, text, [&] {
    const py::list rows = world->contacts();  // checked: (a, b, ten numbers)
    *count = rows.size();
    for (std::size_t k = 0; k < std::min(room, rows.size()); ++k) {
      const py::tuple row = rows[k];
      double numbers[10];
      for (std::size_t i = 0; i < 10; ++i) numbers[i] = row[i + 2].cast<double>();
      rigor_contact& at = to[k];
      at.a = row[0].cast<int32_t>(), at.b = row[1].cast<int32_t>(), at.gap = numbers[6];
      std::copy(numbers, numbers + 3, at.point), std::copy(numbers + 3, numbers + 6, at.normal);
      std::copy(numbers + 7, numbers + 10, at.force);
    }
    return RIGOR_OK;
  });
}

bool reports_contacts() { return text_of_specification().find("\"contacts\": true") != std::string::npos; }

}  // namespace
}  // namespace rigor::python

extern "C" __attribute__((visibility("default"))) const rigor_engine_v1* rigor_engine_entry(uint32_t abi_major) {
  using namespace rigor::python;
  static const rigor_engine_v1 engine = {sizeof(rigor_engine_v1),
                                         info,
                                         load,
                                         step,
                                         read,
                                         unload,
                                         reports_contacts() ? contacts : nullptr,
                                         /* save */ nullptr,
                                         /* restore */ nullptr};
  return abi_major == RIGOR_ENGINE_ABI_MAJOR ? &engine : nullptr;
}
