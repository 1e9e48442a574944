/* The C API of microtrace: prepared scenes, bulk ray queries and pictures, for C and for languages
 * that call C.
 *
 * Functions that can fail return MT_OK or another mt_status; mt_last_error() returns the message.
 * No exception leaves a function, and no function prints, exits or aborts. Objects are opaque.
 * *_release() frees an object and accepts NULL. Scenes and films never change after they are made,
 * so any number of threads may use them at the same time. Strings are UTF-8. Coordinates are in
 * world space, right-handed with +y up; colors are linear Rec. 709.
 *
 * Structs of options begin with a member `size`, which their ..._init() function sets. It lets
 * programs compiled with an older header work with a newer library. */
#ifndef MICROTRACE_MICROTRACE_H
#define MICROTRACE_MICROTRACE_H

#include <stddef.h> /* NOLINT(modernize-deprecated-headers): C lacks cstddef and cstdint */
#include <stdint.h> /* NOLINT(modernize-deprecated-headers) */

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
  MT_INTERNAL = 1,      /* an internal failure, which is a defect of the library */
  MT_USAGE = 2,         /* an invalid argument */
  MT_INVALID_SCENE = 3, /* the scene violates its format */
  MT_UNSUPPORTED = 4,   /* the scene requires a feature that microtrace lacks */
  MT_IO = 5,            /* a file can't be read or written */
  MT_LIMIT = 6,         /* memory ran out or a documented limit was exceeded */
  MT_CANCELED = 7       /* the progress callback requested to stop */
} mt_status;

/* Functions that return a status return MT_USAGE if a handle or a required pointer is NULL. The
 * other functions then do nothing and return 0 or NULL. */

/* Returns the library's version as "MAJOR.MINOR.PATCH". */
MT_API const char* mt_version(void);

/* Returns the message of the last function that failed on this thread, or "" if none has failed.
 * The string is valid until another function fails on this thread. */
MT_API const char* mt_last_error(void);

/* ---- Scenes -------------------------------------------------------------------------------- */

/* A scene with its tree, prepared for queries and rendering. */
typedef struct mt_scene mt_scene;

typedef struct mt_load_options {
  size_t size;
  double time;           /* animation time in seconds; NaN: no animation is applied */
  const char* animation; /* name or index of the animation; NULL: the first */
  const char* variant;   /* name or index of the material variant; NULL: none */
  uint32_t threads;      /* for building the tree; 0: one per available processor */
} mt_load_options;

MT_API void mt_load_options_init(mt_load_options* options);

/* Reads a JSON scene, a .gltf file or a .glb file. On success, *scene is a new scene, which the
 * caller must release. options may be NULL. */
MT_API mt_status mt_scene_load(const char* path, const mt_load_options* options, mt_scene** scene);

/* Reads a scene file whose bytes are in memory. Paths in the scene are relative to `folder`, or to
 * the current folder if `folder` is NULL. */
MT_API mt_status mt_scene_parse(const void* bytes, size_t byte_count, const char* folder,
                                const mt_load_options* options, mt_scene** scene);

/* Triangles in caller-provided arrays. Strides are in bytes from one element to the next; 0 means
 * that elements are contiguous. The arrays are copied unless `borrow` is set. */
typedef struct mt_mesh {
  size_t size;
  const float* positions; /* three per vertex */
  size_t position_count;
  size_t position_stride;
  const uint32_t* indices; /* three per triangle; NULL: the vertices are 0 1 2, 3 4 5, ... */
  size_t triangle_count;
  size_t index_stride;  /* from one triangle to the next */
  const float* normals; /* three per vertex, unit length; or NULL */
  size_t normal_stride;
  const float* uvs; /* two texture coordinates per vertex, or NULL */
  size_t uv_stride;
  float base_color[4];  /* linear Rec. 709 and alpha; alpha is the coverage */
  float emission[3];    /* emitted radiance, linear Rec. 709 */
  int32_t double_sided; /* nonzero if cameras see the back */
  float metallic, roughness;
  const uint16_t* short_indices; /* alternative to `indices` with 16 bits; always copied */
  const float* colors;           /* four per vertex, linear Rec. 709 and alpha; or NULL */
  size_t color_stride;
  /* 1: contiguous arrays are used in place. They must neither change nor be freed before the scene
   * is released. Other arrays are copied. */
  int32_t borrow;
} mt_mesh;

MT_API void mt_mesh_init(mt_mesh* mesh);

/* Makes a scene whose object i is meshes[i]. On success, *scene is a new scene, which the caller
 * must release. Returns MT_INVALID_SCENE if an index is out of range or a number is not finite or
 * out of its range, MT_LIMIT if there are 2^32 triangles or more, and MT_USAGE if the structs'
 * sizes differ. `threads` is as in mt_load_options. */
MT_API mt_status mt_scene_from_meshes(const mt_mesh* meshes, size_t count, uint32_t threads,
                                      mt_scene** scene);

/* A mesh at a place in the scene. */
typedef struct mt_instance {
  /* The rows of the affine transform from the mesh's coordinates to the scene: x', y' and z' are
   * row[0] x + row[1] y + row[2] z + row[3]. */
  double scene_from_mesh[3][4];
  uint32_t mesh; /* index of the mesh */
} mt_instance;

/* Makes a scene whose object i is instances[i]. Instances of a mesh share its arrays and its tree,
 * and give the results of copies whose vertices are transformed in float64 and rounded once.
 * Returns MT_INVALID_SCENE as mt_scene_from_meshes() does, and if a transform is not finite or a
 * mesh does not exist. */
MT_API mt_status mt_scene_from_instances(const mt_mesh* meshes, size_t mesh_count,
                                         const mt_instance* instances, size_t instance_count,
                                         uint32_t threads, mt_scene** scene);

MT_API void mt_scene_release(mt_scene* scene);

MT_API uint32_t mt_scene_primitive_count(const mt_scene* scene);
MT_API size_t mt_scene_object_count(const mt_scene* scene);
/* Returns the name of an object, or NULL if the index is out of range or memory is exhausted. The
 * string is valid until the scene is released. */
MT_API const char* mt_scene_object_name(const mt_scene* scene, size_t object);
/* Returns the loader's warnings, each ending with a line break. The string is valid until the scene
 * is released. */
MT_API const char* mt_scene_warnings(const mt_scene* scene);

/* ---- Rays ---------------------------------------------------------------------------------- */

/* The ray r(t) = origin + t direction, for t in [t_min, t_max]. The direction may have any nonzero
 * length; t counts multiples of it. t_max may be infinite. Invalid rays (other numbers not finite,
 * direction zero, t_min < 0, t_min > t_max) hit nothing. */
typedef struct mt_ray {
  float origin[3];
  float t_min;
  float direction[3];
  float t_max;
} mt_ray;

#define MT_NO_HIT UINT32_MAX

/* A hit of a ray. The nearest hit is found as if by real arithmetic on the numbers of the scene and
 * the ray. Of several hits at the same t, the one with the lowest primitive number counts as the
 * nearest. */
typedef struct mt_hit {
  uint32_t primitive; /* counted through all objects in order; MT_NO_HIT if there is no hit */
  float t;            /* the exact ray parameter, rounded once, which may give infinity; infinity if
                         there is no hit */
} mt_hit;

/* Sets hits[i] to the nearest hit of rays[i]. `threads` is the number of threads; 0 means one per
 * processor. */
MT_API mt_status mt_intersect(const mt_scene* scene, const mt_ray* rays, size_t count,
                              uint32_t threads, mt_hit* hits);

/* Sets results[i] to 1 if rays[i] hits anything, otherwise to 0. Faster than mt_intersect. */
MT_API mt_status mt_occluded(const mt_scene* scene, const mt_ray* rays, size_t count,
                             uint32_t threads, uint8_t* results);

/* Sets hits[i] to the hit of rays[i] that follows after[i], which must be a hit of rays[i].
 * Repeated calls enumerate all hits, nearest first. If after[i] is MT_NO_HIT, so is hits[i].
 * `after` and `hits` may be the same array. */
MT_API mt_status mt_next(const mt_scene* scene, const mt_ray* rays, const mt_hit* after,
                         size_t count, uint32_t threads, mt_hit* hits);

#define MT_NO_MATERIAL UINT32_MAX

typedef struct mt_surface {
  double position[3];
  double normal[3];         /* geometric normal, unit length, on the front side */
  double shading_normal[3]; /* interpolated from vertices; unit length, on the front side */
  double barycentrics[3];   /* weights of a triangle's vertices; 0 0 0 for other shapes */
  double uv[2];             /* texture coordinates of set 0; 0 0 if there are none */
  uint32_t object;
  uint32_t primitive; /* index within the object */
  uint32_t material;  /* MT_NO_MATERIAL: the default material */
  uint8_t front;      /* 1 if the ray arrives at the front side */
} mt_surface;

/* Sets surfaces[i] to the surface at hits[i], which must be a hit of rays[i]. All members are zero
 * for MT_NO_HIT. */
MT_API mt_status mt_surfaces(const mt_scene* scene, const mt_ray* rays, const mt_hit* hits,
                             size_t count, uint32_t threads, mt_surface* surfaces);

/* ---- Pictures ------------------------------------------------------------------------------ */

typedef struct mt_film mt_film;

typedef enum mt_integrator {
  MT_DEFAULT = 0, /* MT_PATH for glTF, MT_FLAT for JSON scenes and meshes */
  MT_FLAT = 1,    /* base colors without lighting */
  MT_PATH = 2     /* path tracing */
} mt_integrator;

/* Formulas for surfaces. */
typedef enum mt_bsdf {
  MT_CONSERVING = 0, /* returns the light that the formulas of the glTF specification lose */
  MT_SPEC = 1        /* the formulas of the glTF specification */
} mt_bsdf;

typedef struct mt_camera {
  double position[3];
  double target[3];
  double up[3];
  double vertical_fov; /* full vertical opening angle in degrees, in (0, 180) */
} mt_camera;

typedef struct mt_render_options {
  size_t size;
  uint32_t width, height;  /* in pixels; 0: the scene's default */
  int32_t integrator;      /* one of mt_integrator */
  uint32_t samples;        /* per pixel; 0: 1 for MT_FLAT, 64 for MT_PATH */
  uint32_t max_depth;      /* maximum path length, for MT_PATH; 0: 32 */
  uint32_t seed;           /* random seed */
  uint32_t threads;        /* 0: one per available processor */
  const mt_camera* camera; /* NULL: the scene's first camera, or one that frames the whole scene */
  int32_t transparent;     /* nonzero: omits the background and gives the film alpha */
  /* Names of exact quantities to store as additional channels, separated by commas
   * ("depth,normal,id"), or NULL. */
  const char* aovs;
  /* Called with the fraction of the picture that is done, by one thread at a time. Returns 0 to
   * cancel. May be NULL. */
  int32_t (*progress)(void* user, double fraction);
  void* user;
  /* Nonzero: removes noise by the library Open Image Denoise, for MT_PATH. mt_render() returns
   * MT_UNSUPPORTED before rendering if the library is not installed. */
  int32_t denoise;
  int32_t bsdf; /* one of mt_bsdf, for MT_PATH */
  /* Nonzero: paths first learn where light arrives from, for MT_PATH and light that is hard to
   * find. */
  int32_t guiding;
} mt_render_options;

MT_API void mt_render_options_init(mt_render_options* options);

/* Renders a picture. On success, *film is a new film, which the caller must release. options may be
 * NULL. Returns MT_USAGE for invalid options, MT_LIMIT if memory runs out, and MT_CANCELED if the
 * progress callback requests it. */
MT_API mt_status mt_render(const mt_scene* scene, const mt_render_options* options, mt_film** film);

MT_API void mt_film_release(mt_film* film);
MT_API uint32_t mt_film_width(const mt_film* film);
MT_API uint32_t mt_film_height(const mt_film* film);

/* Writes width x height x 4 numbers, row by row from the top: linear Rec. 709 colors premultiplied
 * with alpha, and alpha. Alpha is 1 unless the picture was rendered with `transparent`. */
MT_API mt_status mt_film_rgba(const mt_film* film, float* rgba);

/* Returns the name of an additional channel, such as "depth.Z" or "id.instance", or NULL if the
 * index is out of range. The string is valid until the film is released. */
MT_API const char* mt_film_channel_name(const mt_film* film, size_t channel);
/* Writes width x height numbers of a channel, row by row from the top. Returns MT_USAGE if the
 * channel holds integers. */
MT_API mt_status mt_film_channel_floats(const mt_film* film, size_t channel, float* values);
/* Like mt_film_channel_floats for channels of integers. Returns MT_USAGE if the channel holds
 * floats. */
MT_API mt_status mt_film_channel_integers(const mt_film* film, size_t channel, uint32_t* values);

/* Writes a picture file, and replaces an existing one only when all is written. The extension of
 * `path` selects the format. Returns MT_USAGE if the extension is unknown or the format can't store
 * the film's alpha or channels, MT_UNSUPPORTED if the format's module is not installed, and MT_IO if
 * the file can't be written. */
MT_API mt_status mt_film_save(const mt_film* film, const char* path);

#ifdef __cplusplus
}
#endif

#endif
