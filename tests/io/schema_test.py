"""Checks that the JSON Schema and the loader accept and reject the same files.

usage: schema_test.py SCENE_VERDICT SOURCE_DIR
"""

import json
import pathlib
import subprocess
import sys

import jsonschema

# Files that violate rules that JSON Schema can't express. The schema accepts them, but the loader must reject them.
BEYOND_SCHEMA = {
    "calibrated_extrinsic_mirrored": "a determinant",
    "calibrated_extrinsic_scaled": "products of members",
    "camera_name_taken": "names are unique",
    "color_hexadecimal": "a name refers to a member elsewhere",
    "color_name_unknown": "a name refers to a member elsewhere",
    "color_name_without_table": "a name refers to a member elsewhere",
    "environment_file_missing": "a file exists",
    "image_too_many_pixels": "a product of two members",
    "key_twice": "keys are unique",
    "key_twice_deep": "keys are unique",
    "light_name_taken": "names are unique",
    "light_spot_inner_outside": "a relation of two members",
    "material_unknown": "a name refers to a member elsewhere",
    "material_without_table": "a name refers to a member elsewhere",
    "mesh_directory": "a file exists",
    "mesh_file_hostile": "a file exists",
    "mesh_missing": "a file exists",
    "mesh_not_gltf": "the contents of another file",
    "name_like_a_pointer_taken": "names are unique",
    "object_name_taken": "names are unique",
    "surrogate_alone": "well-formed UTF-16 within a string",
    "up_almost_parallel": "a product of two members",
    "up_default_parallel": "a product of two members",
    "up_parallel": "a product of two members",
}


def no_constant(name):
    raise ValueError(f"{name} is not JSON")


def schema_accepts(validator, path):
    try:
        text = path.read_bytes().decode("utf-8-sig")
        instance = json.loads(text, parse_constant=no_constant)
    except (ValueError, RecursionError):
        return False
    return validator.is_valid(instance)


def loader_verdicts(program, paths):
    """Returns {path: accepted}, parsed from lines of the form `accept PATH` or `reject PATH`."""
    lines = subprocess.run([program, *map(str, paths)], check=True, capture_output=True, text=True).stdout
    verdicts = {}
    for line in lines.splitlines():
        verdict, path = line.split(" ", 1)
        verdicts[pathlib.Path(path)] = {"accept": True, "reject": False}[verdict]
    return verdicts


def main(program, source):
    schema = json.loads((source / "docs/scene.schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)

    good = sorted((source / "tests/io/good").glob("*.json")) + sorted((source / "scenes").rglob("*.json"))
    bad = sorted((source / "tests/io/bad").glob("*.json"))
    good = [path for path in good if "gltf" not in path.relative_to(source).parts]
    verdicts = loader_verdicts(program, good + bad)

    failures = []
    def check(condition, path, message):
        if not condition:
            failures.append(f"{path.relative_to(source)}: {message}")

    for path in good:
        check(schema_accepts(validator, path), path, "the schema rejects it")
        check(verdicts[path], path, "the loader rejects it")
    for path in bad:
        beyond = path.stem in BEYOND_SCHEMA
        check(schema_accepts(validator, path) == beyond, path,
              "the schema rejects it, though it is listed as beyond it" if beyond else "the schema accepts it")
        check(not verdicts[path], path, "the loader accepts it")
    for name in BEYOND_SCHEMA.keys() - {path.stem for path in bad}:
        failures.append(f"{name}: listed as beyond the schema, but there is no such file")
    if len(good) < 30 or len(bad) < 100:
        failures.append(f"only {len(good)} good and {len(bad)} bad files were found")

    print("\n".join(failures) or f"{len(good)} good and {len(bad)} bad files: schema and loader agree")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], pathlib.Path(sys.argv[2])))
