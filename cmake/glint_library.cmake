# glint_library(name FLOORS subfolder... DEPENDS folder... LINKS target... POLICIES subfolder...)
#
# Makes one static library of a folder, alias glint::<name>, with the project's flags and header checks. Its sources
# and headers are the files of its folder and of its FLOORS, so a file is found where it lies and is in no list.
# DEPENDS are folders of ours. LINKS are libraries from packages; the folder's users see them only if its headers
# include them. POLICIES are folders in which each file registers one policy and nothing else refers to it; the archive
# of the rest is then glint_<name>_mechanism. PRECOMPILE, in `base`, are its headers that are parsed once for all folders
# (glint_precompile); headers of other folders cost more to write and to load than to parse. COLD says that the folder
# takes no part in the machines' loops: it is optimised for a quick build. COLDEST says that it only reads requests and
# writes results, which takes milliseconds of a run: little is optimised. With GLINT_UNITY several files of a folder are
# compiled at a time, except policies: names in anonymous namespaces are therefore unique within a folder.
function(glint_library name)
  cmake_parse_arguments(ARG "COLD;COLDEST" "" "FLOORS;DEPENDS;LINKS;POLICIES;PRECOMPILE" ${ARGN})
  list(TRANSFORM ARG_DEPENDS PREPEND glint::)
  glint_glob(sources *.cpp . ${ARG_FLOORS})
  glint_glob(headers *.h . ${ARG_FLOORS} ${ARG_POLICIES})
  set(archive glint_${name})
  if(ARG_POLICIES)
    set(archive glint_${name}_mechanism)
    glint_policies(${name} "${ARG_POLICIES}")
  endif()
  add_library(${archive} STATIC ${sources})
  glint_export(${archive})
  target_sources(${archive} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${headers})
  set_property(GLOBAL APPEND PROPERTY GLINT_HEADERS ${headers})
  target_compile_features(${archive} PUBLIC cxx_std_20)
  set_target_properties(${archive} PROPERTIES VERIFY_INTERFACE_HEADER_SETS ON LINKER_LANGUAGE CXX)
  target_link_libraries(${archive} PUBLIC ${ARG_DEPENDS} ${ARG_LINKS} PRIVATE $<BUILD_INTERFACE:glint_warnings>)
  if(ARG_PRECOMPILE)
    glint_precompile(${archive} ${ARG_PRECOMPILE})
    glint_precompile_coldest(${ARG_PRECOMPILE})
  elseif(NOT ARG_COLDEST)
    target_precompile_headers(${archive} REUSE_FROM glint_base)
  endif()
  if(ARG_COLDEST)
    glint_coldest(${archive})
  elseif(ARG_COLD)
    glint_cold(${archive} -O2 12)
  else()
    set_target_properties(${archive} PROPERTIES UNITY_BUILD ${GLINT_UNITY} UNITY_BUILD_BATCH_SIZE 6)
  endif()
endfunction()

# glint_policies(name subfolders) makes glint_<name> of two archives: the policies, of which every object is linked,
# because a static library drops objects that nothing refers to, and with them the registrations; and behind them on the
# linker's command line the mechanism, so that a policy may call any function of its folder.
function(glint_policies name subfolders)
  glint_glob(files *.cpp ${subfolders})
  add_library(glint_${name}_policies STATIC ${files})
  glint_export(glint_${name}_policies)
  target_precompile_headers(glint_${name}_policies REUSE_FROM glint_base)
  target_link_libraries(glint_${name}_policies PUBLIC glint::${name}_mechanism PRIVATE $<BUILD_INTERFACE:glint_warnings>)
  add_library(glint_${name} INTERFACE)
  glint_export(glint_${name})
  target_link_libraries(glint_${name} INTERFACE "$<LINK_LIBRARY:WHOLE_ARCHIVE,glint::${name}_policies>" glint::${name}_mechanism)
endfunction()

# glint_export(target) gives the target glint_<name> the alias glint::<name>, under which it is installed, too.
function(glint_export target)
  string(REPLACE glint_ "" name ${target})
  add_library(glint::${name} ALIAS ${target})
  set_property(GLOBAL APPEND PROPERTY GLINT_LIBRARIES ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
endfunction()

# glint_glob(variable pattern subfolder...) lists the files below the caller's folder that match; "." is the folder itself.
function(glint_glob variable pattern)
  list(TRANSFORM ARGN PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ OUTPUT_VARIABLE patterns)
  list(TRANSFORM patterns APPEND /${pattern})
  file(GLOB found CONFIGURE_DEPENDS ${patterns})
  set(${variable} ${found} PARENT_SCOPE)
endfunction()

# glint_cold(target level files) optimises a target by `level` and compiles so many of its files at a time. Large batches pay
# most where headers of packages are heavy, and the largest needs 1.3 GB of memory.
function(glint_cold target level files)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:${level}>)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${GLINT_UNITY} UNITY_BUILD_BATCH_SIZE ${files})
endfunction()

# glint_coldest(target) does what COLDEST says above. g++ 12 keeps a part of the level of optimisation with precompiled headers,
# whatever the command line says, so these targets have precompiled headers of their own. With headers made at -O3, a file of
# the command took 31 s; with these it takes 22 s.
function(glint_coldest target)
  glint_cold(${target} -O1 18)
  target_precompile_headers(${target} REUSE_FROM glint_coldest_headers)
endfunction()

# glint_precompile(target header...) parses the headers of packages that nearly every file includes, and these of
# ours, once for the target. A file still includes what it uses: the target all_verify_interface_header_sets compiles
# each header alone.
function(glint_precompile target)
  list(TRANSFORM ARGN PREPEND ${PROJECT_SOURCE_DIR}/)
  target_precompile_headers(${target} PRIVATE ${PROJECT_SOURCE_DIR}/cmake/precompiled.h ${ARGN})
endfunction()

# glint_precompile_coldest(header...) parses these headers once more, with the flags of the coldest targets.
function(glint_precompile_coldest)
  file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/coldest_headers.cpp "// Owns the precompiled headers of the coldest targets.\n")
  add_library(glint_coldest_headers OBJECT ${CMAKE_CURRENT_BINARY_DIR}/coldest_headers.cpp)
  target_link_libraries(glint_coldest_headers PRIVATE glint::base glint_warnings)
  glint_cold(glint_coldest_headers -O1 1)
  glint_precompile(glint_coldest_headers ${ARGN})
endfunction()
