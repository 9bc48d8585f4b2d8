# Adds tests of scenes, and the reference renderer that checks pictures of them.
add_library(glint_reference STATIC reference/embree_intersector.cpp reference/reference.cpp reference/shapes.cpp
  reference/surface.cpp reference/texture.cpp)
add_library(glint::reference ALIAS glint_reference)
target_link_libraries(glint_reference PUBLIC glint::scenes PRIVATE embree glint_warnings)
target_include_directories(glint_reference PUBLIC ${PROJECT_SOURCE_DIR})
set_target_properties(glint_reference PROPERTIES UNITY_BUILD ${GLINT_UNITY})
add_executable(render_reference reference/render_reference.cpp)
target_link_libraries(render_reference PRIVATE glint::reference)
glint_test(unit_scenes WITH pictures FOLDER unit/scenes LINKS glint::scenes glint::reference)
glint_test(reference WITH pictures LINKS glint::reference)
if(TARGET glint)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  add_test(NAME scene_files
    COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/cli/scene_file_test.py $<TARGET_FILE:glint> ${PROJECT_SOURCE_DIR})
  foreach(suite Frames Timing Animations CameraPaths)
    add_test(NAME cli_frames_${suite}
      COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/cli/frames_test.py $<TARGET_FILE:glint> ${PROJECT_SOURCE_DIR} ${suite})
  endforeach()
endif()
