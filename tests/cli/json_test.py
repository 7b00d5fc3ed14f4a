# SPDX-License-Identifier: MIT
#
# json_test.py SKC SOURCE FILE...: what skc prints as JSON for these .sk files, or for all of a folder, is what its schema
# says, and refers to nothing that is not there; docs/json.md has every member of the schema and no other.
import concurrent.futures
import json
import os
import re
import subprocess
import sys

import jsonschema

sys.path.append(os.path.join(os.path.dirname(__file__), "../support"))
import sk_files

skc, source = sys.argv[1], os.path.realpath(sys.argv[2])
named = sys.argv[3:]

with open(os.path.join(source, "docs/skc.schema.json")) as file:
    schema = json.load(file)
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)
# Which list an index is of, for the members that are indices.
lists = {"KernelIndex": "kernels", "ElementIndex": "elements"}


def indices(value, rule):
    """All indices in a valid value, with the names of their lists."""
    reference = rule.get("$ref", "").removeprefix("#/$defs/")
    if reference in lists:
        yield lists[reference], value
    elif reference:
        yield from indices(value, schema["$defs"][reference])
    elif "anyOf" in rule and value is not None:
        yield from indices(value, rule["anyOf"][1])
    elif "items" in rule:
        for item in value:
            yield from indices(item, rule["items"])
    elif "properties" in rule:
        for name, part in rule["properties"].items():
            yield from indices(value[name], part)


def mistakes(file):
    """What is wrong with the JSON of a file; None for a file without kernels, which others include."""
    result = subprocess.run([skc, "--emit=json", *sk_files.options(source), file], capture_output=True, text=True)
    if result.returncode:
        return None if "declares no kernel, no reduce and no scan" in result.stderr else [result.stderr]
    text = json.loads(result.stdout)
    found = [f"{error.json_path}: {error.message[:200]}" for error in validator.iter_errors(text)]
    if found:
        return found
    return [f"{name} has no index {i}" for name, i in indices(text, schema) if i >= len(text[name])]


def undocumented():
    """Where docs/json.md and the schema differ."""
    with open(os.path.join(source, "docs/json.md")) as file:
        parts = re.split(r"^#+ (.+)$", file.read(), flags=re.M)
    told = {title: set(re.findall(r"^\| `(\w+)` \|", text, flags=re.M)) for title, text in zip(parts[1::2], parts[2::2])}
    types = {name: rule for name, rule in schema["$defs"].items() if "properties" in rule}
    types["The file"] = schema
    for name, rule in types.items():
        for member in set(rule["properties"]) ^ told.get(name, set()):
            yield f"docs/json.md and docs/skc.schema.json differ in {name}: {member}"


bad = list(undocumented())
# The test can fail: a member too many, and one too few.
sample = {name: [] for name in schema["properties"]} | {"schema": 4, "file": "a.sk"}
assert not list(validator.iter_errors(sample))
assert list(validator.iter_errors(sample | {"another": 1}))
assert list(validator.iter_errors({name: value for name, value in sample.items() if name != "kernels"}))

checked = 0
with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    paths = list(sk_files.files(source, named))
    for path, found in zip(paths, pool.map(mistakes, paths)):
        checked += found is not None
        bad += [f"{os.path.relpath(path, source)}: {mistake}" for mistake in found or []]
for mistake in bad:
    print(mistake)
print(f"{checked} files, {len(bad)} mistakes")
sys.exit(1 if bad or not checked else 0)
