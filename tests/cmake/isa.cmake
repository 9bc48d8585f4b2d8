glint_test(isa LINKS glint::isa)
# It computes most of what it compares with itself. Headers that were parsed for other flags do not fit.
target_compile_options(test_isa PRIVATE $<$<CONFIG:Release>:-O2>)
set_target_properties(test_isa PROPERTIES DISABLE_PRECOMPILE_HEADERS ON)
glint_test(unit_isa FOLDER unit/isa LINKS glint::isa)
foreach(path avx2 avx512)
  add_test(NAME isa_paths_share_nothing_${path}
    COMMAND ${CMAKE_COMMAND} -DNM=${CMAKE_NM} "-DOBJECTS=$<TARGET_OBJECTS:glint_isa_ops_${path}>"
            -DSCOPE=glint::isa::${path}:: -P ${CMAKE_CURRENT_SOURCE_DIR}/isa/shared_symbols.cmake)
endforeach()
