glint_test(cosim LINKS glint::pipeline)
glint_test_library(test_agreement LINKS glint::pipeline glint_reference SOURCES picture/agreement.cpp)
glint_test(picture WITH pictures LINKS test_agreement glint::pipeline glint_reference
  SOURCES picture/alpha_test.cpp picture/picture_test.cpp)
glint_test(picture_scenes WITH pictures LINKS test_agreement glint::pipeline glint_reference
  SOURCES picture/every_scene_test.cpp picture/shared_copies_test.cpp)
glint_test(picture_software WITH machine LINKS glint::pipeline SOURCES picture/software_soup_test.cpp picture/software_traversal_test.cpp)
glint_test(unit_pipeline WITH machine FOLDER unit/pipeline LINKS glint::pipeline)
