# usage: cmake -DROOT=folder -DLIST=file -DVERSION=number -DOUTPUT=file -P plugin_stamp.cmake
#
# Writes a source that defines glint_plugin_stamp (base/plugin_stamp.h): the version and a hash of the headers that
# LIST names. The file changes only when a header does.
cmake_minimum_required(VERSION 3.25)
file(STRINGS ${LIST} headers)
foreach(header ${headers})
  file(SHA256 ${header} hash)
  file(RELATIVE_PATH name ${ROOT} ${header})
  string(APPEND all "${name} ${hash}\n")
endforeach()
string(SHA256 stamp "${all}")
string(SUBSTRING ${stamp} 0 16 stamp)
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [=[
// Holds the stamp of the headers that were installed with this file. cmake/plugin_stamp.cmake wrote it.
// SPDX-License-Identifier: Apache-2.0
#include "base/plugin_stamp.h"

extern "C" [[gnu::used]] const char glint_plugin_stamp[] = "glint-plugin-stamp:@VERSION@:@stamp@";
]=] @ONLY)
