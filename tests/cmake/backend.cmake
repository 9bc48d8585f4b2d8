if(TARGET glint::backend)
  glint_test(unit_backend FOLDER unit/backend LINKS glint::backend)
endif()
