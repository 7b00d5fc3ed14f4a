#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# reuse_object.sh COMPILER ARGUMENTS...: a compiler launcher for a project that takes StreamKernel in by add_subdirectory, and
# builds it in $SK_TAKEN_IN. Where StreamKernel's own build, in $SK_OWN_BUILD, has run the same command on the same text, its object file
# is copied; everything else is compiled.
set -euo pipefail
build=$SK_OWN_BUILD folder=$SK_TAKEN_IN

# The command as compile_commands.json of BUILD has it: with that build's folders, and without what writes a list of dependencies.
command='' object='' source='' last=''
for argument in "$@"; do
  case $last in
    -o) object=$argument ;;
    -c) source=$argument ;;
  esac
  case $argument in
    -MD | -MT | -MF) ;;
    *) [[ $last == -MT || $last == -MF ]] || command+=" $argument" ;;
  esac
  last=$argument
done
command=${command//"$folder/"/"$build/"}
command=${command//" ${folder##*/}/"/" "}   # the object's name, from where the compiler runs
command=${command//\"/\\\\\\\"}
own=$build/${object#"${folder##*/}/"}
if [[ $source && $object && -f $own && -f $build/compile_commands.json ]] &&
   cmp -s "$source" "${source/#"$folder/"/"$build/"}" &&
   grep -qF -- "${command# }\"," "$build/compile_commands.json"; then
  exec cp "$own" "$object"
fi
exec "$@"
