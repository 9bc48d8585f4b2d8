# Adds tests of printing from shaders, contraction, the cache of compiled shaders, and the command line for them.
if(TARGET glint::pipeline AND TARGET glint::frontend)
  glint_test(print WITH shaders LINKS glint::pipeline SOURCES print/shader_run.cpp print/cache_test.cpp print/contract_test.cpp print/message_test.cpp
    print/print_log_test.cpp print/print_test.cpp)
endif()
if(TARGET glint)
  foreach(suite Printing Cache Contraction Emission)
    add_test(NAME cli_shader_${suite}
      COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/cli/shader_test.py $<TARGET_FILE:glint> ${PROJECT_SOURCE_DIR} ${suite})
  endforeach()
endif()
