/* Makes scenes of instances by the C API and compares them with scenes of transformed copies. */
#include "check.h"

#include <microtrace/microtrace.h>

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { kRings = 24, kSides = 32, kVertices = kRings * kSides, kTriangles = 2 * kVertices };

/* A torus, whose vertices and quadrilaterals wrap around in both directions. */
static float positions[kVertices][3];
static uint32_t indices[kTriangles][3];

static mt_mesh torus(void) {
  for (uint32_t i = 0; i < kRings; ++i) {
    for (uint32_t k = 0; k < kSides; ++k) {
      const double a = 6.283185307179586 * i / kRings, b = 6.283185307179586 * k / kSides;
      const uint32_t row = i * kSides, next_row = (i + 1) % kRings * kSides,
                     next = (k + 1) % kSides;
      const uint32_t two[2][3] = {{row + k, row + next, next_row + k},
                                  {row + next, next_row + next, next_row + k}};
      positions[row + k][0] = (float)((1 + 0.4 * cos(b)) * cos(a));
      positions[row + k][1] = (float)(0.4 * sin(b));
      positions[row + k][2] = (float)((1 + 0.4 * cos(b)) * sin(a));
      memcpy(indices[2 * (row + k)], two, sizeof two);
    }
  }
  mt_mesh mesh;
  mt_mesh_init(&mesh);
  mesh.positions = positions[0];
  mesh.position_count = kVertices;
  mesh.indices = indices[0];
  mesh.triangle_count = kTriangles;
  mesh.base_color[2] = 0.25F;
  return mesh;
}

enum { kPlaces = 9 };

/* Rows of turned, sheared, mirrored and scaled tori. */
static void place(mt_instance* instances) {
  for (int i = 0; i < kPlaces; ++i) {
    const double c = cos(i), s = sin(i), size = 0.5 + 0.1 * i;
    const double rows[3][4] = {{size * c, 0.1 * i, -size * s, 2.1 * (i % 3) - 2},
                               {0, i % 2 ? -size : size, 0.2, 0.3 * i - 1},
                               {size * s, 0, size * c, 2.1 * (i / 3) - 2}};
    memcpy(instances[i].scene_from_mesh, rows, sizeof rows);
    instances[i].mesh = 0;
  }
}

/* Returns a mesh with the vertices that docs/exactness.md states, in `moved`. */
static mt_mesh copy_of(const mt_mesh* mesh, const mt_instance* instance, float (*moved)[3],
                       uint32_t (*corners)[3], int is_mirrored) {
  for (int i = 0; i < kVertices; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double* row = instance->scene_from_mesh[axis];
      const double xy = row[0] * positions[i][0] + row[1] * positions[i][1];
      const double z = row[2] * positions[i][2] + row[3];
      moved[i][axis] = (float)(xy + z);
    }
  }
  for (int i = 0; i < kTriangles; ++i) {
    corners[i][0] = indices[i][0];
    corners[i][1] = indices[i][is_mirrored ? 2 : 1];
    corners[i][2] = indices[i][is_mirrored ? 1 : 2];
  }
  mt_mesh result = *mesh;
  result.positions = moved[0];
  result.indices = corners[0];
  return result;
}

static void compare(const mt_scene* a, const mt_scene* b) {
  enum { kCount = 20000 };
  mt_ray* rays = malloc(kCount * sizeof *rays);
  mt_hit* hits = malloc(2 * kCount * sizeof *hits);
  mt_surface* surfaces = malloc(2 * kCount * sizeof *surfaces);
  uint32_t state = 1;
  for (int i = 0; i < kCount; ++i) {
    float numbers[6];
    for (int k = 0; k < 6; ++k) {
      state = state * 1664525U + 1013904223U; /* Numerical Recipes, section 7.1 */
      numbers[k] = (float)(state >> 8U) / 0x1p23F - 1;
    }
    const mt_ray ray = {
        {4 * numbers[0], 6, 4 * numbers[1]}, 0, {numbers[2], -3, numbers[3]}, INFINITY};
    rays[i] = ray;
  }
  CHECK(mt_intersect(a, rays, kCount, 2, hits) == MT_OK);
  CHECK(mt_intersect(b, rays, kCount, 2, hits + kCount) == MT_OK);
  CHECK(memcmp(hits, hits + kCount, kCount * sizeof *hits) == 0);
  CHECK(mt_surfaces(a, rays, hits, kCount, 2, surfaces) == MT_OK);
  CHECK(mt_surfaces(b, rays, hits, kCount, 2, surfaces + kCount) == MT_OK);
  int found = 0, last = 0;
  for (int i = 0; i < kCount; ++i) {
    if (hits[i].primitive == MT_NO_HIT) continue;
    ++found;
    last += surfaces[i].object == kPlaces - 1;
    CHECK(surfaces[i].object == hits[i].primitive / kTriangles);
    CHECK(surfaces[i].object == surfaces[kCount + i].object);
    CHECK(memcmp(surfaces[i].position, surfaces[kCount + i].position, sizeof surfaces->position) ==
          0);
    CHECK(surfaces[i].front == surfaces[kCount + i].front);
  }
  CHECK(found > kCount / 4 && found < kCount && last > 100);
  free(rays), free(hits), free(surfaces);
}

static void equals_copies(const mt_mesh* mesh, const mt_instance* instances) {
  mt_scene *placed = NULL, *copied = NULL;
  CHECK(mt_scene_from_instances(mesh, 1, instances, kPlaces, 1, &placed) == MT_OK);
  mt_mesh copies[kPlaces];
  float(*moved)[3] = malloc(sizeof positions * kPlaces);
  uint32_t(*corners)[3] = malloc(sizeof indices * kPlaces);
  for (int i = 0; i < kPlaces; ++i)
    copies[i] = copy_of(mesh, &instances[i], moved + (size_t)i * kVertices,
                        corners + (size_t)i * kTriangles, i % 2);
  CHECK(mt_scene_from_meshes(copies, kPlaces, 1, &copied) == MT_OK);
  CHECK(mt_scene_object_count(placed) == kPlaces);
  CHECK(mt_scene_primitive_count(placed) == kPlaces * kTriangles);
  compare(placed, copied);
  mt_scene_release(placed);
  mt_scene_release(copied);
  free(moved), free(corners);
}

static void wrong_instances(const mt_mesh* mesh, const mt_instance* instances) {
  mt_scene* scene = NULL;
  mt_instance wrong[2] = {instances[0], instances[1]};
  wrong[1].mesh = 1;
  CHECK(mt_scene_from_instances(mesh, 1, wrong, 2, 1, &scene) == MT_INVALID_SCENE && scene == NULL);
  CHECK(strstr(mt_last_error(), "instance 1") != NULL);
  wrong[1] = instances[1];
  wrong[1].scene_from_mesh[2][3] = NAN;
  CHECK(mt_scene_from_instances(mesh, 1, wrong, 2, 1, &scene) == MT_INVALID_SCENE && scene == NULL);
  CHECK(strstr(mt_last_error(), "finite") != NULL);
  mt_mesh unused[2] = {mesh[0], mesh[0]};
  unused[1].roughness = -1;
  CHECK(mt_scene_from_instances(unused, 2, instances, 1, 1, &scene) == MT_INVALID_SCENE);
  CHECK(strstr(mt_last_error(), "/materials/1") != NULL && scene == NULL);
  unused[1] = mesh[0];
  unused[1].position_count = 1;
  CHECK(mt_scene_from_instances(unused, 2, instances, 1, 1, &scene) == MT_INVALID_SCENE);
  CHECK(strstr(mt_last_error(), "/objects/1") != NULL && scene == NULL);
  CHECK(mt_scene_from_instances(mesh, 1, NULL, 2, 1, &scene) == MT_USAGE && scene == NULL);
  CHECK(mt_scene_from_instances(mesh, 1, wrong, (size_t)-1 / 512, 1, &scene) == MT_LIMIT &&
        scene == NULL);
  CHECK(mt_scene_from_instances(NULL, 1, wrong, 2, 1, &scene) == MT_USAGE && scene == NULL);
  CHECK(mt_scene_from_instances(NULL, 0, NULL, 0, 1, &scene) == MT_OK);
  CHECK(mt_scene_primitive_count(scene) == 0);
  mt_scene_release(scene);
}

int main(void) {
  const mt_mesh mesh = torus();
  mt_instance instances[kPlaces];
  place(instances);
  equals_copies(&mesh, instances);
  wrong_instances(&mesh, instances);
  printf("%d failures\n", failures);
  return failures != 0;
}
