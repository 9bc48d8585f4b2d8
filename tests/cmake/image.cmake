# Adds tests of textures and storage images.
glint_test(unit_image WITH shaders LINKS glint::pipeline
  SOURCES unit/exec/texture_format_test.cpp unit/exec/texture_test.cpp unit/exec/image_part_test.cpp unit/exec/surface_test.cpp
  unit/exec/anisotropy_test.cpp unit/exec/block_formats_test.cpp)
