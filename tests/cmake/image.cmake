# Textures and storage images.
glint_test(unit_image LINKS glint::pipeline
  SOURCES unit/core/texture_format_test.cpp unit/core/texture_test.cpp unit/core/surface_test.cpp)
