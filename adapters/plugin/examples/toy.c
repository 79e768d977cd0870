/* The smallest engine for Rigor as a shared library, to copy: free bodies by semi-implicit Euler, in C11 alone.

     cc -std=c11 -O2 -ffp-contract=off -fPIC -shared -I .. toy.c -lm -o toy.so && rigor conform --plugin ./toy.so

   The same steps as toy.py. Its reader of JSON knows no more than where the keys of a scene's bodies are; take a library
   for more. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "rigor_engine.h"

typedef struct { double mass, I[3][3], J[3][3], x[3], q[4], v[3], w[3]; int fixed; } body;
struct rigor_world { double gravity[3], time; size_t count; body* bodies; };

static rigor_status say(rigor_text text, rigor_status status, const char* what) {
  snprintf(text.data, text.room, "%s", what);
  return status;
}

static void cross(const double* a, const double* b, double* c) {
  for (int i = 0; i < 3; ++i) c[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}
static void rotate(const double* q, double sign, const double* v, double* out) { /* by q, or back with sign -1 */
  double u[3] = {sign * q[1], sign * q[2], sign * q[3]}, t[3], s[3];
  cross(u, v, t);
  cross(u, t, s);
  for (int i = 0; i < 3; ++i) out[i] = v[i] + 2 * (q[0] * t[i] + s[i]);
}
static void in_world(double m[3][3], const double* q, const double* v, double* out) { /* R m R^T v */
  double b[3], c[3];
  rotate(q, -1, v, b);
  for (int i = 0; i < 3; ++i) c[i] = m[i][0] * b[0] + m[i][1] * b[1] + m[i][2] * b[2];
  rotate(q, 1, c, out);
}
static void turned(const double* q, const double* w, double dt, double* out) { /* exp(dt w) q, of unit length */
  double angle = dt * sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]), size = 0, c[3];
  double s = dt * (angle > 1e-8 ? sin(angle / 2) / angle : 0.5 - angle * angle / 48);
  double e[4] = {cos(angle / 2), s * w[0], s * w[1], s * w[2]}, r[4];
  cross(e + 1, q + 1, c);
  r[0] = e[0] * q[0] - e[1] * q[1] - e[2] * q[2] - e[3] * q[3];
  for (int i = 0; i < 3; ++i) r[i + 1] = e[0] * q[i + 1] + q[0] * e[i + 1] + c[i];
  for (int i = 0; i < 4; ++i) size += r[i] * r[i];
  for (int i = 0; i < 4; ++i) out[i] = r[i] / sqrt(size);
}

/* The numbers of "key":[...] or "key":x between two places of a text; 0 if the key is not there. */
static int numbers(const char* from, const char* to, const char* key, double* out, int count) {
  char quoted[40];
  snprintf(quoted, sizeof quoted, "\"%s\":", key);
  const char* at = strstr(from, quoted);
  if (!at || at >= to) return 0;
  for (at += strlen(quoted); count > 0; --count) {
    char* end;
    at += strspn(at, "[, ");
    *out++ = strtod(at, &end);
    at = end;
  }
  return 1;
}
/* The end of the object that begins at `at`, braces inside of texts left alone. */
static const char* end_of(const char* at) {
  int depth = 0, in_text = 0;
  for (; *at; ++at) {
    if (*at == '\\') { ++at; continue; }
    if (*at == '"') in_text = !in_text;
    if (!in_text && *at == '{') ++depth;
    if (!in_text && *at == '}' && --depth == 0) return at + 1;
  }
  return at;
}
static void read_body(const char* from, const char* to, body* b) {
  double i[6] = {1, 1, 1, 0, 0, 0};
  const char* fixed = strstr(from, "\"fixed\":true");
  *b = (body){.mass = 1, .q = {1, 0, 0, 0}, .fixed = fixed && fixed < to};
  numbers(from, to, "mass", &b->mass, 1), numbers(from, to, "inertia", i, 6), numbers(from, to, "position", b->x, 3);
  numbers(from, to, "orientation_wxyz", b->q, 4), numbers(from, to, "velocity", b->v, 3);
  numbers(from, to, "angular_velocity", b->w, 3);
  double m[3][3] = {{i[0], i[3], i[4]}, {i[3], i[1], i[5]}, {i[4], i[5], i[2]}}, c[3][3];
  for (int k = 0; k < 3; ++k) cross(m[(k + 1) % 3], m[(k + 2) % 3], c[k]);
  double det = m[0][0] * c[0][0] + m[0][1] * c[0][1] + m[0][2] * c[0][2];
  for (int r = 0; r < 3; ++r) for (int k = 0; k < 3; ++k) b->I[r][k] = m[r][k], b->J[r][k] = c[k][r] / det;
}

static rigor_status info(rigor_text text) {
  return say(text, RIGOR_OK, "{\"ok\":true,\"name\":\"toy-c\",\"version\":\"1\",\"precision\":\"double\","
      "\"features\":[\"wrench\",\"fixed-body\"],\"methods\":[{\"name\":\"euler\",\"summary\":\"semi-implicit Euler, angular "
      "momentum kept in the world frame\",\"order\":1,\"leapfrog_stagger\":0.5}]}");
}
static rigor_status load(const char* scene, const char* settings, rigor_world** out, rigor_text text) {
  (void)settings;
  rigor_world* world = calloc(1, sizeof *world);
  const char* at = strstr(scene, "\"body\":[");
  if (!world || !at) return free(world), say(text, RIGOR_FAILED, "a scene without bodies, or no memory");
  numbers(scene, at, "gravity", world->gravity, 3);
  for (at += 8; *at == '{'; at += *at == ',') {
    const char* end = end_of(at);
    body* more = realloc(world->bodies, (world->count + 1) * sizeof(body));
    if (!more) return free(world->bodies), free(world), say(text, RIGOR_FAILED, "no memory");
    world->bodies = more;
    read_body(at, end, &world->bodies[world->count++]);
    at = end;
  }
  *out = world;
  return say(text, RIGOR_OK, "{\"gyroscopic\":\"on, by the angular momentum\"}");
}
static rigor_status step(rigor_world* world, double dt, const double* wrenches, rigor_text text) {
  (void)text;
  for (size_t n = 0; n < world->count; ++n) {
    body* b = &world->bodies[n];
    double L[3], w[3], middle[4];
    if (b->fixed) continue;
    in_world(b->I, b->q, b->w, L);
    for (int i = 0; i < 3; ++i) {
      b->v[i] += dt * (world->gravity[i] + (wrenches ? wrenches[6 * n + i] / b->mass : 0));
      b->x[i] += dt * b->v[i];
      L[i] += wrenches ? dt * wrenches[6 * n + 3 + i] : 0;
    }
    in_world(b->J, b->q, L, w);
    turned(b->q, w, dt / 2, middle);
    in_world(b->J, middle, L, w);
    turned(b->q, w, dt, b->q);
    in_world(b->J, b->q, L, b->w);
  }
  world->time += dt;
  return RIGOR_OK;
}
static rigor_status read_state(rigor_world* world, double* time, double* const columns[RIGOR_COLUMNS], rigor_text text) {
  *time = world->time;
  for (size_t n = 0; n < world->count; ++n) {
    const body* b = &world->bodies[n];
    for (int i = 0; i < 3; ++i) columns[i][n] = b->x[i], columns[7 + i][n] = b->v[i], columns[10 + i][n] = b->w[i];
    for (int i = 0; i < 4; ++i) columns[3 + i][n] = b->q[i];
    for (int c = 0; c < RIGOR_COLUMNS; ++c)
      if (!isfinite(columns[c][n])) return say(text, RIGOR_DIVERGED, "a number is not finite");
  }
  return RIGOR_OK;
}
/* What a step depends on: a title, the time, and each body as it is. */
static const char title[8] = "toy-c 1";
static rigor_status save(rigor_world* world, unsigned char* bytes, size_t room, size_t* size, rigor_text text) {
  size_t of_bodies = world->count * sizeof(body), head = sizeof title + sizeof(double);
  *size = head + of_bodies;
  if (*size > room) return RIGOR_OK; /* it is called again with more room */
  memcpy(bytes, title, sizeof title), memcpy(bytes + sizeof title, &world->time, sizeof(double));
  memcpy(bytes + head, world->bodies, of_bodies);
  return say(text, RIGOR_OK, "");
}
static rigor_status restore(rigor_world* world, const unsigned char* bytes, size_t size, rigor_text text) {
  size_t of_bodies = world->count * sizeof(body), head = sizeof title + sizeof(double);
  if (size != head + of_bodies || memcmp(bytes, title, sizeof title) != 0)
    return say(text, RIGOR_FAILED, "these bytes are no saved state of this scene");
  memcpy(&world->time, bytes + sizeof title, sizeof(double)), memcpy(world->bodies, bytes + head, of_bodies);
  return RIGOR_OK;
}
static rigor_status unload(rigor_world* world, rigor_text text) {
  (void)text;
  return free(world->bodies), free(world), RIGOR_OK;
}

const rigor_engine_v1* rigor_engine_entry(uint32_t abi_major) {
  static const rigor_engine_v1 engine = {sizeof engine, info, load, step, read_state, unload, NULL, save, restore};
  return abi_major == RIGOR_ENGINE_ABI_MAJOR ? &engine : NULL;
}
