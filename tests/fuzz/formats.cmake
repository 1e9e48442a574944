# The fuzzed formats: each has a target FORMAT_fuzz.cpp here and seeds by make_seeds.py.
set(fuzz_formats json_scene gltf image checkpoint)
list(TRANSFORM fuzz_formats PREPEND fuzz_ OUTPUT_VARIABLE fuzz_targets)
