glint_test(cosim LINKS glint::pipeline)
glint_test(picture LINKS glint::pipeline glint_reference
  SOURCES picture/agreement.cpp picture/alpha_test.cpp picture/picture_test.cpp)
glint_test(picture_scenes LINKS glint::pipeline glint_reference
  SOURCES picture/agreement.cpp picture/every_scene_test.cpp picture/instancing_test.cpp)
glint_test(picture_software LINKS glint::pipeline SOURCES picture/software_soup_test.cpp picture/software_traversal_test.cpp)
glint_test(unit_pipeline FOLDER unit/pipeline LINKS glint::pipeline)
