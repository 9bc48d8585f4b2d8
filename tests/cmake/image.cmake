# Textures and storage images.
glint_test(unit_image LINKS glint::core
  SOURCES unit/core/texture_format_test.cpp unit/core/texture_test.cpp unit/core/surface_test.cpp ${PROJECT_SOURCE_DIR}/pipeline/engine_loop.cpp)
