/* An engine for Rigor as a shared library: C11, no dependency. The library exports one function,

     const rigor_engine_v1* rigor_engine_entry(uint32_t abi_major);

   which returns a struct that lives as long as the library, or NULL for a version that it does not speak. Texts are
   JSON in UTF-8, the same as a process plug-in's (protocol.schema.json, scene.schema.json). SI units; quaternions
   (w, x, y, z), body to world; velocities, angular velocities, forces and torques in the world frame W.

   Every call returns a status and may write a text that ends in a zero byte. No exception may leave a call. A world
   belongs to one thread; several worlds may be in use at once. */
#ifndef RIGOR_ENGINE_H
#define RIGOR_ENGINE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define RIGOR_ENGINE_ABI_MAJOR 1u
#define RIGOR_COLUMNS 13

/* What a call came to. Of all but RIGOR_OK the text is the reason, a sentence. After RIGOR_DIVERGED and RIGOR_FAILED
   the world is only unloaded. */
enum { RIGOR_OK = 0, RIGOR_UNSUPPORTED = 1, RIGOR_DIVERGED = 2, RIGOR_FAILED = 3 };
typedef int32_t rigor_status;

/* Room for a text: at most `room` bytes at `data`, the zero byte among them. */
typedef struct rigor_text {
  char* data;
  size_t room;
} rigor_text;

typedef struct rigor_world rigor_world; /* the engine's own */

/* A point at which two bodies touched in the last step; in W. Bodies by their place in the scene. */
typedef struct rigor_contact {
  int32_t a, b;
  double point[3];  /* m */
  double normal[3]; /* unit, from a to b */
  double gap;       /* m; negative if the bodies overlap */
  double force[3];  /* N on b: the impulses of the step divided by its length */
} rigor_contact;

typedef struct rigor_engine_v1 {
  size_t struct_size; /* sizeof(rigor_engine_v1): later versions append */

  /* The text: {"ok":true,"name":...,"version":...,"precision":...,"features":[...],"methods":[...]}. */
  rigor_status (*info)(rigor_text text);

  /* `scene` and `settings` are the JSON of a load request's keys of that name, valid during the call. Sets *world. The
     text: the settings in force, {"gyroscopic":"on"}, or nothing. */
  rigor_status (*load)(const char* scene, const char* settings, rigor_world** world, rigor_text text);

  /* Exactly one step of dt seconds. `wrenches`: NULL, or for each body fx fy fz tx ty tz [N, N m], about its centre of
     mass, in W, held over this step and cleared after it. */
  rigor_status (*step)(rigor_world* world, double dt, const double* wrenches, rigor_text text);

  /* The state now. *time [s]; columns[c][i] is number c of body i, in the scene's order:
     px py pz [m], qw qx qy qz, vx vy vz [m/s], wx wy wz [rad/s]. Each column has a double for each body and no more. */
  rigor_status (*read)(rigor_world* world, double* time, double* const columns[RIGOR_COLUMNS], rigor_text text);

  /* Frees the world, whatever its last call came to. */
  rigor_status (*unload)(rigor_world* world, rigor_text text);

  /* Optional; the functions from here on may be NULL or beyond struct_size. The contacts of the last step: sets *count
     to their number and writes the first `room` of them. It is called again if there are more than that. */
  rigor_status (*contacts)(rigor_world* world, rigor_contact* contacts, size_t room, size_t* count, rigor_text text);

  /* Optional, both or neither. All that the world's next steps depend on, as bytes of the engine's own: sets *size to
     their number and writes the first `room` of them. It is called again if there are more than that. */
  rigor_status (*save)(rigor_world* world, unsigned char* bytes, size_t room, size_t* size, rigor_text text);

  /* Restores what this world saved, or another of the same scene and settings. Bytes that are no saved state of this
     engine: RIGOR_FAILED with the reason. */
  rigor_status (*restore)(rigor_world* world, const unsigned char* bytes, size_t size, rigor_text text);
} rigor_engine_v1;

const rigor_engine_v1* rigor_engine_entry(uint32_t abi_major);

#ifdef __cplusplus
}
#endif

#endif
