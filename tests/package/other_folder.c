/* Changes the current folder before the library loads its first module. */
#include <microtrace/microtrace.h>
#include <stdio.h>
#include <unistd.h>

int main(int argc, char** argv) {
  mt_scene* scene = NULL;
  if (argc != 2 || chdir("/") != 0) return 2;
  if (mt_scene_load(argv[1], NULL, &scene) != MT_OK) {
    (void)fprintf(stderr, "%s\n", mt_last_error());
    return 1;
  }
  mt_scene_release(scene);
  return 0;
}
