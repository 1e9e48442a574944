/* The C API of microtrace: prepared scenes, rays in bulk, pictures. For C and for languages that
 * call C.
 *
 * Functions return MT_OK or another mt_status, whose text mt_last_error() holds. No exception
 * leaves a function; no function prints, exits or aborts. Objects are opaque: *_release() frees
 * them and takes NULL. Scenes and films never change after they are made, so any number of threads
 * may use one at a time. Strings are UTF-8. Coordinates are in world space, right-handed, +y up;
 * colors are linear Rec. 709.
 *
 * Options begin with their size, as mt_..._options_init() sets it: programs compiled with an older
 * header keep working with a newer library. */
#ifndef MICROTRACE_MICROTRACE_H
#define MICROTRACE_MICROTRACE_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define MT_API __attribute__((visibility("default")))
#else
#define MT_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef enum mt_status {
  MT_OK = 0,
  MT_INTERNAL = 1,      /* a failure inside */
  MT_USAGE = 2,         /* an argument that makes no sense */
  MT_INVALID_SCENE = 3, /* the scene breaks the rules of its format */
  MT_UNSUPPORTED = 4,   /* the scene requires a feature that microtrace lacks */
  MT_IO = 5,            /* a file can't be read or written */
  MT_LIMIT = 6,         /* memory or another documented limit */
  MT_CANCELED = 7       /* the progress callback asked to stop */
} mt_status;

/* "MAJOR.MINOR.PATCH" of the library. */
MT_API const char* mt_version(void);

/* The message of the last function that failed on this thread; "" before. Valid until the next
 * function fails on it. */
MT_API const char* mt_last_error(void);

/* ---- Scenes -------------------------------------------------------------------------------- */

/* A scene with its tree. */
typedef struct mt_scene mt_scene;

typedef struct mt_load_options {
  size_t size;
  double time;           /* seconds into an animation; NaN: the pose of the file */
  const char* animation; /* name or index; NULL: the first */
  const char* variant;   /* of materials, name or index; NULL: none */
  uint32_t threads;      /* for the tree; 0: one for each processor */
} mt_load_options;

MT_API void mt_load_options_init(mt_load_options* options);

/* Reads a JSON scene, a .gltf or a .glb file. options may be NULL. */
MT_API mt_status mt_scene_load(const char* path, const mt_load_options* options, mt_scene** scene);

/* The same from memory; files that the scene names are looked for in `folder`, or in the current
 * one if it is NULL. */
MT_API mt_status mt_scene_parse(const void* bytes, size_t byte_count, const char* folder,
                                const mt_load_options* options, mt_scene** scene);

/* Triangles in arrays of the caller's. Strides are in bytes from one element to the next; 0:
 * elements follow each other. The arrays are copied unless `borrow` is set. */
typedef struct mt_mesh {
  size_t size;
  const float* positions; /* three for each vertex */
  size_t position_count;
  size_t position_stride;
  const uint32_t* indices; /* three for each triangle; NULL: vertices 0 1 2, 3 4 5, ... */
  size_t triangle_count;
  size_t index_stride;  /* from one triangle to the next */
  const float* normals; /* three for each vertex, or NULL */
  size_t normal_stride;
  const float* uvs; /* two for each vertex, or NULL */
  size_t uv_stride;
  float base_color[4];  /* linear Rec. 709 and alpha, which is the coverage */
  float emission[3];    /* radiance */
  int32_t double_sided; /* whether cameras see its back */
  float metallic, roughness;
  const uint16_t* short_indices; /* in place of indices; always copied */
  const float* colors;           /* four for each vertex, linear Rec. 709 and alpha; or NULL */
  size_t color_stride;
  /* 1: arrays whose elements follow each other are used in place. They must neither change nor be
   * freed before the scene is released. Others are copied. */
  int32_t borrow;
} mt_mesh;

MT_API void mt_mesh_init(mt_mesh* mesh);

/* Object i of the scene is meshes[i]. MT_INVALID_SCENE for an index out of range or a position that
 * is not finite. threads as in mt_load_options. */
MT_API mt_status mt_scene_from_meshes(const mt_mesh* meshes, size_t count, uint32_t threads,
                                      mt_scene** scene);

MT_API void mt_scene_release(mt_scene* scene);

MT_API uint32_t mt_scene_primitive_count(const mt_scene* scene);
MT_API size_t mt_scene_object_count(const mt_scene* scene);
/* Of an object; valid as long as the scene. NULL for an index out of range. */
MT_API const char* mt_scene_object_name(const mt_scene* scene, size_t object);
/* Warnings of the loader, a line for each; valid as long as the scene. */
MT_API const char* mt_scene_warnings(const mt_scene* scene);

/* ---- Rays ---------------------------------------------------------------------------------- */

/* r(t) = origin + t direction, for t in [t_min, t_max]. The direction has any length but zero; t
 * counts in multiples of it. Rays that are not valid (numbers not finite, t_min < 0, t_min > t_max)
 * hit nothing. */
typedef struct mt_ray {
  float origin[3];
  float t_min;
  float direction[3];
  float t_max;
} mt_ray;

#define MT_NO_HIT UINT32_MAX

/* The nearest hit in real arithmetic on the numbers that scene and ray hold; of hits at one t the
 * one with the lowest primitive number. */
typedef struct mt_hit {
  uint32_t primitive; /* numbered through all objects in their order; MT_NO_HIT */
  float t;            /* the exact parameter, rounded once; infinity for no hit */
} mt_hit;

/* hits[i] answers rays[i]. threads: 0 for one for each processor. */
MT_API mt_status mt_intersect(const mt_scene* scene, const mt_ray* rays, size_t count,
                              uint32_t threads, mt_hit* hits);

/* results[i] is 1 if rays[i] hits anything, else 0. Faster than mt_intersect. */
MT_API mt_status mt_occluded(const mt_scene* scene, const mt_ray* rays, size_t count,
                             uint32_t threads, uint8_t* results);

/* hits[i] is the hit behind after[i], one of the hits of rays[i]: repeated calls find all, nearest
 * first. MT_NO_HIT in after[i] gives MT_NO_HIT. after and hits may be the same array. */
MT_API mt_status mt_next(const mt_scene* scene, const mt_ray* rays, const mt_hit* after,
                         size_t count, uint32_t threads, mt_hit* hits);

#define MT_NO_MATERIAL UINT32_MAX

typedef struct mt_surface {
  double position[3];
  double normal[3];         /* geometric, unit length, on the front side */
  double shading_normal[3]; /* interpolated from the vertices; unit length, on the front side */
  double barycentrics[3];   /* weights of a triangle's corners; 0 0 0 for other shapes */
  double uv[2];             /* texture coordinates of set 0; 0 0 without them */
  uint32_t object;
  uint32_t primitive; /* within the object */
  uint32_t material;  /* MT_NO_MATERIAL: the default material */
  uint8_t front;      /* 1: the ray arrives at the front */
} mt_surface;

/* surfaces[i] is the surface at hits[i] of rays[i]; all zero for MT_NO_HIT. */
MT_API mt_status mt_surfaces(const mt_scene* scene, const mt_ray* rays, const mt_hit* hits,
                             size_t count, uint32_t threads, mt_surface* surfaces);

/* ---- Pictures ------------------------------------------------------------------------------ */

typedef struct mt_film mt_film;

typedef enum mt_integrator {
  MT_DEFAULT = 0, /* MT_PATH for glTF, MT_FLAT for JSON scenes and meshes */
  MT_FLAT = 1,    /* base colors without light */
  MT_PATH = 2     /* path tracing */
} mt_integrator;

typedef struct mt_camera {
  double position[3];
  double target[3];
  double up[3];
  double vertical_fov; /* full opening angle, degrees, in (0, 180) */
} mt_camera;

typedef struct mt_render_options {
  size_t size;
  uint32_t width, height; /* pixels; 0: those of the scene */
  int32_t integrator;     /* an mt_integrator */
  uint32_t samples;       /* for each pixel; 0: 1 for MT_FLAT, 64 for MT_PATH */
  uint32_t max_depth;
  uint32_t seed;
  uint32_t threads;        /* 0: one for each processor */
  const mt_camera* camera; /* NULL: the scene's first, else one that sees all of it */
  int32_t transparent;     /* leaves the background out and gives the film alpha */
  /* Names of exact outputs, separated by commas ("depth,normal,id"), as further channels; NULL. */
  const char* aovs;
  /* Told the fraction that is done, by one thread at a time; returns 0 to cancel. May be NULL. */
  int32_t (*progress)(void* user, double fraction);
  void* user;
} mt_render_options;

MT_API void mt_render_options_init(mt_render_options* options);

MT_API mt_status mt_render(const mt_scene* scene, const mt_render_options* options, mt_film** film);

MT_API void mt_film_release(mt_film* film);
MT_API uint32_t mt_film_width(const mt_film* film);
MT_API uint32_t mt_film_height(const mt_film* film);

/* Writes width x height x 4 linear numbers, rows from the top: color multiplied with alpha, and
 * alpha, which is 1 unless the picture is transparent. */
MT_API mt_status mt_film_rgba(const mt_film* film, float* rgba);

/* Names of the channels beside color: "depth.Z", "id.instance". NULL for an index out of range. */
MT_API const char* mt_film_channel_name(const mt_film* film, size_t channel);
/* Writes width x height numbers. MT_USAGE if the channel is one of integers. */
MT_API mt_status mt_film_channel_floats(const mt_film* film, size_t channel, float* values);
/* MT_USAGE if the channel is one of floats. */
MT_API mt_status mt_film_channel_integers(const mt_film* film, size_t channel, uint32_t* values);

/* Writes a file in the format that its extension names. */
MT_API mt_status mt_film_save(const mt_film* film, const char* path);

#ifdef __cplusplus
}
#endif

#endif
