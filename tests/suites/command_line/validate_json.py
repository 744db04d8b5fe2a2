"""Validates JSON objects, one per file or one per line, against a schema: exit 0 if all hold.

usage: validate_json.py SCHEMA JSON
Top-level keys that the schema does not name are errors, too: what is printed is documented.
"""
import json
import sys

import jsonschema


def documented_keys(schema):
    keys = set(schema.get("properties", {}))
    for part in schema.get("allOf", []):
        keys |= documented_keys(part)
    return keys


def objects(path):
    text = open(path, encoding="utf-8").read()
    try:
        return [json.loads(text)]
    except json.JSONDecodeError:
        return [json.loads(line) for line in text.splitlines()]


schema = json.load(open(sys.argv[1], encoding="utf-8"))
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)
problems = []
for found in objects(sys.argv[2]):
    problems += [f"{error.json_path}: {error.message}" for error in validator.iter_errors(found)]
    problems += [f"undocumented key {key}" for key in sorted(set(found) - documented_keys(schema))]
print("\n".join(problems))
sys.exit(1 if problems else 0)
