if(TARGET glint::backend)
  glint_test(unit_backend ALONE FOLDER unit/backend LINKS glint::backend)
endif()
