# The fuzzed formats. For each format, this folder contains FORMAT_fuzz.cpp, and make_seeds.py writes seeds.
set(fuzz_formats json_scene gltf image checkpoint)
list(TRANSFORM fuzz_formats PREPEND fuzz_ OUTPUT_VARIABLE fuzz_targets)
