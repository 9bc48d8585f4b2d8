# Fails if an object of a SIMD path defines a weak or unique symbol outside the path's namespace, which the
# linker could hand to code that runs on machines without these instructions.
# cmake -DNM=nm -DOBJECTS=a;b -DSCOPE=glint::isa::avx2:: -P shared_symbols.cmake
# SPDX-License-Identifier: Apache-2.0
# Long names are left mangled by nm; a DW.ref is the address of a routine for exceptions, no code.
string(REGEX REPLACE ".*::([a-z0-9]+)::$" "\\1" path "${SCOPE}")
string(LENGTH "${path}" length)
set(mangled "_ZNK?5glint3isa${length}${path}")
list(FILTER OBJECTS INCLUDE REGEX "\\.o$")  # a target has its precompiled headers, too
foreach(object ${OBJECTS})
  execute_process(COMMAND ${NM} -C ${object} OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "[^\n]* [WVu] [^\n]*" shared "${symbols}")
  foreach(symbol ${shared})
    if(NOT symbol MATCHES " [WVu] ([^\n]*${SCOPE}|${mangled}|DW\\.ref\\.)")
      message(SEND_ERROR "${object} shares '${symbol}'")
    endif()
  endforeach()
endforeach()
