find_package(nlohmann_json REQUIRED)
glint_test(vulkan_rt WITH vulkan_rt LINKS glint::pipeline glint::frontend nlohmann_json::nlohmann_json ${GLINT_ZSTD}
  SOURCES vulkan_rt/conformance_test.cpp vulkan_rt/formats_test.cpp vulkan_rt/software_test.cpp vulkan_rt/conformance_world.cpp vulkan_rt/compare.cpp vulkan_rt/recording.cpp)
target_include_directories(${GLINT_TEST_PROGRAM} PRIVATE ${GLINT_ZSTD_INCLUDE})
find_library(VULKAN_LOADER vulkan)
if(TARGET glint_vulkan AND VULKAN_LOADER)
  glint_test(vulkan_rt_driver WITH vulkan_rt LINKS glint::pipeline glint::frontend nlohmann_json::nlohmann_json ${GLINT_ZSTD} ${VULKAN_LOADER}
    SOURCES vulkan_rt/driver_test.cpp vulkan_rt/conformance_world.cpp vulkan_rt/compare.cpp vulkan_rt/recording.cpp vulkan/client.cpp vulkan/ray_client.cpp vulkan/ray_pipeline_client.cpp)
  target_include_directories(${GLINT_TEST_PROGRAM} PRIVATE ${GLINT_ZSTD_INCLUDE})
  add_dependencies(${GLINT_TEST_PROGRAM} glint_vulkan)
  set_tests_properties(vulkan_rt_driver PROPERTIES
    ENVIRONMENT "VK_DRIVER_FILES=${PROJECT_BINARY_DIR}/glint_icd.json;VK_ICD_FILENAMES=${PROJECT_BINARY_DIR}/glint_icd.json")
endif()
