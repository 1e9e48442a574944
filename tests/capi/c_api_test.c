/* Uses the C API as a C program does. The first argument is the folder of scenes, the second one
 * a folder for output. */
#include "check.h"

#include <microtrace/microtrace.h>
#include <microtrace/version.h>

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The cube [-1, 1]^3. Each vertex has five numbers: position and texture coordinates. */
static float vertices[8][5];
static uint32_t indices[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                  {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};

static mt_mesh cube(void) {
  for (int i = 0; i < 8; ++i) {
    for (int k = 0; k < 3; ++k) vertices[i][k] = (i >> k & 1) ? 1.0F : -1.0F;
    vertices[i][3] = (float)(i & 1);
    vertices[i][4] = (float)(i >> 1 & 1);
  }
  mt_mesh mesh;
  mt_mesh_init(&mesh);
  mesh.positions = vertices[0];
  mesh.position_count = 8;
  mesh.position_stride = sizeof vertices[0];
  mesh.uvs = vertices[0] + 3;
  mesh.uv_stride = sizeof vertices[0];
  mesh.indices = indices[0];
  mesh.triangle_count = 12;
  mesh.base_color[1] = 0.5F;
  return mesh;
}

static mt_ray ray(float x, float y, float z, float dx, float dy, float dz) {
  const mt_ray result = {{x, y, z}, 0, {dx, dy, dz}, INFINITY};
  return result;
}

static void rays(const mt_scene* scene) {
  enum { kCount = 20000 };
  mt_ray* all = malloc(kCount * sizeof *all);
  mt_hit* hits = malloc(kCount * sizeof *hits);
  uint8_t* occluded = malloc(kCount);
  mt_surface* surfaces = malloc(kCount * sizeof *surfaces);
  for (int i = 0; i < kCount; ++i) {
    const float x = (float)i / kCount * 4 - 2; /* half of them pass by the cube */
    all[i] = ray(x, 0.25F, 5, 0, 0, -2);
  }
  for (uint32_t threads = 1; threads <= 3; ++threads) {
    memset(hits, 0, kCount * sizeof *hits);
    CHECK(mt_intersect(scene, all, kCount, threads, hits) == MT_OK);
    CHECK(mt_occluded(scene, all, kCount, threads, occluded) == MT_OK);
    CHECK(mt_surfaces(scene, all, hits, kCount, threads, surfaces) == MT_OK);
    for (int i = 0; i < kCount; ++i) {
      const float x = all[i].origin[0];
      const int within = x >= -1 && x <= 1;
      CHECK(occluded[i] == within);
      CHECK((hits[i].primitive != MT_NO_HIT) == within);
      CHECK(hits[i].t == (within ? 2 : INFINITY));
      CHECK(surfaces[i].position[2] == within);
      if (within) {
        CHECK(surfaces[i].position[0] == x && surfaces[i].position[1] == 0.25);
        CHECK(surfaces[i].normal[2] == 1 && surfaces[i].front == 1);
        CHECK(surfaces[i].primitive == hits[i].primitive && surfaces[i].object == 0);
        CHECK(surfaces[i].material == 0);
        CHECK(fabs(surfaces[i].uv[0] - (x + 1) / 2) < 1e-6);
        CHECK(fabs(surfaces[i].barycentrics[0] + surfaces[i].barycentrics[1] +
                   surfaces[i].barycentrics[2] - 1) < 1e-12);
      }
    }
    /* The hit behind the front is the back, and nothing is behind the back. Writes the results
     * over the input hits. */
    CHECK(mt_next(scene, all, hits, kCount, threads, hits) == MT_OK);
    for (int i = 0; i < kCount; ++i) {
      const float x = all[i].origin[0];
      /* On the diagonal between the front's two triangles, the next hit is the other triangle. */
      const int on_diagonal = fabsf(x) == 0.25F;
      if (x > -1 && x < 1) CHECK(hits[i].t == 3 || (on_diagonal && hits[i].t == 2));
      if (x < -1 || x > 1) CHECK(hits[i].primitive == MT_NO_HIT);
    }
    hits[0].primitive = 7;
    CHECK(mt_next(scene, all + kCount / 2, hits + kCount / 2, 1, threads, hits) == MT_OK);
    CHECK(hits[0].primitive == MT_NO_HIT);
  }
  all[0].t_max = -1;
  CHECK(mt_intersect(scene, all, 1, 0, hits) == MT_OK && hits[0].primitive == MT_NO_HIT);
  CHECK(mt_intersect(scene, NULL, 0, 0, NULL) == MT_OK);
  CHECK(mt_intersect(scene, NULL, 1, 0, hits) == MT_USAGE);
  CHECK(mt_intersect(NULL, all, 1, 0, hits) == MT_USAGE);
  mt_mesh_init(NULL), mt_load_options_init(NULL), mt_render_options_init(NULL);
  CHECK(mt_scene_primitive_count(NULL) == 0 && mt_scene_object_count(NULL) == 0);
  CHECK(mt_scene_object_name(NULL, 0) == NULL && mt_scene_warnings(NULL) == NULL);
  CHECK(mt_film_width(NULL) == 0 && mt_film_height(NULL) == 0 &&
        mt_film_channel_name(NULL, 0) == NULL);
  CHECK(mt_next(scene, all, NULL, 1, 0, hits) == MT_USAGE);
  CHECK(strstr(mt_last_error(), "after") != NULL);
  CHECK(mt_surfaces(scene, all, NULL, 1, 0, surfaces) == MT_USAGE);
  CHECK(strstr(mt_last_error(), "hits") != NULL);
  hits[0].primitive = 12;
  CHECK(mt_next(scene, all, hits, 1, 0, hits) == MT_USAGE);
  CHECK(mt_surfaces(scene, all, hits, 1, 0, surfaces) == MT_USAGE);
  CHECK(strstr(mt_last_error(), "12") != NULL);
  free(all), free(hits), free(occluded), free(surfaces);
}

static void wrong_meshes(void) {
  mt_scene* scene = NULL;
  mt_mesh mesh = cube();
  indices[5][1] = 8;
  CHECK(mt_scene_from_meshes(&mesh, 1, 1, &scene) == MT_INVALID_SCENE && scene == NULL);
  CHECK(strstr(mt_last_error(), "/objects/0/shape/triangles") != NULL);
  indices[5][1] = 5;
  vertices[3][1] = NAN;
  CHECK(mt_scene_from_meshes(&mesh, 1, 1, &scene) == MT_INVALID_SCENE && scene == NULL);
  mesh = cube();
  mesh.positions = NULL;
  CHECK(mt_scene_from_meshes(&mesh, 1, 1, &scene) == MT_USAGE && scene == NULL);
  mesh = cube();
  mesh.size = 3;
  CHECK(mt_scene_from_meshes(&mesh, 1, 1, &scene) == MT_USAGE && scene == NULL);
  mt_mesh two[2] = {cube(), cube()};
  two[1].size = offsetof(mt_mesh, color_stride);
  CHECK(mt_scene_from_meshes(two, 2, 1, &scene) == MT_USAGE && scene == NULL);
  CHECK(strstr(mt_last_error(), "mesh 1") != NULL);
  mesh = cube();
  mesh.indices = NULL; /* 8 vertices are no 12 triangles */
  CHECK(mt_scene_from_meshes(&mesh, 1, 1, &scene) == MT_INVALID_SCENE && scene == NULL);
  mesh.triangle_count = 2;
  CHECK(mt_scene_from_meshes(&mesh, 1, 1, &scene) == MT_OK);
  CHECK(mt_scene_primitive_count(scene) == 2);
  mt_scene_release(scene);
  CHECK(mt_scene_from_meshes(NULL, 0, 1, &scene) == MT_OK);
  CHECK(mt_scene_primitive_count(scene) == 0);
  mt_scene_release(scene);
  CHECK(mt_scene_from_meshes(&mesh, 1, 1, NULL) == MT_USAGE);
}

/* Makes a scene, sets all uvs to `later`, and returns u at the middle of the triangle. */
static double u_at_middle(const mt_mesh* mesh, float* uvs, float later) {
  mt_scene* scene = NULL;
  CHECK(mt_scene_from_meshes(mesh, 1, 1, &scene) == MT_OK);
  for (int i = 0; i < 6; ++i) uvs[i] = later;
  const mt_ray down = ray(0.25F, 0.25F, 1, 0, 0, -1);
  mt_hit hit;
  mt_surface surface;
  CHECK(mt_intersect(scene, &down, 1, 1, &hit) == MT_OK && hit.t == 1);
  CHECK(mt_surfaces(scene, &down, &hit, 1, 1, &surface) == MT_OK);
  mt_scene_release(scene);
  return surface.uv[0];
}

/* To find out whether arrays are borrowed, changes texture coordinates while a scene uses them.
 * The API does not allow this, but the tree does not depend on texture coordinates. */
static void borrowed_arrays(void) {
  const float positions[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const uint16_t corners[3] = {0, 1, 2};
  float uvs[6] = {5, 5, 5, 5, 5, 5};
  mt_mesh mesh;
  mt_mesh_init(&mesh);
  mesh.positions = positions[0];
  mesh.position_count = 3;
  mesh.triangle_count = 1;
  mesh.short_indices = corners;
  mesh.uvs = uvs;
  CHECK(fabs(u_at_middle(&mesh, uvs, 7) - 5) < 1e-6);
  mesh.borrow = 1;
  CHECK(fabs(u_at_middle(&mesh, uvs, 3) - 3) < 1e-6);
  /* An older header lacks these members. Nothing is borrowed, and the triangle has the vertices
   * 0 1 2. */
  mesh.size = offsetof(mt_mesh, short_indices);
  CHECK(fabs(u_at_middle(&mesh, uvs, 9) - 3) < 1e-6);
}

static void colored_vertices(void) {
  const float positions[3][3] = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  const float colors[3][5] = {{0.5F, 1, 0, 1, 0}, {0.5F, 1, 0, 0.5F, 0}, {0.5F, 1, 0, 0.5F, 0}};
  mt_mesh mesh;
  mt_mesh_init(&mesh);
  mesh.positions = positions[0];
  mesh.position_count = 3;
  mesh.triangle_count = 1;
  mesh.colors = colors[0];
  mesh.color_stride = sizeof colors[0];
  mt_scene* scene = NULL;
  CHECK(mt_scene_from_meshes(&mesh, 1, 1, &scene) == MT_OK);
  const mt_camera camera = {{1, 1, 5}, {1, 1, 0}, {0, 1, 0}, 10};
  mt_render_options options;
  mt_render_options_init(&options);
  options.width = options.height = 1;
  options.camera = &camera;
  options.transparent = 1;
  mt_film* film = NULL;
  CHECK(mt_render(scene, &options, &film) == MT_OK);
  float rgba[4];
  CHECK(mt_film_rgba(film, rgba) == MT_OK);
  /* The pixel shows the point with barycentric coordinates (1/2, 1/4, 1/4). */
  CHECK(fabsf(rgba[3] - 0.75F) < 1e-4F && fabsf(rgba[0] - 0.375F) < 1e-4F && rgba[2] == 0);
  mt_film_release(film);
  mt_scene_release(scene);
}

static int32_t cancel(void* user, double fraction) {
  ++*(int*)user;
  return fraction < 0;
}

static int32_t go_on(void* user, double fraction) {
  *(double*)user = fraction;
  return 1;
}

static void pictures(const mt_scene* scene, const char* folder) {
  const mt_camera camera = {{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 45};
  mt_render_options options;
  mt_render_options_init(&options);
  options.width = 64;
  options.height = 48;
  options.camera = &camera;
  options.transparent = 1;
  options.aovs = "depth,id";
  double fraction = 0;
  options.progress = go_on;
  options.user = &fraction;
  mt_film* film = NULL;
  CHECK(mt_render(scene, &options, &film) == MT_OK);
  CHECK(fraction == 1);
  CHECK(mt_film_width(film) == 64 && mt_film_height(film) == 48);
  static float rgba[48][64][4], depth[48][64];
  static uint32_t instance[48][64];
  CHECK(mt_film_rgba(film, rgba[0][0]) == MT_OK);
  CHECK(rgba[24][32][0] == 1 && rgba[24][32][1] == 0.5F && rgba[24][32][2] == 1 &&
        rgba[24][32][3] == 1);
  CHECK(rgba[0][0][3] == 0);
  CHECK(strcmp(mt_film_channel_name(film, 0), "depth.Z") == 0);
  CHECK(strcmp(mt_film_channel_name(film, 1), "id.instance") == 0);
  CHECK(mt_film_channel_name(film, 4) == NULL);
  CHECK(mt_film_channel_floats(film, 0, depth[0]) == MT_OK);
  CHECK(depth[24][32] == 4 && isinf(depth[0][0]));
  CHECK(mt_film_channel_integers(film, 1, instance[0]) == MT_OK);
  CHECK(instance[24][32] == 1 && instance[0][0] == 0);
  CHECK(mt_film_channel_floats(film, 1, depth[0]) == MT_USAGE);
  CHECK(mt_film_channel_integers(film, 9, instance[0]) == MT_USAGE);
  mt_film_release(film);

  options.aovs = NULL;
  options.transparent = 0;
  CHECK(mt_render(scene, &options, &film) == MT_OK);
  char path[1000];
  snprintf(path, sizeof path, "%s/c_api.ppm", folder);
  CHECK(mt_film_save(film, path) == MT_OK);
  CHECK(mt_film_save(film, "/no/such/folder/a.ppm") == MT_IO);
  mt_film_release(film);
  FILE* file = fopen(path, "rb");
  CHECK(file != NULL);
  if (file != NULL) fclose(file);

  film = NULL;
  int calls = 0;
  options.progress = cancel;
  options.user = &calls;
  options.threads = 3;
  CHECK(mt_render(scene, &options, &film) == MT_CANCELED);
  CHECK(film == NULL && calls == 1);
  options.progress = NULL;
  options.aovs = "depth,weight";
  CHECK(mt_render(scene, &options, &film) == MT_USAGE && strstr(mt_last_error(), "weight") != NULL);
  options.aovs = "depth,";
  CHECK(mt_render(scene, &options, &film) == MT_USAGE);
  options.aovs = NULL;
  options.integrator = 77;
  CHECK(mt_render(scene, &options, &film) == MT_USAGE);
  options.integrator = MT_PATH;
  options.samples = 2;
  CHECK(mt_render(scene, &options, &film) == MT_OK);
  CHECK(mt_film_rgba(film, rgba[0][0]) == MT_OK);
  mt_film_release(film);
  options.bsdf = MT_SPEC;
  CHECK(mt_render(scene, &options, &film) == MT_OK);
  static float spec[48][64][4];
  CHECK(mt_film_rgba(film, spec[0][0]) == MT_OK);
  CHECK(memcmp(rgba, spec, sizeof spec) != 0);
  mt_film_release(film);
  options.bsdf = 2;
  CHECK(mt_render(scene, &options, &film) == MT_USAGE);
  options.bsdf = MT_CONSERVING;
  options.guiding = 1;
  CHECK(mt_render(scene, &options, &film) == MT_OK);
  static float guided[48][64][4];
  CHECK(mt_film_rgba(film, guided[0][0]) == MT_OK);
  CHECK(memcmp(rgba, guided, sizeof guided) != 0);
  mt_film_release(film);
  options.guiding = 0;
  const mt_camera blind = {{0, 0, 5}, {0, 0, 5}, {0, 1, 0}, 45};
  options.camera = &blind;
  CHECK(mt_render(scene, &options, &film) == MT_USAGE);
  const mt_camera flat = {{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 180};
  options.camera = &flat;
  CHECK(mt_render(scene, &options, &film) == MT_USAGE);
  CHECK(strstr(mt_last_error(), "between 0 and 180 degrees, is 180") != NULL);
  options.size = 0;
  CHECK(mt_render(scene, &options, &film) == MT_USAGE);
}

static void files(const char* folder) {
  char path[1000];
  mt_scene* scene = NULL;
  snprintf(path, sizeof path, "%s/perspective1.json", folder);
  CHECK(mt_scene_load(path, NULL, &scene) == MT_OK);
  const char* const name = mt_scene_object_name(scene, 0);
  CHECK(mt_scene_object_count(scene) > 0 && name != NULL && strcmp(name, "s1") == 0);
  CHECK(mt_scene_object_name(scene, 1) != NULL && mt_scene_object_name(scene, 0) == name);
  CHECK(mt_scene_object_name(scene, 1000) == NULL);
  CHECK(strcmp(mt_scene_warnings(scene), "") == 0);
  mt_film* film = NULL;
  CHECK(mt_render(scene, NULL, &film) == MT_OK);
  mt_film_release(film);
  mt_scene_release(scene);
  scene = NULL;
  CHECK(mt_scene_load("no_such_file.json", NULL, &scene) == MT_IO && scene == NULL);
  CHECK(strstr(mt_last_error(), "no_such_file.json") != NULL);
  CHECK(mt_scene_parse("{", 1, NULL, NULL, &scene) == MT_INVALID_SCENE && scene == NULL);
  mt_load_options options;
  mt_load_options_init(&options);
  options.size = sizeof options + 8; /* of a header that is newer than the library */
  CHECK(mt_scene_load(path, &options, &scene) == MT_USAGE);
  mt_scene_release(NULL);
  mt_film_release(NULL);
}

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  CHECK(strcmp(mt_version(), MICROTRACE_VERSION_TEXT) == 0);
  CHECK(strcmp(mt_last_error(), "") == 0);
  mt_scene* scene = NULL;
  const mt_mesh mesh = cube();
  CHECK(mt_scene_from_meshes(&mesh, 1, 1, &scene) == MT_OK);
  CHECK(mt_scene_primitive_count(scene) == 12 && mt_scene_object_count(scene) == 1);
  memset(vertices, 0, sizeof vertices); /* the scene has copies */
  rays(scene);
  pictures(scene, argv[2]);
  mt_scene_release(scene);
  wrong_meshes();
  borrowed_arrays();
  colored_vertices();
  files(argv[1]);
  printf("%d failures\n", failures);
  return failures != 0;
}
