# SPDX-License-Identifier: MIT
#
# types_test.py SKC SOURCE BUILD: the npm package knows each scalar, vector and matrix type of the language under the language's own name:
# its elements have the planes that skc gives them, and TypeScript knows their arrays and values.
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

import package

skc, source, build = (os.path.realpath(argument) for argument in sys.argv[1:4])


def types_of_language():
    """(name, scalar, components) of every type, by the compiler's table of scalars."""
    with open(f"{source}/compiler/ir/scalars.def") as table:
        scalars = re.findall(r'^SKC_SCALAR\(\w+, "(\w+)"', table.read(), flags=re.M)
    for scalar in scalars:
        yield scalar, scalar, 1
        for width in (2, 3, 4):
            yield f"{scalar}{'x' if scalar[-1].isdigit() else ''}{width}", scalar, width
    for size in (2, 3, 4):
        yield f"float{size}x{size}", "float", size * size


def elements_and_arrays(names, folder):
    """For each type: the element that the module has, the package's, and the type of its array on the host."""
    script = f"""
      import {{ builtInElement, newArrays }} from './streamkernel/elements.js';
      const known = {json.dumps(names)}.map((name) => {{
        const element = builtInElement(name);
        return [name, {{ element, array: newArrays(element, 1).constructor.name }}];
      }});
      console.log(JSON.stringify(Object.fromEntries(known)));
    """
    result = subprocess.run(["node", "--input-type=module", "-e", script], cwd=folder, capture_output=True, text=True)
    if result.returncode:
        sys.exit(result.stderr)
    return json.loads(result.stdout)


def declared_elements(folder):
    with open(f"{folder}/types.sk.js") as module:
        file = json.loads(re.search(r"\$sk\.fileOf\((.*), \$programs", module.read()).group(1))
    return {element["name"]: element for element in file["elements"]}


def program(types, arrays):
    """TypeScript that uses every type, and that does not compile where one has an array or value of another type."""
    lines = ["import type * as sk from 'streamkernel';", "import * as module from './types.sk.js';",
             "type Same<A, B> = (<T>() => T extends A ? 1 : 2) extends (<T>() => T extends B ? 1 : 2) ? true : false;",
             "export function use(device: sk.Device) {"]
    for name, scalar, count in types:
        number = {"bool": "boolean", "long": "bigint", "ulong": "bigint"}.get(scalar, "number")
        value = number if count == 1 else f"readonly [{', '.join([number] * count)}]"
        if re.fullmatch(r"float\dx\d", name):
            value = "readonly number[]"
        lines += [f"  {{ const stream = device.stream('{name}', [1]);",
                  f"    module.copy_{name}(stream, stream);",
                  f"    const array: Same<sk.ArrayOf<'{name}'>, {arrays[name]}> = true;",
                  f"    const value: Same<sk.Value<'{name}'>, {value}> = true;",
                  f"    module.fill_{name}({{}} as {value}, stream); void [array, value]; }}"]
    return "\n".join([*lines, "}", ""])


package.need()
if not shutil.which("node"):
    print("skipped: node is not installed; './dev test web' installs it")
    sys.exit(package.skipped)
types = list(types_of_language())
names = [name for name, _, _ in types]
with tempfile.TemporaryDirectory() as folder:
    package.build(source, f"{folder}/streamkernel", build)
    with open(f"{folder}/streamkernel/package.json", "w") as marker:
        marker.write('{"type": "module"}')
    with open(f"{folder}/types.sk", "w") as kernels:
        for name in names:
            kernels.write(f"kernel void copy_{name}({name} x<>, out {name} r<>) {{ r = x; }}\n"
                          f"kernel void fill_{name}({name} c, out {name} r<>) {{ r = c; }}\n")
    subprocess.run([skc, "--emit=js", "-o", folder, f"{folder}/types.sk"], check=True)
    known, declared = elements_and_arrays(names, folder), declared_elements(folder)
    for name in names:
        if known[name]["element"] != declared[name]:
            sys.exit(f"{name}: the package has {known[name]['element']}, skc writes {declared[name]}")
    with open(f"{folder}/program.ts", "w") as text:
        text.write(program(types, {name: known[name]["array"] for name in names}))
    package.check_types([f"{folder}/program.ts"], folder)
print(f"{len(names)} types")
