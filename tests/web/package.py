# SPDX-License-Identifier: MIT
#
# Builds the npm package of runtime/web by TypeScript's compiler, and checks types.
import glob
import gzip
import json
import os
import shutil
import subprocess
import sys
import tempfile

skipped = 77
tsc = shutil.which("tsc")


def need():
    if not tsc:
        print("skipped: tsc is not installed; './dev test web' installs it")
        sys.exit(skipped)


def run(*arguments):
    result = subprocess.run([tsc, *arguments], capture_output=True, text=True)
    if result.returncode:
        sys.exit(f"tsc {' '.join(arguments)}\n{result.stdout}{result.stderr}")


def build(source, folder, built=None):
    """The package's modules and types: those of this build folder if it has them (--target web_package), as TypeScript's compiler takes
    some seconds."""
    dist = os.path.join(built or "", "share/streamkernel/package/dist")
    if built and os.path.exists(dist):
        shutil.copytree(dist, folder)
        return
    need()
    run("-p", os.path.join(source, "runtime/web"), "--outDir", folder)
    page = ["-D", f"IN={source}/runtime/src/shadow/report", "-D", f"OUT={folder}/shadow/page.js"]
    subprocess.run(["cmake", *page, "-P", f"{source}/cmake/SkEmbedPage.cmake"], check=True)


def gzipped(source):
    """Bytes of all modules of the package together, without comments."""
    with tempfile.TemporaryDirectory() as folder:
        run("-p", os.path.join(source, "runtime/web"), "--outDir", folder, "--removeComments", "--declaration", "false")
        modules = b""
        for name in sorted(glob.glob(f"{folder}/**/*.js", recursive=True)):
            with open(name, "rb") as module:
                modules += module.read()
    return len(gzip.compress(modules))


# What an application imports from the package, itself or by FILE.sk.js.
uses = {
    "kernels": "Device, fileOf",
    "kernels and reduces": "Device, fileOf, folds",
    "everything": "*",
}


def minified(modules, build):
    """Bytes of the package as bundlers ship it, minified and gzipped, for each of `uses`, and of what device.shadow() loads later;
    `modules` is what build() wrote. None where npm has not fetched esbuild (--target playground_editor)."""
    esbuild = os.path.join(build, "runtime/web/editor/node_modules/.bin/esbuild")
    if not os.path.exists(esbuild):
        return None
    sizes = {}
    for use, names in uses.items():
        with tempfile.TemporaryDirectory() as folder:
            what = names if names == "*" else f"{{ {names} }}"
            command = [esbuild, "--bundle", "--minify", "--format=esm", "--splitting", f"--outdir={folder}", f"--metafile={folder}/meta.json"]
            subprocess.run(command, input=f"export {what} from './index.js';".encode(), cwd=modules, capture_output=True, check=True)
            with open(f"{folder}/meta.json") as meta:
                outputs = {os.path.basename(name): output for name, output in json.load(meta)["outputs"].items()}
            # A module is loaded with the page unless an import() asks for it.
            later = {os.path.basename(each["path"]) for output in outputs.values() for each in output["imports"] if each["kind"] == "dynamic-import"}

            def size(names):
                texts = [open(f"{folder}/{name}", "rb").read() for name in sorted(names)]
                return len(gzip.compress(b"".join(texts)))

            sizes[use] = size(outputs.keys() - later)
            sizes["a shadow"] = size(name for name in later if name.startswith("shadow"))
    return {use: sizes[use] for use in [*uses, "a shadow"]}


def check_types(files, folder):
    """Checks TypeScript files of this folder, which has the package in streamkernel/."""
    settings = {
        "compilerOptions": {
            **{"target": "ES2020", "module": "ES2020", "moduleResolution": "node", "lib": ["ES2021", "DOM"], "types": []},
            **{"strict": True, "noEmit": True, "skipDefaultLibCheck": True, "baseUrl": ".", "paths": {"streamkernel": ["streamkernel/index"]}},
        },
        "files": files,
    }
    with open(os.path.join(folder, "tsconfig.json"), "w") as config:
        json.dump(settings, config)
    run("-p", folder)
