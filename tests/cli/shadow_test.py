# SPDX-License-Identifier: MIT
#
# shadow_test.py SOURCE [REPORT...]: the sample reports, or these, are what their schema says; docs/json.md has every member of the
# schema and no other. Samples use each member, so that the page and `sk shadow`, which are tested with them, see all.
import copy
import glob
import json
import os
import re
import sys

import jsonschema

source = os.path.realpath(sys.argv[1])
samples = sorted(glob.glob(os.path.join(source, "tests/cli/shadow/*.json")))

with open(os.path.join(source, "docs/shadow.schema.json")) as file:
    schema = json.load(file)
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)


def strict(rule):
    """The schema of a report that has no members but those that are described."""
    rule = copy.deepcopy(rule)
    for part in [rule, *rule["$defs"].values()]:
        if "properties" in part:
            part["additionalProperties"] = False
    return rule


def mistakes(path, judge):
    with open(path) as file:
        return [f"{os.path.basename(path)}: {error.json_path}: {error.message[:200]}" for error in judge.iter_errors(json.load(file))]


def undocumented():
    """Where docs/json.md and the schema differ."""
    with open(os.path.join(source, "docs/json.md")) as file:
        parts = re.split(r"^#+ (.+)$", file.read(), flags=re.M)
    told = {title: set(re.findall(r"^\| `(\w+)` \|", text, flags=re.M)) for title, text in zip(parts[1::2], parts[2::2])}
    types = {name: rule for name, rule in schema["$defs"].items() if "properties" in rule} | {"Report": schema}
    for name, rule in types.items():
        for member in set(rule["properties"]) ^ told.get(name, set()):
            yield f"docs/json.md and docs/shadow.schema.json differ in {name}: {member}"


def unused(texts):
    """Members of the schema that no sample has, and kinds that none is."""
    for name, rule in [("Report", schema), *schema["$defs"].items()]:
        for member in rule.get("properties", {}):
            if f'"{member}":' not in texts:
                yield f"no sample has {name}.{member}"


if named := sys.argv[2:]:
    bad = [mistake for path in named for mistake in mistakes(path, validator)]
else:
    texts = {path: open(path).read() for path in samples}
    bad = list(undocumented()) + list(unused("".join(texts.values())))
    exact = jsonschema.Draft202012Validator(strict(schema))
    for path, text in texts.items():
        # ranks.json has a member of a later version; all others have no member too many.
        bad += mistakes(path, validator if "laterMember" in text else exact)
    # The test can fail: a member too few, a number as a text, a kind that there is not, a point too short.
    with open(os.path.join(source, "tests/cli/shadow/exceptional.json")) as file:
        sample = json.load(file)
    for spoil in (lambda one: one.pop("seconds"), lambda one: one["kernels"][0].update(share="much"), lambda one: one["verdicts"][0].update(kind="bad"),
                  lambda one: one["streams"][0]["points"][0].pop(), lambda one: one.update(version=2)):
        spoilt = copy.deepcopy(sample)
        spoil(spoilt)
        assert list(validator.iter_errors(spoilt)), "the schema takes what it should not"
    assert "laterMember" in "".join(texts.values()) and not list(validator.iter_errors(sample | {"laterMember": 1}))

for mistake in bad:
    print(mistake)
print(f"{len(named or samples)} reports, {len(bad)} mistakes")
sys.exit(1 if bad or not (named or samples) else 0)
