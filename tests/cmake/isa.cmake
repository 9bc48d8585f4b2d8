glint_test(isa LINKS glint::isa)
glint_test(unit_isa FOLDER unit/isa LINKS glint::isa)
foreach(path avx2 avx512)
  add_test(NAME isa_paths_share_nothing_${path}
    COMMAND ${CMAKE_COMMAND} -DNM=${CMAKE_NM} "-DOBJECTS=$<TARGET_OBJECTS:glint_isa_ops_${path}>"
            -DSCOPE=glint::isa::${path}:: -P ${CMAKE_CURRENT_SOURCE_DIR}/isa/shared_symbols.cmake)
endforeach()
