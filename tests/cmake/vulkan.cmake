# Adds the tests of the Vulkan driver. Those that need a package which is not installed say so and skip.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_test(NAME vulkan_entry_table COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/vulkan/entry_table_test.py ${PROJECT_SOURCE_DIR})
find_library(VULKAN_LOADER vulkan)
if(TARGET glint_vulkan AND VULKAN_LOADER)
  set(manifest ${PROJECT_BINARY_DIR}/glint_icd.json)
  # The client links the compiler, and with it glslang, that the driver has in it too.
  glint_test(vulkan LINKS glint::frontend ${VULKAN_LOADER}
    SOURCES vulkan/announced_test.cpp vulkan/client.cpp vulkan/compute_test.cpp vulkan/descriptor_test.cpp vulkan/image_test.cpp vulkan/pipeline_file_test.cpp vulkan/queue_test.cpp vulkan/ray_client.cpp vulkan/ray_query_test.cpp vulkan/timing_test.cpp vulkan/wrong_use_test.cpp)
  add_dependencies(test_vulkan glint_vulkan)
  set_tests_properties(vulkan PROPERTIES ENVIRONMENT "VK_DRIVER_FILES=${manifest};VK_ICD_FILENAMES=${manifest}")
  # VkFFT is a header that wants a glslang, which frontend brings. Its client is built where libvkfft-dev is installed, and
  # without the warnings that the header has.
  find_path(VKFFT_DIR vkFFT.h)
  if(VKFFT_DIR)
    add_executable(vkfft_client vulkan/vkfft_client.cpp vulkan/client.cpp)
    target_compile_definitions(vkfft_client PRIVATE VKFFT_BACKEND=0)
    target_compile_options(vkfft_client PRIVATE -w)
    set_target_properties(vkfft_client PROPERTIES UNITY_BUILD OFF)
    target_link_libraries(vkfft_client PRIVATE glint::frontend ${VULKAN_LOADER})
  endif()
  foreach(name vulkaninfo client timing install ffmpeg ggml vkfft webgpu)
    add_test(NAME vulkan_${name} COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/vulkan/${name}_test.py ${manifest} ${PROJECT_SOURCE_DIR} $<TARGET_FILE:test_vulkan>)
    set_tests_properties(vulkan_${name} PROPERTIES SKIP_RETURN_CODE 77)
  endforeach()
  if(TARGET glint)
    add_test(NAME vulkan_pipeline_file COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/vulkan/pipeline_file_test.py ${manifest} ${PROJECT_SOURCE_DIR} $<TARGET_FILE:test_vulkan> $<TARGET_FILE:glint>)
  endif()
endif()
