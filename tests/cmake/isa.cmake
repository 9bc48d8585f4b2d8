glint_test(isa LINKS glint::isa)
glint_test(unit_isa FOLDER unit/isa LINKS glint::isa)
foreach(path avx2 avx512)
  add_test(NAME isa_paths_share_nothing_${path}
    COMMAND ${CMAKE_COMMAND} -DNM=${CMAKE_NM} "-DOBJECTS=$<TARGET_OBJECTS:glint_isa_ops_${path}>"
            -DSCOPE=glint::isa::${path}:: -P ${CMAKE_CURRENT_SOURCE_DIR}/isa/shared_symbols.cmake)
endforeach()

find_package(nlohmann_json REQUIRED)
find_path(GLINT_ZSTD_INCLUDE zstd.h)
find_library(GLINT_ZSTD zstd)
if(GLINT_ZSTD_INCLUDE AND GLINT_ZSTD)
  glint_test(isa_golden FOLDER isa/golden LINKS glint::isa nlohmann_json::nlohmann_json ${GLINT_ZSTD})
  target_include_directories(test_isa_golden PRIVATE ${GLINT_ZSTD_INCLUDE})
else()
  message(STATUS "Test isa_golden is left out: libzstd-dev is not installed")
endif()
