# Adds tests of pipelines from files: the real binary on the examples, on inputs of every kind, and on mistakes.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
if(TARGET glint)
  foreach(suite Examples Lists Inputs Mistakes)
    add_test(NAME pipeline_${suite}
      COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/cli/pipeline_test.py $<TARGET_FILE:glint> ${PROJECT_SOURCE_DIR} ${suite})
  endforeach()
  add_test(NAME pipeline_Defaults
    COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/cli/defaults_test.py $<TARGET_FILE:glint> ${PROJECT_SOURCE_DIR})
  foreach(suite Rays Files)
    add_test(NAME rules_${suite}
      COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/cli/rules_test.py $<TARGET_FILE:glint> ${PROJECT_SOURCE_DIR} ${suite})
  endforeach()
  add_test(NAME pipeline_Texels
    COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/cli/texel_test.py $<TARGET_FILE:glint> ${PROJECT_SOURCE_DIR})
  add_test(NAME pipeline_Numbers
    COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/cli/numbers_test.py $<TARGET_FILE:glint> ${PROJECT_SOURCE_DIR})
endif()
