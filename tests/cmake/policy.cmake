# Adds tests of every policy by the command: its cycles, the bytes of two frames, policies that are built outside of the tree, and what regrouping
# threads and giving up places does.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
if(TARGET glint)
  foreach(suite Table Frames Plugin NewPolicy)
    add_test(NAME cli_Policy${suite} COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/cli/policy_test.py $<TARGET_FILE:glint> ${PROJECT_SOURCE_DIR} ${suite})
  endforeach()
  foreach(suite Effect Same)
    add_test(NAME cli_Reorder${suite} COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/cli/reorder_test.py $<TARGET_FILE:glint> ${PROJECT_SOURCE_DIR} ${suite})
  endforeach()
  add_test(NAME cli_Interleaving COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/cli/interleaving_test.py $<TARGET_FILE:glint> ${PROJECT_SOURCE_DIR})
  add_test(NAME cli_Parking COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/cli/parking_test.py $<TARGET_FILE:glint> ${PROJECT_SOURCE_DIR})
endif()
