# glint_library(name SOURCES ... HEADERS ... DEPENDS folder... LINKS target... POLICIES subfolder...)
#
# One static library a folder, alias glint::<name>, with the project's flags and header checks. LINKS are
# libraries from packages, seen by the folder's users only if its headers include them. POLICIES are the one
# place where globbing is allowed: a policy is one file and stands in no list.
function(glint_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;HEADERS;DEPENDS;LINKS;POLICIES" ${ARGN})
  list(TRANSFORM ARG_DEPENDS PREPEND glint::)
  add_library(glint_${name} STATIC ${ARG_SOURCES})
  add_library(glint::${name} ALIAS glint_${name})
  target_sources(glint_${name} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${ARG_HEADERS})
  set_target_properties(glint_${name} PROPERTIES VERIFY_INTERFACE_HEADER_SETS ON)
  target_link_libraries(glint_${name} PUBLIC ${ARG_DEPENDS} ${ARG_LINKS} PRIVATE glint_warnings)
  if(ARG_POLICIES)
    list(TRANSFORM ARG_POLICIES APPEND /*.cpp)
    list(TRANSFORM ARG_POLICIES PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
    file(GLOB files CONFIGURE_DEPENDS ${ARG_POLICIES})
    add_library(glint_${name}_policies STATIC ${files})
    target_include_directories(glint_${name}_policies PRIVATE ${PROJECT_SOURCE_DIR})
    target_link_libraries(glint_${name}_policies PUBLIC ${ARG_DEPENDS} ${ARG_LINKS} PRIVATE glint_warnings)
    # Whole archive: a static library drops objects that nothing refers to, and with them the registrations.
    target_link_libraries(glint_${name} PUBLIC "$<LINK_LIBRARY:WHOLE_ARCHIVE,glint_${name}_policies>")
  endif()
endfunction()
