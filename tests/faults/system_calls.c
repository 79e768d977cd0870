// Preloaded into a program (LD_PRELOAD): lets one of its system calls about files, pipes and processes fail, or kills
// it there. The calls are counted over the program and all that it forks.
//   RIGOR_FAULT_STATE  a file of at least sizeof(struct State) bytes, which all of them share
//   RIGOR_FAULT_AT     the call that fails, counted from 1; 0: none, they are counted only
//   RIGOR_FAULT        how: the errno, or `kill` (the process that calls), or `kill-all` (its whole group, too)
// Calls inside the C library (stdio, the loader) are not intercepted, except by fopen().
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

struct State {
  atomic_long count;
  char what[248];  // the call that failed, and its file if it names one
};

static struct State* state;
static long fault_at;
static int fault_errno;  // 0: kill
static int kills_all;
static pid_t group;

__attribute__((constructor)) static void begin(void) {
  const char *file = getenv("RIGOR_FAULT_STATE"), *at = getenv("RIGOR_FAULT_AT"), *how = getenv("RIGOR_FAULT");
  if (!file || !at || !how) return;
  const int descriptor = open(file, O_RDWR | O_CLOEXEC);
  if (descriptor < 0) abort();
  void* shared = mmap(NULL, sizeof(struct State), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  close(descriptor);
  if (shared == MAP_FAILED) abort();
  fault_at = atol(at);
  fault_errno = atoi(how);
  kills_all = strcmp(how, "kill-all") == 0;
  group = getpgrp();
  state = shared;
}

// Whether this is the call. Does not return where it kills.
static int is_it(const char* call, const char* file) {
  if (!state || atomic_fetch_add(&state->count, 1) + 1 != fault_at) return 0;
  snprintf(state->what, sizeof state->what, "%s %s", call, file ? file : "");
  if (fault_errno == 0) {
    if (kills_all) kill(-group, SIGKILL);
    kill(getpid(), SIGKILL);
  }
  errno = fault_errno;
  return 1;
}

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

// A call of fixed arguments: (its type, its name, its parameters, its arguments, the file it names, what a failure is).
#define CALL(type, name, parameters, arguments, file, failure) \
  type name parameters {                                       \
    static __typeof__(&name) real;                             \
    if (!real) real = REAL(name);                              \
    return is_it(#name, file) ? failure : real arguments;      \
  }

CALL(ssize_t, read, (int fd, void* to, size_t count), (fd, to, count), NULL, -1)
CALL(ssize_t, write, (int fd, const void* from, size_t count), (fd, from, count), NULL, -1)
CALL(ssize_t, writev, (int fd, const struct iovec* from, int count), (fd, from, count), NULL, -1)
CALL(ssize_t, sendfile, (int to, int from, off_t* at, size_t count), (to, from, at, count), NULL, -1)
CALL(int, ftruncate, (int fd, off_t length), (fd, length), NULL, -1)
CALL(int, rename, (const char* from, const char* to), (from, to), from, -1)
CALL(int, renameat2, (int a, const char* from, int b, const char* to, unsigned flags), (a, from, b, to, flags), from,
     -1)
CALL(int, link, (const char* from, const char* to), (from, to), from, -1)
CALL(int, mkdir, (const char* path, mode_t mode), (path, mode), path, -1)
CALL(int, remove, (const char* path), (path), path, -1)
CALL(int, unlink, (const char* path), (path), path, -1)
CALL(int, unlinkat, (int fd, const char* path, int flags), (fd, path, flags), path, -1)
CALL(DIR*, opendir, (const char* path), (path), path, NULL)
CALL(FILE*, fopen, (const char* path, const char* mode), (path, mode), path, NULL)
CALL(FILE*, fopen64, (const char* path, const char* mode), (path, mode), path, NULL)
CALL(pid_t, fork, (void), (), NULL, -1)
CALL(int, pipe2, (int ends[2], int flags), (ends, flags), NULL, -1)

#define OPEN(name)                                                  \
  int name(const char* path, int flags, ...) {                      \
    static __typeof__(&name) real;                                  \
    if (!real) real = REAL(name);                                   \
    va_list rest;                                                   \
    va_start(rest, flags);                                          \
    const mode_t mode = flags & O_CREAT ? va_arg(rest, mode_t) : 0; \
    va_end(rest);                                                   \
    return is_it(#name, path) ? -1 : real(path, flags, mode);       \
  }
OPEN(open)
OPEN(open64)

int openat(int folder, const char* path, int flags, ...) {
  static __typeof__(&openat) real;
  if (!real) real = REAL(openat);
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = flags & O_CREAT ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return is_it("openat", path) ? -1 : real(folder, path, flags, mode);
}
